// SPDX-License-Identifier: Apache-2.0
// The menu of the renderer's settings, built from the reply to GET /api/settings.
import type { FolderApi } from '@tweakpane/core';
import { Pane } from 'tweakpane';
import type { SettingInfo } from '../api';
import type { AppState } from '../state/app_state';
import { browserStore, PresetShelf } from '../state/presets';
import { text } from '../text';
import { button, h, readable, select, setOptions } from '../ui/dom';
import type { Toasts } from '../ui/toast';
import { ListRow } from './list_row';
import { SettingRow } from './setting_binding';

type Row = SettingRow | ListRow;

/** Groups that are open initially. */
const OPEN_GROUPS = new Set(['picture', 'lights']);

export class SettingsMenu {
  readonly element: HTMLElement;
  private readonly paneHolder = h('div', { class: 'pane' });
  private readonly search = h('input', {
    type: 'search', placeholder: text.menu.search, 'aria-label': text.menu.search, id: 'settings-search',
  });
  private readonly help = h('p', { class: 'help-line' }, matchMedia('(hover: hover)').matches ? text.menu.hint : text.menu.touchHint);
  private readonly nothing = h('p', { class: 'empty', hidden: true }, text.menu.nothing);
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly reset: HTMLButtonElement;
  private readonly compare: HTMLButtonElement;
  private readonly shelf: PresetShelf;
  private readonly presets: HTMLSelectElement;
  private pane: Pane | null = null;
  private rows: Row[] = [];
  private folders = new Map<string, FolderApi>();
  private shape = '';

  constructor(private readonly state: AppState, private readonly toasts: Toasts, openText: () => void) {
    const { settings } = state;
    this.undo = button(text.menu.undo, () => settings.undo(), { title: text.menu.undoTitle });
    this.redo = button(text.menu.redo, () => settings.redo(), { title: text.menu.redoTitle });
    this.reset = button(text.menu.reset, () => settings.replace(new Map()), { title: text.menu.resetTitle });
    this.compare = button(text.menu.compare, () => {}, { title: text.menu.compareTitle });
    this.shelf = PresetShelf.presets(browserStore());
    this.presets = select(text.menu.preset, [], (name) => this.choosePreset(name));
    this.search.addEventListener('input', () => this.filter());
    this.holdToCompare();
    this.element = h('div', { class: 'menu' },
      h('div', { class: 'row' }, this.presets,
        button(text.menu.save, () => this.savePreset(), { title: text.menu.saveTitle }),
        button(text.menu.asText, openText, { title: text.menu.asTextTitle })),
      h('div', { class: 'row' }, this.undo, this.redo, this.reset, this.compare),
      h('div', { class: 'row' }, this.search),
      this.paneHolder, this.nothing, this.help);
    this.fillPresets();
    settings.changed.bind(() => this.refresh());
  }

  focusSearch(): void {
    this.search.focus();
    this.search.select();
  }

  private holdToCompare(): void {
    const { comparing } = this.state;
    this.compare.addEventListener('pointerdown', () => comparing.set(true));
    for (const end of ['pointerup', 'pointerleave', 'pointercancel', 'blur']) {
      this.compare.addEventListener(end, () => comparing.set(false));
    }
    this.compare.addEventListener('keydown', (event) => {
      if (event.key === ' ' || event.key === 'Enter') comparing.set(true);
    });
    this.compare.addEventListener('keyup', () => comparing.set(false));
    comparing.bind((on) => this.compare.setAttribute('aria-pressed', String(on)));
  }

  private refresh(): void {
    const { settings } = this.state;
    const shape = settings.infos.map((info) => info.name).join();
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(settings.infos);
    }
    for (const row of this.rows) {
      row.refresh(settings.value(row.info.name), settings.overrides.has(row.info.name));
    }
    this.undo.disabled = !settings.canUndo;
    this.redo.disabled = !settings.canRedo;
    this.compare.disabled = !settings.canUndo;
    this.reset.disabled = settings.overrides.size === 0;
  }

  private build(infos: readonly SettingInfo[]): void {
    this.pane?.dispose();
    this.pane = new Pane({ container: this.paneHolder });
    this.folders.clear();
    this.rows = infos.map((info) => this.buildRow(info));
    this.filter();
  }

  private folder(group: string): FolderApi {
    let folder = this.folders.get(group);
    if (folder === undefined) {
      folder = this.pane!.addFolder({ title: readable(group), expanded: OPEN_GROUPS.has(group) });
      this.folders.set(group, folder);
    }
    return folder;
  }

  private buildRow(info: SettingInfo): Row {
    const { settings } = this.state;
    const events = {
      onChange: (text: string) => settings.set(info.name, text, performance.now()),
      onReset: () => settings.reset(info.name),
      onPointed: () => this.explain(info),
    };
    const Kind = info.kind === 'list' ? ListRow : SettingRow;
    return new Kind(this.folder(info.group), info, settings.value(info.name), events);
  }

  private explain(info: SettingInfo): void {
    const range = info.min !== null && info.max !== null ? text.menu.range(info.min, info.max, info.unit) : '';
    this.help.replaceChildren(h('code', {}, info.name), text.menu.describe(info.help, range, info.default));
  }

  private filter(): void {
    const query = this.search.value.trim();
    const found = new Set<string>();
    for (const row of this.rows) if (row.filter(query)) found.add(row.info.group);
    for (const [group, folder] of this.folders) {
      folder.hidden = !found.has(group);
      if (query !== '') folder.expanded = true;
    }
    this.nothing.hidden = found.size > 0 || this.rows.length === 0;
  }

  private fillPresets(): void {
    const options = this.shelf.all().map(({ name, own }) => [name, own ? text.menu.mine(name) : name] as const);
    setOptions(this.presets, [['', text.menu.presets], ...options]);
    this.presets.value = '';
  }

  private choosePreset(name: string): void {
    const preset = this.shelf.all().find((candidate) => candidate.name === name);
    this.presets.value = '';
    if (preset === undefined) return;
    const unknown = this.state.settings.replace(preset.values);
    if (unknown.length > 0) this.toasts.say(text.menu.unknown(unknown));
  }

  private savePreset(): void {
    const name = prompt(text.menu.presetName)?.trim();
    if (name === undefined) return;
    if (this.shelf.save(name, this.state.settings.overrides)) this.fillPresets();
    else this.toasts.say(text.menu.builtIn, 'error');
  }
}
