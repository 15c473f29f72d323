// SPDX-License-Identifier: Apache-2.0
// A second subject beside the large picture, with the same camera and the same settings.
import type { AppState } from '../state/app_state';
import { type Condition, isDimmed, type PictureState } from '../panels/condition';
import { text } from '../text';
import { button, h } from '../ui/dom';
import type { Signal } from '../ui/signal';
import { CameraInput } from '../view/camera_input';
import { LivePicture } from '../view/live_picture';
import type { Viewer } from '../view/viewer';
import type { Connection } from '../wire/connection';

const t = text.grid;
const RATE_HZ = 60;

export class Against {
  readonly element: HTMLElement;
  /** The name on the large picture, while two are compared. */
  readonly nameOfFocus = h('p', { class: 'pane-name', hidden: true });
  readonly live: LivePicture;
  private readonly surface: HTMLElement;
  private isStarted = false;
  private readonly name = h('p', { class: 'pane-name' });

  constructor(connection: Connection, private readonly state: AppState, private readonly viewer: Viewer) {
    this.live = new LivePicture(connection);
    this.surface = h('div', { class: 'pane-surface', tabindex: 0, role: 'application', 'aria-label': t.paneHelp }, this.live.canvas);
    this.element = h('section', { class: 'against', 'aria-label': t.pane, hidden: true }, this.surface, this.name,
      button('×', () => state.against.set(''), { class: 'pane-close', 'aria-label': t.compareEnd, title: t.compareEnd }));
    new CameraInput(this.surface, { camera: () => state.camera.value, move: (camera) => state.moveCamera(camera) });
    const { settings, camera, comparing, sharpness } = state;
    for (const signal of [settings.changed, camera, comparing, sharpness]) (signal as Signal<unknown>).watch(() => this.refresh());
    this.live.hasPicture.watch((has) => this.element.classList.toggle('has-picture', has));
    state.against.bind((against) => {
      this.element.hidden = this.nameOfFocus.hidden = against === '';
      this.refresh();
    });
    new ResizeObserver(() => this.refresh()).observe(this.surface);
  }

  /**
   * Called once per second, with the state of the large picture, which comes first and says how many pixels are fast enough. A refused
   * subscription is asked for again.
   */
  observe(state: PictureState): void {
    this.isStarted ||= state !== 'loading';
    this.refresh();
  }

  show(condition: Condition, focus: string): void {
    const words = t.tile(this.state.against.value, text.state[condition.state]);
    if (this.name.textContent !== words) this.name.textContent = words;
    if (this.nameOfFocus.textContent !== focus) this.nameOfFocus.textContent = focus;
    this.name.title = condition.text;
    this.element.dataset.state = condition.state;
    this.element.classList.toggle('dimmed', isDimmed(condition.state));
  }

  private refresh(): void {
    const against = this.state.against.value;
    const density = devicePixelRatio * this.viewer.pixelScale(this.live.isResting);
    this.live.request(against === '' || !this.isStarted ? null : this.viewer.requestOf(against, this.surface, density, RATE_HZ));
  }
}
