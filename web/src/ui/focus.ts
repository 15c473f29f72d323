// SPDX-License-Identifier: Apache-2.0

/** Controls that need the focus after a click, because the user types into them or moves on with keys. */
const KEEPS = 'input[type=text], input[type=search], input[type=password], input[type=number], textarea, summary, dialog *, .pane *';

/**
 * After a click or a choice by mouse or touch, gives the focus to the picture, so that the keys of the page and the
 * camera work at once. People who use the keyboard keep their place.
 */
export function returnFocus(root: HTMLElement, picture: HTMLElement): void {
  let byPointer = false;
  document.addEventListener('pointerdown', () => (byPointer = true), true);
  document.addEventListener('keydown', () => (byPointer = false), true);
  const giveBack = (event: Event): void => {
    const { activeElement } = document;
    if (!byPointer || !(event.target instanceof Element) || !root.contains(activeElement)) return;
    if (event.target.closest('button, select, input') === null || event.target.closest(KEEPS) !== null) return;
    if (document.querySelector('dialog[open]') !== null || activeElement!.closest(KEEPS) !== null) return;
    if (event.type === 'click' && event.target.closest('select') !== null) return; // its list is open now
    picture.focus({ preventScroll: true });
  };
  // After the listeners of the control, which may move the focus themselves.
  root.addEventListener('click', giveBack);
  root.addEventListener('change', giveBack);
}
