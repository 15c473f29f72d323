// SPDX-License-Identifier: Apache-2.0
// Keeps the picture in step with the state of the page. Requests a second picture while two are
// compared.
import { ERROR, type PictureRequest } from 'furrow/protocol';
import type { Wipe } from '../state/address';
import type { AppState } from '../state/app_state';
import { assignments, type Values } from '../state/settings';
import { text } from '../text';
import { readable } from '../ui/dom';
import { Signal } from '../ui/signal';
import type { Connection } from '../wire/connection';
import { BrowserView } from './browser_view';
import { type Picture, PictureStream } from './picture_stream';
import { PictureStats, type ShownPicture } from './picture_stats';
import { AdaptiveScale, pictureSize } from './resolution';
import { type Side, Stage } from './stage';
import { VideoChoice } from './video_choice';

interface WipeSides {
  setting: string;
  left: string;
  right: string;
  labels: { left: string; right: string };
}

const WIPES: Record<Exclude<Wipe, 'none'>, WipeSides> = {
  wrinkles: { setting: 'wrinkles', left: 'off', right: 'on', labels: text.wipe.wrinkles },
  shading: { setting: 'shading', left: 'diffuse', right: 'skin', labels: text.wipe.shading },
};

/** Pixels that a renderer on the processor draws within a fraction of a second. */
const SOFTWARE_PIXELS = 300_000;
/** Nobody minds waiting this long for a full picture. */
const LONG_MS = 500;

export class Viewer {
  readonly stage = new Stage();
  readonly stats = new PictureStats();
  /** Draws the picture instead of the daemon while it is active. */
  readonly drawing: BrowserView;
  /** The daemon's reason for not rendering; empty if it renders. */
  readonly notDrawn = new Signal('');
  readonly video: VideoChoice;
  private readonly scale = new AdaptiveScale();
  private main: PictureStream | null = null;
  private other: PictureStream | null = null;
  private accepted: Values = new Map();
  /** A change of a resting picture is drawn small first where a full picture takes long. */
  private isHasty = false;
  /** Time that the last full picture took, and when the one under way was requested. */
  private fullMs = 0;
  private fullAskedMs: number | null = null;

  constructor(
    private readonly connection: Connection,
    private readonly state: AppState,
    private readonly say: (text: string) => void,
    /** Another picture is on the screen. */
    private readonly onShown: () => void,
  ) {
    const { settings, camera, subject, wipe, comparing, sharpness } = state;
    for (const signal of [settings.changed, camera, wipe, comparing]) {
      (signal as Signal<unknown>).watch(() => {
        this.isHasty = this.stats.resting && this.fullMs > LONG_MS;
        this.refresh();
      });
    }
    sharpness.watch(() => this.refresh());
    this.video = new VideoChoice(state.stream);
    this.video.codecs.watch(() => this.refresh());
    subject.watch(() => {
      this.stats.reset();
      this.refresh();
    });
    camera.watch(() => this.stage.announce(readable(state.presetName() ?? '')));
    new ResizeObserver(() => this.refresh()).observe(this.stage.surface);
    this.drawing = new BrowserView(connection, state, () => this.onShown());
    this.stage.surface.append(this.drawing.element);
    this.drawing.active.watch((active) => this.onDrawing(active));
    connection.link.watch(() => this.onLink());
  }

  /** The daemon draws nothing for this page while the browser does. */
  private onDrawing(active: boolean): void {
    this.stage.element.dataset.drawnBy = active ? 'browser' : 'daemon';
    if (active) {
      this.main?.stop();
      this.stage.setBusy(false);
    } else {
      this.refresh();
      this.main?.start();
      // The picture on the stage is from before.
      this.stage.element.dataset.still = 'false';
      this.stage.setBusy(true);
    }
  }

  /** Called once per second to check whether the daemon keeps up with `posesHz`. */
  observeRate(posesHz: number, nowS: number): void {
    if (this.drawing.active.value) return;
    if (this.state.sharpness.value !== 'auto' || this.stats.resting || posesHz < 1) return;
    if (this.scale.observe(this.stats.rateHz(nowS), posesHz, nowS, this.stats.drawnPercent, this.screenPixels())) this.refresh();
  }

  /** Called when it is known how the daemon draws, so that the first picture comes quickly. */
  setRenderer(isSoftware: boolean): void {
    if (isSoftware) this.scale.begin(this.screenPixels(), SOFTWARE_PIXELS);
  }

  private screenPixels(): number {
    const { clientWidth, clientHeight } = this.stage.surface;
    return clientWidth * clientHeight * devicePixelRatio ** 2;
  }

  /** True until the picture shows the last change of the page. */
  get isChanging(): boolean {
    return !this.drawing.active.value && this.main?.pending.value === true;
  }

  /** What is on the screen, whoever drew it; null: nothing. */
  canvas(): HTMLCanvasElement | null {
    if (this.drawing.active.value) return this.drawing.canvas();
    return this.stage.hasPicture ? this.stage.canvas : null;
  }

  /** The pose on the screen. Null: there is no picture of this connection. */
  picture(): ShownPicture | null {
    if (this.drawing.active.value) return this.drawing.shown();
    return this.stats.picture(this.connection.nowUs(), this.connection.clock.offsetUs());
  }

