// SPDX-License-Identifier: Apache-2.0
// Light and turntable: a bar on the picture, in whose mode a drag moves the lamps instead of the camera.
import type { AppState } from '../state/app_state';
import { text } from '../text';
import { button, h } from '../ui/dom';
import { icon } from '../ui/icons';
import type { Toasts } from '../ui/toast';
import { orbit } from '../view/camera';
import type { Viewer } from '../view/viewer';
import { EnvironmentRow } from './environment_row';
import { ENVIRONMENT_SETTINGS } from './environments';
import { dragged, exposureFor, isBackground, isOfLight, type LampAngles, linearOf, type Rgb, turntableRadians, withinRange } from './light_math';

const t = text.light;
/** A grey surface without wrinkles, lit as the skin is. */
const GREY: ReadonlyMap<string, string> = new Map([['view', 'weights'], ['wrinkles', 'off']]);
/** Pixels of the picture per direction that the eyedropper reads. */
const SPOT = 5;

export class LightBar {
  readonly element: HTMLElement;
  /** Enters and leaves the mode. */
  readonly toggleButton: HTMLButtonElement;
  private readonly figures = h('output', { class: 'light-figures' });
  private readonly grey = button(t.grey, () => this.toggleGrey(), { title: t.greyTitle });
  private readonly turn = button(t.turntable, () => this.toggleTurntable(), { title: t.turntableTitle });
  private readonly pick = button(t.exposure, () => undefined, { title: t.exposureTitle });
  private readonly reduced = matchMedia('(prefers-reduced-motion: reduce)');
  /** What the grey card has replaced. */
  private former: ReadonlyMap<string, string> | null = null;
  private isPicking = false;
  /** When the drag under way began; null: there is none. */
  private draggedMs: number | null = null;
  private readonly surface: HTMLElement;

  constructor(private readonly state: AppState, private readonly viewer: Viewer, private readonly toasts: Toasts) {
    const { surface } = viewer.stage;
    this.surface = surface;
    this.toggleButton = button('', () => this.toggle(), { 'aria-label': t.mode, title: t.mode });
    this.toggleButton.append(icon('light'));
    this.pick.addEventListener('click', (event) => {
      if (event.detail === 0) this.measure(0.5, 0.5); // by keyboard: the middle
      else this.setPicking(!this.isPicking);
    });
    this.element = h('div', { class: 'light-bar', role: 'toolbar', 'aria-label': t.group, hidden: true }, new EnvironmentRow(state).element,
      h('div', { class: 'light-tools' },
        this.figures, button(t.reset, () => this.reset(), { title: t.resetTitle }), this.grey, this.turn, this.pick,
        button('×', () => state.lighting.set(false), { 'aria-label': t.leave, title: t.leave })));
    const { lighting, turning, settings, kiosk } = state;
    lighting.bind((on) => {
      this.element.hidden = !on;
      this.toggleButton.setAttribute('aria-pressed', String(on));
      surface.classList.toggle('lighting', on);
      if (!on) this.setPicking(false);
      this.show();
    });
    kiosk.bind((on) => on && lighting.set(false)); // it hides the bar
    turning.bind((on) => this.turn.setAttribute('aria-pressed', String(on)));
    settings.changed.watch(() => this.show());
    surface.addEventListener('pointerdown', (event) => this.onPick(event), true);
    const drag = (sinceMs: number | null): void => {
      settings.endStep();
      this.draggedMs = sinceMs;
    };
    surface.addEventListener('pointerdown', () => drag(performance.now()));
    for (const end of ['pointerup', 'pointercancel'] as const) surface.addEventListener(end, () => drag(null));
  }

  toggle(): void {
    const { lighting, kiosk } = this.state;
    lighting.set(!lighting.value && !kiosk.value);
  }

  /** In heights of the picture. False: a drag moves the camera. A drag is one undo step, however long it takes. */
  drag(right: number, up: number): boolean {
    if (!this.state.lighting.value) return false;
    const { turn, tilt } = dragged(this.angles(), right, up);
    this.state.settings.setMany(new Map([['lights.turn_degrees', String(turn)], ['lights.tilt_degrees', String(tilt)]]), this.draggedMs ?? performance.now());
    return true;
  }

