// SPDX-License-Identifier: Apache-2.0
import { isCompact } from '../state/layout';
import { text } from '../text';
import { h } from './dom';
import { icon, type IconName } from './icons';

export interface Tab {
  id: string;
  label: string;
  icon: IconName;
  content: HTMLElement;
  /** Only while panels are sheets (isCompact). */
  isForSheets?: boolean;
}

/**
 * A tab list after the ARIA pattern: arrow keys move between tabs, and the list is one tab stop. Where panels are sheets,
 * the chosen tab closes its sheet.
 */
export class Tabs {
  readonly list = h('div', { role: 'tablist', class: 'tabs', 'aria-label': text.tabs.list });
  readonly panels = h('div', { class: 'tab-panels' });
  private chosen = '';
  private readonly buttons = new Map<string, HTMLButtonElement>();

  private isOpen = true;

  /** `onChoose`: gets an empty id when the sheet is closed. */
  constructor(private readonly tabs: readonly Tab[], private readonly onChoose: (id: string) => void) {
    for (const { id, label, icon: name, content } of tabs) {
      const tab = h('button', {
        type: 'button', role: 'tab', id: `tab-${id}`, 'aria-controls': `panel-${id}`,
        onclick: () => (isCompact.value && this.isOpen && this.chosen === id ? this.onChoose('') : this.choose(id)),
      }, icon(name), h('span', {}, label));
      this.buttons.set(id, tab);
      this.list.append(tab);
      this.panels.append(h('section', {
        role: 'tabpanel', id: `panel-${id}`, 'aria-labelledby': `tab-${id}`, tabindex: 0,
      }, content));
    }
    this.list.addEventListener('keydown', (event) => this.onKey(event));
    this.chosen = this.usable()[0]!.id;
    isCompact.bind(() => this.arrange());
  }

  /** The tabs of this arrangement of the page. */
  private usable(): Tab[] {
    return this.tabs.filter(({ isForSheets }) => isForSheets !== true || isCompact.value);
  }

  private arrange(): void {
    const usable = this.usable();
    for (const { id } of this.tabs) this.buttons.get(id)!.hidden = !usable.some((tab) => tab.id === id);
    if (!usable.some(({ id }) => id === this.chosen)) this.choose(usable[0]!.id);
    else this.mark();
  }

  /** Whether the chosen panel is visible. */
  setOpen(isOpen: boolean): void {
    this.isOpen = isOpen;
    this.mark();
  }

  get current(): string {
    return this.chosen;
  }

  /** Chooses a tab by its id. An unknown id chooses the first tab. */
  choose(id: string): void {
    const usable = this.usable();
    this.chosen = usable.some((tab) => tab.id === id) ? id : usable[0]!.id;
    this.mark();
    this.onChoose(this.chosen);
  }

  private mark(): void {
    for (const [name, tab] of this.buttons) {
      const isChosen = name === this.chosen;
      tab.setAttribute('aria-selected', String(isChosen && this.isOpen));
      tab.tabIndex = isChosen ? 0 : -1;
      this.panels.querySelector<HTMLElement>(`#panel-${name}`)!.hidden = !isChosen;
    }
  }

  private onKey(event: KeyboardEvent): void {
    const names = this.usable().map(({ id }) => id);
    const at = names.indexOf(this.chosen);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: names.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    const next = names[(to + names.length) % names.length]!;
    this.choose(next);
    this.buttons.get(next)!.focus();
  }
}
