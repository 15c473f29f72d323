// SPDX-License-Identifier: Apache-2.0
import { h } from './dom';

export interface Tab {
  id: string;
  label: string;
  content: HTMLElement;
}

/** A tab list after the ARIA pattern: arrow keys move between tabs, and the list is one tab stop. */
export class Tabs {
  readonly list = h('div', { role: 'tablist', class: 'tabs', 'aria-label': 'Panels' });
  readonly panels = h('div', { class: 'tab-panels' });
  private chosen = '';
  private readonly buttons = new Map<string, HTMLButtonElement>();

  constructor(private readonly tabs: readonly Tab[], private readonly onChoose: (id: string) => void) {
    for (const { id, label, content } of tabs) {
      const tab = h('button', {
        type: 'button', role: 'tab', id: `tab-${id}`, 'aria-controls': `panel-${id}`,
        onclick: () => this.choose(id),
      }, label);
      this.buttons.set(id, tab);
      this.list.append(tab);
      this.panels.append(h('section', {
        role: 'tabpanel', id: `panel-${id}`, 'aria-labelledby': `tab-${id}`, tabindex: 0,
      }, content));
    }
    this.list.addEventListener('keydown', (event) => this.onKey(event));
    this.choose(tabs[0]!.id);
  }

  get current(): string {
    return this.chosen;
  }

  /** Chooses a tab by its id. An unknown id chooses the first tab. */
  choose(id: string): void {
    this.chosen = this.buttons.has(id) ? id : this.tabs[0]!.id;
    for (const [name, tab] of this.buttons) {
      const isChosen = name === this.chosen;
      tab.setAttribute('aria-selected', String(isChosen));
      tab.tabIndex = isChosen ? 0 : -1;
      this.panels.querySelector<HTMLElement>(`#panel-${name}`)!.hidden = !isChosen;
    }
    this.onChoose(this.chosen);
  }

  private onKey(event: KeyboardEvent): void {
    const names = [...this.buttons.keys()];
    const at = names.indexOf(this.chosen);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: names.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    const next = names[(to + names.length) % names.length]!;
    this.choose(next);
    this.buttons.get(next)!.focus();
  }
}