  toggleTurntable(): void {
    const { turning, camera } = this.state;
    turning.set(!turning.value);
    if (!turning.value) return;
    const beganMs = performance.now();
    let turned = 0;
    const tick = (nowMs: number): void => {
      if (!turning.value) return;
      const now = turntableRadians(Math.max(0, nowMs - beganMs) / 1000, this.reduced.matches);
      if (camera.value !== null && now !== turned) camera.set(orbit(camera.value, now - turned, 0));
      turned = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  private angles(): LampAngles {
    const { settings } = this.state;
    return { turn: Number(settings.value('lights.turn_degrees')), tilt: Number(settings.value('lights.tilt_degrees')) };
  }

  private reset(): void {
    const { settings } = this.state;
    settings.setMany(new Map(ENVIRONMENT_SETTINGS.map((name) => [name, settings.info(name)?.value ?? ''])), performance.now());
  }

  private get isGrey(): boolean {
    return [...GREY].every(([name, value]) => this.state.settings.value(name) === value);
  }

  private toggleGrey(): void {
    const { settings } = this.state;
    const usual = new Map([['view', 'final'], ['wrinkles', 'on']]);
    const next = this.isGrey ? (this.former ?? usual) : GREY;
    this.former = this.isGrey ? null : new Map([...GREY.keys()].map((name) => [name, settings.value(name)]));
    settings.setMany(next, performance.now());
  }

  private show(): void {
    if (this.element.hidden) return;
    const { turn, tilt } = this.angles();
    const words = t.figures(turn, tilt, Number(this.state.settings.value('exposure')));
    if (this.figures.textContent !== words) this.figures.textContent = words;
    this.grey.setAttribute('aria-pressed', String(this.isGrey));
  }

  private setPicking(on: boolean): void {
    this.isPicking = on;
    this.pick.setAttribute('aria-pressed', String(on));
    this.surface.classList.toggle('picking', on);
  }

  private onPick(event: PointerEvent): void {
    if (!this.isPicking) return;
    event.preventDefault();
    event.stopPropagation();
    const { left, top, width, height } = this.surface.getBoundingClientRect();
    this.measure((event.clientX - left) / width, (event.clientY - top) / height);
    this.setPicking(false);
  }

  private expose(wanted: number): void {
    const { settings } = this.state;
    const exposure = withinRange(wanted, settings.info('exposure')?.max ?? 16);
    settings.set('exposure', exposure.toFixed(2), performance.now());
    if (Math.abs(exposure - wanted) > 0.0051) this.toasts.say(t.limited(exposure));
  }

  /** Makes the point at these shares of the picture as bright as a grey card. */
  private measure(x: number, y: number): void {
    const { settings } = this.state;
    const canvas = this.viewer.canvas();
    if (canvas === null || this.viewer.isChanging) {
      // The colours must be those of the present exposure.
      this.toasts.say(canvas === null ? text.stage.noPicture : t.wait, 'error');
      return;
    }
    if (!isOfLight(settings.value('view'))) {
      this.toasts.say(t.noLight, 'error');
      return;
    }
    const colour = spotOf(canvas, x, y);
    const present = Number(settings.value('exposure'));
    const background = settings.value('background').split(',').map((value) => Number(value) * present) as unknown as Rgb;
    const isNeutral = settings.value('tone_map') !== 'clip';
    const exposure = exposureFor(linearOf(colour, isNeutral), present);
    if (isBackground(colour, background, isNeutral)) this.toasts.say(t.isBackground, 'error');
    else if (exposure === null) this.toasts.say(t.tooDark, 'error');
    else this.expose(exposure);
  }
}

/** The mean colour of a few pixels, sRGB in [0, 255]. */
function spotOf(canvas: HTMLCanvasElement, x: number, y: number): Rgb {
  const spot = h('canvas', { width: SPOT, height: SPOT });
  const context = spot.getContext('2d', { willReadFrequently: true })!;
  const corner = (share: number, size: number): number => Math.round(Math.min(size - SPOT, Math.max(0, share * size - SPOT / 2)));
  context.drawImage(canvas, corner(x, canvas.width), corner(y, canvas.height), SPOT, SPOT, 0, 0, SPOT, SPOT);
  const { data } = context.getImageData(0, 0, SPOT, SPOT);
  return [0, 1, 2].map((channel) => {
    let sum = 0;
    for (let i = channel; i < data.length; i += 4) sum += data[i]!;
    return sum / (SPOT * SPOT);
  }) as unknown as Rgb;
}
