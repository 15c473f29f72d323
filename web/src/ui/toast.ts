// SPDX-License-Identifier: Apache-2.0
import { text as words } from '../text';
import { button, h } from './dom';

const SHOWN_MS = 8000;

/** Short messages in the corner, announced by screen readers. They close by themselves or with their button. */
export class Toasts {
  readonly element = h('div', { class: 'toasts', role: 'log', 'aria-live': 'polite', 'aria-label': words.toasts.log });

  say(text: string, kind: 'info' | 'error' = 'info'): void {
    for (const other of this.element.querySelectorAll('.toast span')) {
      if (other.textContent === text) other.parentElement!.remove();
    }
    const toast = h('div', { class: `toast ${kind}` }, h('span', {}, text));
    toast.append(button('×', () => toast.remove(), { 'aria-label': words.toasts.dismiss }));
    this.element.append(toast);
    setTimeout(() => toast.remove(), kind === 'error' ? 2 * SHOWN_MS : SHOWN_MS);
  }
}
