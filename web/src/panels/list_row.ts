// SPDX-License-Identifier: Apache-2.0
// A setting with a list of choices: a folder with one switch per choice. The list keeps the order in
// which the choices were switched on.
import type { BindingApi, FolderApi } from '@tweakpane/core';
import type { SettingInfo } from '../api';
import { readable } from '../ui/dom';
import { labelOf, type RowEvents } from './setting_binding';

export class ListRow {
  private readonly folder: FolderApi;
  private readonly holder: Record<string, boolean> = {};
  private readonly switches: BindingApi[] = [];
  private chosen: string[] = [];
  private refreshing = false;

  constructor(parent: FolderApi, readonly info: SettingInfo, text: string, events: RowEvents) {
    this.folder = parent.addFolder({ title: labelOf(info), expanded: false });
    this.folder.element.dataset.setting = info.name;
    this.folder.element.title = info.help;
    for (const type of ['pointerenter', 'pointerdown', 'focusin'] as const) this.folder.element.addEventListener(type, events.onPointed);
    for (const word of info.choices ?? []) {
      this.holder[word] = false;
      const binding = this.folder.addBinding(this.holder, word, { label: readable(word) });
      binding.element.querySelector('input')?.setAttribute('aria-label', `${labelOf(info)}: ${readable(word)}`);
      binding.on('change', (event: { value: unknown }) => {
        if (this.refreshing) return;
        const rest = this.chosen.filter((other) => other !== word);
        events.onChange((event.value === true ? [...rest, word] : rest).join(','));
      });
      this.switches.push(binding);
    }
    this.refresh(text, false);
  }

  refresh(text: string, changed: boolean): void {
    this.chosen = text === '' ? [] : text.split(',');
    this.refreshing = true;
    for (const word of Object.keys(this.holder)) this.holder[word] = this.chosen.includes(word);
    for (const binding of this.switches) binding.refresh();
    this.refreshing = false;
    this.folder.element.classList.toggle('changed', changed);
  }

  filter(query: string): boolean {
    const { name, help, choices } = this.info;
    const haystack = [name, labelOf(this.info), help, ...(choices ?? [])].join(' ').toLowerCase();
    const matches = query.toLowerCase().split(/\s+/).every((word) => haystack.includes(word));
    this.folder.hidden = !matches;
    return matches;
  }
}
