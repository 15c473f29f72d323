// SPDX-License-Identifier: Apache-2.0
// One subject of the grid: a small picture, its name and its state.
import { type Condition, isDimmed } from '../panels/condition';
import { text } from '../text';
import { h } from '../ui/dom';
import { LivePicture } from '../view/live_picture';
import type { Connection } from '../wire/connection';

const t = text.grid;

export class Tile {
  readonly element: HTMLButtonElement;
  readonly live: LivePicture;
  /** In sight. */
  isVisible = false;
  private readonly state = h('span', { class: 'tile-state' });

  constructor(readonly name: string, connection: Connection, onChosen: () => void) {
    this.live = new LivePicture(connection);
    this.element = h('button', { type: 'button', class: 'tile', 'data-subject': name, tabindex: -1, onclick: onChosen },
      this.live.canvas, h('span', { class: 'tile-large' }, t.shownLarge), h('span', { class: 'tile-words' }, h('span', { class: 'tile-name' }, name), this.state));
    this.live.hasPicture.watch((has) => this.element.classList.toggle('has-picture', has));
  }

  /** `isLarge`: a large picture shows this subject. */
  show({ state, text: words }: Condition, isFocus: boolean, isLarge: boolean): void {
    const { element } = this;
    element.title = words;
    element.dataset.state = state;
    element.classList.toggle('dimmed', isDimmed(state));
    element.classList.toggle('large', isLarge);
    element.setAttribute('aria-pressed', String(isFocus));
    if (this.state.textContent !== text.state[state]) this.state.textContent = text.state[state];
  }
}
