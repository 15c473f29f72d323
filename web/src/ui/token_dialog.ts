// SPDX-License-Identifier: Apache-2.0
// Asks for the connect token when the daemon requires one.
import { text } from '../text';
import { button, h } from './dom';

const t = text.token;

export class TokenDialog {
  readonly element: HTMLDialogElement;
  private readonly input = h('input', {
    type: 'password', id: 'token', autocomplete: 'off', spellcheck: 'false', placeholder: 'frw1_…',
  });
  private readonly reason = h('p', { class: 'fine', role: 'status' });

  constructor(onToken: (token: string) => void) {
    const form = h('form', { method: 'dialog' },
      h('label', { for: 'token' }, t.label), this.input,
      h('div', { class: 'row end' },
        button(t.cancel, () => this.element.close()),
        h('button', { class: 'primary', type: 'submit' }, t.connect)));
    form.addEventListener('submit', () => {
      if (this.input.value.trim() !== '') onToken(this.input.value);
      this.input.value = '';
    });
    this.element = h('dialog', { class: 'token', 'aria-labelledby': 'token-title' },
      h('h2', { id: 'token-title' }, t.title), this.reason, form,
      h('p', { class: 'fine' }, t.note));
  }

  ask(reason: string): void {
    this.reason.textContent = reason;
    if (!this.element.open) this.element.showModal();
  }
}
