// SPDX-License-Identifier: Apache-2.0
// The keyboard shortcuts of the page, and the dialog that lists them.
import { text } from '../text';
import { button, h, takesKeys } from './dom';

export interface Command {
  /** KeyboardEvent.key in lowercase; "ctrl+z" with a modifier. */
  key: string;
  words: string;
  run: () => void;
  release?: () => void;
}


function nameOf(event: KeyboardEvent): string {
  const modifier = event.ctrlKey || event.metaKey ? 'ctrl+' : '';
  return modifier + (event.key === ' ' ? 'space' : event.key.toLowerCase());
}

/** Keys work unless the focused control uses them. Ctrl shortcuts work everywhere except in text fields. */
export function installKeys(commands: readonly Command[]): void {
  document.addEventListener('keydown', (event) => {
    const name = nameOf(event);
    const inText = event.target instanceof Element && event.target.closest('input[type=text], input[type=search], textarea') !== null;
    if (event.altKey || document.querySelector('dialog[open]') !== null) return;
    if (name.startsWith('ctrl+') ? inText : takesKeys(event.target)) return;
    const command = commands.find(({ key }) => key === name);
    if (command === undefined) return;
    event.preventDefault();
    if (!event.repeat || command.release === undefined) command.run();
  });
  document.addEventListener('keyup', (event) => commands.find(({ key }) => key === nameOf(event))?.release?.());
}

export function helpDialog(commands: readonly Command[]): HTMLDialogElement {
  const row = (keys: string, words: string): HTMLElement =>
    h('tr', {}, h('th', { scope: 'row' }, h('kbd', {}, keys)), h('td', {}, words));
  const shown = commands.filter(({ words }) => words !== '');
  const dialog = h('dialog', { class: 'help', 'aria-labelledby': 'help-title' },
    h('h2', { id: 'help-title' }, text.keys.title),
    h('table', {}, h('tbody', {}, ...text.keys.camera.map(([keys, words]) => row(keys, words)),
      ...shown.map(({ key, words }) => row(key.replace('ctrl+', 'Ctrl + '), words)))),
    h('p', { class: 'fine' }, text.keys.note));
  dialog.append(h('div', { class: 'row end' }, button(text.keys.close, () => dialog.close(), { class: 'primary' })));
  return dialog;
}
