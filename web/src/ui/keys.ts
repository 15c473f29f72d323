// SPDX-License-Identifier: Apache-2.0
// The page's keys, and the dialog that lists them.
import { button, h, takesKeys } from './dom';

export interface Command {
  /** As KeyboardEvent.key says, in lower case; "ctrl+z" with a modifier. */
  key: string;
  words: string;
  run: () => void;
  release?: () => void;
}

const CAMERA_KEYS: readonly (readonly [string, string])[] = [
  ['drag, arrows', 'turn the camera about the subject'],
  ['shift + drag, right button, two fingers', 'move the picture'],
  ['wheel, pinch, + −', 'nearer, further'],
  ['alt + drag', 'look around'],
  ['w a s d, q e', 'walk, go down and up'],
];

function nameOf(event: KeyboardEvent): string {
  const modifier = event.ctrlKey || event.metaKey ? 'ctrl+' : '';
  return modifier + (event.key === ' ' ? 'space' : event.key.toLowerCase());
}

/** Keys work wherever no control wants them; those with Ctrl everywhere but in text. */
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
    h('h2', { id: 'help-title' }, 'Hands and keys'),
    h('table', {}, h('tbody', {}, ...CAMERA_KEYS.map(([keys, words]) => row(keys, words)),
      ...shown.map(({ key, words }) => row(key.replace('ctrl+', 'Ctrl + '), words)))),
    h('p', { class: 'fine' }, 'Camera keys work while the picture has the focus. What you set stands in the address: reload it, bookmark it, send it.'));
  dialog.append(h('div', { class: 'row end' }, button('Close', () => dialog.close(), { class: 'primary' })));
  return dialog;
}
