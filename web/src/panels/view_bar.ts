// SPDX-License-Identifier: Apache-2.0
// The bar below the picture: framing, comparison and sharpness.
import type { Wipe } from '../state/address';
import type { AppState } from '../state/app_state';
import { button, h, readable, select } from '../ui/dom';
import type { BrowserView } from '../view/browser_view';
import type { DrawnBy } from '../view/draw_choice';
import type { Sharpness } from '../view/resolution';

const WIPES: readonly (readonly [Wipe, string])[] = [
  ['none', 'No wipe'], ['wrinkles', 'Wipe wrinkles'], ['shading', 'Wipe shading'],
];
const SHARPNESS: readonly (readonly [Sharpness, string])[] = [
  ['auto', 'Auto detail'], ['sharp', 'Full detail'], ['fast', 'Fast (coarse)'],
];

const DRAWN_BY: readonly (readonly [DrawnBy, string])[] = [
  ['auto', 'Drawn by the faster'], ['browser', 'Drawn by this browser'], ['daemon', 'Drawn by the daemon'],
];

/** A short label, because all framings share one row. */
function shortName(name: string): string {
  return readable(name.replace('three_quarter', '¾'));
}

export class ViewBar {
  readonly element: HTMLElement;
  private readonly framings = h('div', { class: 'framings', role: 'group', 'aria-label': 'Framing' });
  private readonly wipe: HTMLSelectElement;
  private readonly drawnBy: HTMLSelectElement;

  constructor(private readonly state: AppState, debugViews: HTMLElement, drawing: BrowserView) {
    this.wipe = select('Split the picture', WIPES, (value) => state.wipe.set(value as Wipe));
    const sharpness = select('Sharpness', SHARPNESS, (value) => state.sharpness.set(value as Sharpness));
    this.drawnBy = select('Drawn by', DRAWN_BY, (value) => state.drawnBy.set(value as DrawnBy));
    this.element = h('div', { class: 'view-bar', role: 'toolbar', 'aria-label': 'View' },
      this.framings, h('span', { class: 'space' }), h('div', { class: 'choices' }, debugViews, this.wipe, sharpness, this.drawnBy));
    state.presets.bind(() => this.fill());
    state.camera.watch(() => this.mark());
    state.wipe.bind((wipe) => (this.wipe.value = wipe));
    state.drawnBy.bind((drawnBy) => (this.drawnBy.value = drawnBy));
    drawing.why.bind((why) => {
      this.drawnBy.title = why === '' ? 'This browser draws the picture' : `The daemon draws the picture: ${why}`;
    });
  }

  /** Chooses the preset at `index`, counted from 0. */
  choose(index: number): void {
    const preset = this.state.presets.value[index];
    if (preset !== undefined) this.state.choosePreset(preset.name);
  }

  nextWipe(): void {
    const at = WIPES.findIndex(([wipe]) => wipe === this.state.wipe.value);
    this.state.wipe.set(WIPES[(at + 1) % WIPES.length]![0]);
  }

  private fill(): void {
    this.framings.replaceChildren(...this.state.presets.value.map(({ name }, i) =>
      button(shortName(name), () => this.state.choosePreset(name), {
        'data-preset': name, title: i < 9 ? `${readable(name)} (key ${i + 1})` : readable(name),
      })));
    this.mark();
  }

  private mark(): void {
    const chosen = this.state.presetName();
    for (const item of this.framings.querySelectorAll<HTMLElement>('button')) {
      item.setAttribute('aria-pressed', String(item.dataset.preset === chosen));
    }
  }
}
