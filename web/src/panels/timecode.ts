// SPDX-License-Identifier: Apache-2.0
// The timecode of the pose on the screen, in a corner of the picture. Hidden for sources that send none.
import type { WeightFrame } from '../state/weight_history';
import { text } from '../text';
import { h } from '../ui/dom';

export class TimecodeBadge {
  readonly element = h('p', { class: 'timecode', role: 'timer', 'aria-label': text.stage.timecode, hidden: true });

  /** Undefined: there is no pose. */
  show(frame: WeightFrame | undefined): void {
    const words = frame?.timecode?.text ?? '';
    this.element.hidden = words === '';
    if (this.element.textContent !== words) this.element.textContent = words;
  }
}
