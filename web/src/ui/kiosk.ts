// SPDX-License-Identifier: Apache-2.0
// The picture alone on a stage monitor: no pointer, no sleeping screen, and a way out for fingers.
import { text } from '../text';
import { button } from './dom';
import type { Signal } from './signal';

/** The pointer and the way out stay this long after a movement. */
const AWAKE_MS = 3000;

/** Returns the button that leaves the kiosk. `root` gets the class `awake` while somebody moves the pointer. */
export function kioskButton(root: HTMLElement, kiosk: Signal<boolean>): HTMLButtonElement {
  const leave = button(text.stage.leaveKiosk, () => kiosk.set(false), { class: 'kiosk-leave', hidden: true });
  let timer: ReturnType<typeof setTimeout> | undefined;
  const wake = (): void => {
    root.classList.add('awake');
    clearTimeout(timer);
    timer = setTimeout(() => root.classList.remove('awake'), AWAKE_MS);
  };
  for (const type of ['pointermove', 'pointerdown', 'focusin'] as const) root.addEventListener(type, wake);
  let lock: WakeLockSentinel | null = null;
  const keepAwake = (): void => {
    void lock?.release();
    lock = null;
    if (!kiosk.value || document.hidden || !('wakeLock' in navigator)) return;
    // Only in secure contexts, and not with a low battery: then the screen follows the computer's own rules.
    navigator.wakeLock.request('screen').then((granted) => {
      if (!kiosk.value || lock !== null) void granted.release(); // the kiosk was left meanwhile, or has a lock
      else lock = granted;
    }, () => undefined);
  };
  document.addEventListener('visibilitychange', keepAwake); // browsers take the lock away from hidden pages
  kiosk.bind((on) => {
    leave.hidden = !on;
    keepAwake();
  });
  return leave;
}
