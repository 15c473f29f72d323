// SPDX-License-Identifier: Apache-2.0
// The dialog that saves, loads and shares arrangements of the page.
import type { AppState } from '../state/app_state';
import { PresetShelf, type Store } from '../state/presets';
import { text } from '../text';
import { button, copyText, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const t = text.layouts;

export class LayoutDialog {
  readonly element: HTMLDialogElement;
  private readonly shelf: PresetShelf;
  private readonly list = h('ul', { class: 'layouts' });
  private readonly name = h('input', { type: 'text', id: 'layout-name', maxlength: 40, autocomplete: 'off' });
  private readonly error = h('p', { class: 'error', role: 'alert' });

  constructor(private readonly state: AppState, private readonly toasts: Toasts, store: Store | null) {
    this.shelf = PresetShelf.layouts(store);
    const form = h('form', { class: 'row' }, h('label', { for: 'layout-name' }, t.name), this.name, h('button', { type: 'submit' }, t.save));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.save();
    });
    this.element = h('dialog', { class: 'layout-dialog', 'aria-labelledby': 'layouts-title' },
      h('h2', { id: 'layouts-title' }, t.title), h('p', { class: 'fine' }, t.intro), this.list, form, this.error,
      h('div', { class: 'row end' }, button(t.copy, () => void this.copy(), { title: t.copyTitle }),
        button(t.close, () => this.element.close(), { class: 'primary' })));
  }

  open(): void {
    this.error.textContent = '';
    this.fill();
    this.element.showModal();
  }

  private fill(): void {
    this.list.replaceChildren(...this.shelf.all().map(({ name, values, own }) => h('li', {},
      button(name, () => this.load(values), { class: 'layout', 'aria-pressed': String(this.state.isArranged(values)) }),
      own ? button('×', () => this.remove(name), { 'aria-label': t.remove(name), title: t.remove(name) }) : null)));
  }

  private load(values: ReadonlyMap<string, string>): void {
    this.element.close();
    this.state.arrange(values);
    if (this.state.kiosk.value) this.toasts.say(t.kiosk);
  }

  private save(): void {
    const name = this.name.value.trim();
    if (!this.shelf.save(name, this.state.layout())) {
      this.error.textContent = name === '' ? t.noName : t.builtIn;
      return;
    }
    this.error.textContent = this.name.value = '';
    this.fill();
  }

  private remove(name: string): void {
    this.shelf.delete(name);
    this.fill();
    this.name.focus();
  }

  private async copy(): Promise<void> {
    if (await copyText(this.state.link())) this.toasts.say(t.copied);
    else this.error.textContent = t.cannotCopy;
  }
}