  private onLink(): void {
    const link = this.connection.link.value;
    if (link === 'open') this.notDrawn.set('');
    // The picture on the screen belongs to a daemon that has gone. The next one begins again.
    if (link === 'lost') {
      this.stats.reset();
      this.video.retry();
    }
    if (link !== 'open') this.stage.element.dataset.still = 'false';
  }

  private wantedValues(): Values {
    const { settings, comparing } = this.state;
    return comparing.value ? settings.previous : settings.overrides;
  }

  /** Share of the screen's pixels per direction that pictures have, of a resting pose or of a moving one. */
  pixelScale(isResting = this.stats.resting && !this.isHasty): number {
    switch (this.state.sharpness.value) {
      case 'sharp':
        return 1;
      case 'fast':
        return 0.5 / Math.max(1, devicePixelRatio);
      default:
        return isResting ? 1 : this.scale.scale;
    }
  }

  private requestFor(values: Values, side: Side): PictureRequest | null {
    const wipe = this.state.wipe.value;
    const sided = new Map(values);
    if (wipe !== 'none') sided.set(WIPES[wipe].setting, WIPES[wipe][side]);
    const request = this.request(this.state.subject.value, sided, this.stage.surface, devicePixelRatio * this.pixelScale(), 60);
    return request === null ? null : { ...request, codecs: this.video.codecs.value };
  }

  /** The same view of another subject, for an element of this size. Null: not yet. */
  requestOf(subject: string, element: HTMLElement, density: number, maxRateHz: number): PictureRequest | null {
    return this.request(subject, this.wantedValues(), element, density, maxRateHz);
  }

  private request(subject: string, values: Values, element: HTMLElement, density: number, maxRateHz: number): PictureRequest | null {
    const camera = this.state.camera.value;
    const { clientWidth, clientHeight } = element;
    if (camera === null || clientWidth === 0) return null;
    return {
      subject,
      ...pictureSize(clientWidth, clientHeight, density, 1),
      maxRateHz,
      view: values.get('view') ?? this.state.settings.info('view')?.value ?? 'final',
      camera,
      settings: assignments(values),
    };
  }

  private refresh(): void {
    if (this.drawing.active.value) return;
    const values = this.wantedValues();
    const request = this.requestFor(values, 'right');
    if (request === null) return;
    if (this.main === null) {
      this.main = this.open(request, 'right');
      this.main.pending.bind((busy) => this.stage.setBusy(busy));
    } else {
      const former = this.main.view;
      this.main.update(request);
      if (this.main.view !== former) this.fullAskedMs = this.pixelScale() === 1 ? performance.now() : null;
    }
    this.refreshOther(values);
  }

  private refreshOther(values: Values): void {
    const wipe = this.state.wipe.value;
    const request = wipe === 'none' ? null : this.requestFor(values, 'left');
    this.stage.setWipe(wipe === 'none' ? null : WIPES[wipe].labels);
    if (request === null) {
      this.other?.stop();
      this.other = null;
    } else if (this.other === null) {
      this.other = this.open(request, 'left');
    } else {
      this.other.update(request);
    }
  }

  private open(request: PictureRequest, side: Side): PictureStream {
    const stream = new PictureStream(this.connection, request, {
      onPicture: (picture) => this.onPicture(side, picture),
      onRefused: (code, message) => this.onRefused(code, message),
      video: {
        onFailed: (failure) => this.video.fail(failure === 'slow' ? text.stream.why.slow : text.stream.why.failed),
        isImpatient: () => this.video.isImpatient,
      },
    });
    stream.start();
    return stream;
  }

  private onPicture(side: Side, picture: Picture): void {
    this.stage.show(side, picture);
    if (side === 'left') {
      this.stats.addLoad(picture.numBytes, this.connection.nowUs());
      return;
    }
    const wasResting = this.stats.resting;
    this.stats.add(picture, this.connection.nowUs(), this.connection.clock.offsetUs());
    this.notDrawn.set('');
    const isShown = !this.main!.pending.value;
    if (isShown && this.fullAskedMs !== null) {
      this.fullMs = performance.now() - this.fullAskedMs;
      this.fullAskedMs = null;
    }
    if (isShown) this.accepted = this.state.settings.overrides;
    // A slow machine draws motion and changes smaller; the first picture at rest may still be small.
    const main = this.main!;
    const former = main.view;
    const mayResize = wasResting !== this.stats.resting || (this.isHasty && isShown);
    if (isShown) this.isHasty = false;
    if (mayResize) this.refresh();
    this.stage.element.dataset.still = String(picture.still && main.view === former);
    this.onShown();
  }

  private onRefused(code: number, message: string): void {
    if (code === ERROR.notRendering) {
      this.notDrawn.set(message);
      return;
    }
    this.say(message);
    const { settings } = this.state;
    const isNews = assignments(settings.overrides).join() !== assignments(this.accepted).join();
    if (code !== ERROR.badPicture || !isNews) return; // there is no change to revert, so a new request would fail too
    settings.reject(this.accepted);
    // A rejected request leaves no subscription, so subscribe again.
    this.main?.restart(this.main.view);
    this.other?.restart(this.other.view);
  }
}
