// SPDX-License-Identifier: Apache-2.0
// The bar below the picture: framing, comparison and sharpness.
import type { Wipe } from '../state/address';
import type { AppState } from '../state/app_state';
import { text } from '../text';
import { button, h, readable, select } from '../ui/dom';
import type { BrowserView } from '../view/browser_view';
import type { DrawnBy } from '../view/draw_choice';
import type { Sharpness } from '../view/resolution';

const t = text.viewBar;
const WIPES: readonly (readonly [Wipe, string])[] = [
  ['none', t.wipes.none], ['wrinkles', t.wipes.wrinkles], ['shading', t.wipes.shading],
];
const SHARPNESS: readonly (readonly [Sharpness, string])[] = [
  ['auto', t.details.auto], ['sharp', t.details.sharp], ['fast', t.details.fast],
];

const DRAWN_BY: readonly (readonly [DrawnBy, string])[] = [
  ['auto', t.drawers.auto], ['browser', t.drawers.browser], ['daemon', t.drawers.daemon],
];

/** A short label, because all framings share one row. */
function shortName(name: string): string {
  return readable(name.replace('three_quarter', '¾'));
}

export class ViewBar {
  readonly element: HTMLElement;
  private readonly framings = h('div', { class: 'framings', role: 'group', 'aria-label': t.framing });
  private readonly wipe: HTMLSelectElement;
  private readonly drawnBy: HTMLSelectElement;

  constructor(private readonly state: AppState, debugViews: HTMLElement, drawing: BrowserView) {
    this.wipe = select(t.split, WIPES, (value) => state.wipe.set(value as Wipe));
    const sharpness = select(t.sharpness, SHARPNESS, (value) => state.sharpness.set(value as Sharpness));
    this.drawnBy = select(t.drawnBy, DRAWN_BY, (value) => state.drawnBy.set(value as DrawnBy));
    this.element = h('div', { class: 'view-bar', role: 'toolbar', 'aria-label': t.group },
      this.framings, h('span', { class: 'space' }), h('div', { class: 'choices' }, debugViews, this.wipe, sharpness, this.drawnBy));
    state.presets.bind(() => this.fill());
    state.camera.watch(() => this.mark());
    state.wipe.bind((wipe) => (this.wipe.value = wipe));
    state.drawnBy.bind((drawnBy) => (this.drawnBy.value = drawnBy));
    drawing.why.bind((why) => {
      this.drawnBy.title = why === '' ? t.drawnHere : t.drawnThere(why);
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
        'data-preset': name, title: i < 9 ? t.withKey(readable(name), i + 1) : readable(name),
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
