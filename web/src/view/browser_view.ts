// SPDX-License-Identifier: Apache-2.0
// Draws the picture in this browser while that is faster and gives the same picture as the daemon. Otherwise the daemon
// draws.
import { type ReadSettings, readSettings } from 'furrow-three/settings';
import { PoseFeed, WeightFeed } from 'furrow/protocol';
import type { SubjectInfo } from '../api';
import type { AppState } from '../state/app_state';
import { tokenHeaders } from '../state/token';
import { h } from '../ui/dom';
import { Signal } from '../ui/signal';
import type { Connection } from '../wire/connection';
import { BrowserRate } from './browser_rate';
import type { BrowserScene } from './browser_scene';
import { decide, type DrawDecision } from './draw_choice';
import { DrawnMoment } from './drawn_moment';
import type { ShownPicture } from './picture_stats';
import { pictureSize } from './resolution';

const CHARACTER_URL = 'character.glb';
/** Seconds after a change of shading in which the daemon's rate still counts pictures from before. */
const SETTLE_S = 3;

function nameOfGpu(): string {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (gl === null) return '';
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(names === null ? gl.RENDERER : names.UNMASKED_RENDERER_WEBGL));
  gl.getExtension('WEBGL_lose_context')?.loseContext(); // browsers allow few contexts
  return name === '' ? 'unknown' : name;
}

export class BrowserView {
  /** Holds the canvas while there is a character. */
  readonly element = h('div', { class: 'drawn-here', 'aria-hidden': 'true', hidden: true });
  /** True while this browser draws. */
  readonly active = new Signal(false);
  /** Why the daemon draws; empty while the browser does. */
  readonly why = new Signal('');
  private scene: BrowserScene | null = null;
  private poses: PoseFeed | null = null;
  private weights: WeightFeed | null = null;
  private subject: string | null = null;
  private gpu: string | null = null;
  private character: 'unknown' | 'loading' | 'ready' | 'none' | 'failed' = 'unknown';
  private hasNeutral = false;
  private daemonHz = 0;
  private settleS = 0;
  private read: { at: number; settings: ReadSettings; hasSkin: boolean } | null = null;
  private readonly rate = new BrowserRate();
  private readonly moment = new DrawnMoment();
  private lastNumber = -1;
  private drawn: (ShownPicture & { ageMs: number; atMs: number }) | null = null;
  private isScheduled = false;

  constructor(private readonly connection: Connection, private readonly state: AppState, private readonly onShown: () => void) {
    const { settings, wipe, comparing, drawnBy, subject } = state;
    for (const signal of [settings.changed, wipe, comparing, drawnBy, subject]) {
      (signal as Signal<unknown>).watch(() => this.update());
    }
    connection.onState((link) => {
      // The next daemon may have another character.
      if (link === 'lost') this.forget();
      this.update();
    });
  }

  /** Pictures per second, of the last two seconds. */
  rateHz(nowS: number): number {
    return this.rate.shownHz(nowS);
  }

  /** The pose that this browser has drawn; null: none. */
  shown(): ShownPicture | null {
    const { drawn } = this;
    return drawn === null ? null : { ...drawn, ageMs: drawn.ageMs + performance.now() - drawn.atMs };
  }

  /** The canvas with its picture, which browsers drop after the task that drew it. */
  canvas(): HTMLCanvasElement | null {
    this.moment.forget();
    this.draw();
    return this.element.querySelector('canvas');
  }

  /** Called once per second: what the daemon says of the shown subject, and how fast it draws a moving pose. */
  observe(subject: SubjectInfo | undefined, daemonHz: number): void {
    this.hasNeutral = subject?.neutral ?? false;
    const isVisible = document.visibilityState === 'visible';
    if (this.active.value) this.rate.check(performance.now() / 1000, Math.min(this.daemonHz, subject?.rate_hz ?? 0), isVisible);
    else if (this.settleS > 0) --this.settleS;
    else this.daemonHz = Math.max(this.daemonHz, daemonHz);
    this.update();
  }

  /** The settings of the picture. Another shading takes another time, here and there, so it is measured again. */
  private settings(): ReadSettings & { hasSkin: boolean } {
    const { settings } = this.state;
    const at = settings.changed.value;
    if (this.read?.at !== at) {
      const read = readSettings(settings.infos.map(({ name }) => [name, settings.value(name)] as const));
      const hasSkin = read.settings.shading === 'skin' || read.settings.view !== 'final';
      if (this.read !== null && this.read.hasSkin !== hasSkin) {
        this.rate.forget();
        this.daemonHz = 0;
        this.settleS = SETTLE_S;
      }
      this.read = { at, settings: read, hasSkin };
    }
    return { ...this.read.settings, hasSkin: this.read.hasSkin };
  }

  private decide(): DrawDecision {
    this.gpu ??= this.state.drawnBy.value === 'daemon' ? null : nameOfGpu();
    const pose = this.poses?.pose() ?? null;
    const weights = this.weights?.frame() ?? null;
    // Without a chosen subject, the two subscriptions may follow different ones for a moment.
    const isOne = pose !== null && weights !== null && pose.subject === weights.subject;
    return decide({
      choice: this.state.drawnBy.value,
      isConnected: this.connection.state === 'open',
      gpu: this.gpu ?? '',
      isSpecial: this.isSpecial(),
      whyNoSkin: this.settings().hasSkin ? (this.scene?.whyNoSkin ?? '') : '',
      hasNeutral: this.hasNeutral,
      character: this.character,
      fits: this.scene === null || !isOne ? null : this.scene.fits(pose, weights),
      browserHz: this.rate.hz,
      daemonHz: this.daemonHz,
    });
  }

  /** The picture is not one that furrow-three draws as the daemon does. */
  private isSpecial(): boolean {
    const { settings, wipe, comparing } = this.state;
    return settings.infos.length === 0 || wipe.value !== 'none' || comparing.value || this.settings().unsupported.length > 0;
  }

  private update(): void {
    const { step, why } = this.decide();
    this.why.set(why);
    if (step === 'load') void this.load();
    if (step === 'measure' || step === 'browser') this.schedule();
    if (this.state.drawnBy.value === 'daemon') this.stopFeeds();
    else if (this.scene !== null) this.follow();
    const active = step === 'browser';
    if (active === this.active.value) return;
    this.rate.restart();
    // Shown with the first picture (draw()), so that the daemon's stays until then.
    if (!active) {
      this.drawn = null;
      this.element.hidden = true;
      this.active.set(false);
    }
  }

  private async load(): Promise<void> {
    this.character = 'loading';
    const canvas = h('canvas');
    canvas.addEventListener('webglcontextlost', () => canvas.isConnected && this.give('failed'));
    this.element.replaceChildren(canvas);
    try {
      const headers = tokenHeaders();
      const reply = await fetch(CHARACTER_URL, { method: 'HEAD', headers });
      if (reply.status === 404) {
        if (canvas.isConnected) this.give('none');
        return;
      }
      if (!reply.ok) throw new Error(`${CHARACTER_URL}: HTTP status ${reply.status}`);
      const { BrowserScene: Scene } = await import('./browser_scene');
      const scene = await Scene.create(canvas, CHARACTER_URL, headers);
      if (!canvas.isConnected) {
        scene.dispose(); // the daemon was lost meanwhile
        return;
      }
      this.scene = scene;
      this.character = 'ready';
    } catch (error) {
      if (canvas.isConnected) this.fail(error);
    }
    this.update();
  }

  private fail(error: unknown): void {
    console.warn('this browser cannot draw the character:', error);
    this.give('failed');
  }

  /** Gives the picture back to the daemon. */
  private give(reason: 'unknown' | 'none' | 'failed'): void {
    this.character = reason;
    this.scene?.dispose();
    this.scene = null;
    this.rate.forget();
    this.element.replaceChildren();
    this.stopFeeds();
    this.update();
  }

  private forget(): void {
    this.daemonHz = 0;
    this.give('unknown');
  }

  private follow(): void {
    const subject = this.state.subject.value;
    if (this.subject === subject) return;
    this.stopFeeds();
    this.subject = subject;
    const onNews = (): void => this.update();
    const ignore = (): void => {};
    this.poses = new PoseFeed(this.connection, { subject }, { onPose: onNews, onProblem: ignore });
    this.weights = new WeightFeed(this.connection, { subject }, { onLayout: ignore, onFrame: onNews, onGone: ignore, onProblem: ignore });
  }

  private stopFeeds(): void {
    this.poses?.close();
    this.weights?.close();
    this.poses = this.weights = this.subject = null;
  }

  private schedule(): void {
    if (this.isScheduled) return;
    this.isScheduled = true;
    requestAnimationFrame(() => {
      this.isScheduled = false;
      this.draw();
    });
  }

  private draw(): void {
    const { step } = this.decide();
    const pose = this.poses?.pose() ?? null;
    const weights = this.weights?.frame() ?? null;
    const camera = this.state.camera.value;
    const surface = this.element.parentElement;
    if (this.scene === null || pose === null || weights === null || camera === null || surface === null) return;
    if (step !== 'measure' && step !== 'browser') return;
    const { width, height } = pictureSize(surface.clientWidth, surface.clientHeight, devicePixelRatio, 1);
    const view = JSON.stringify([camera, width, height, this.state.settings.changed.value]);
    const isSame = step === 'browser' && this.active.value && this.moment.isSame(pose, weights, view);
    const beganMs = performance.now();
    if (!isSame) {
      this.moment.set(pose, weights, view);
      try {
        this.scene.draw(pose, weights, this.settings().settings, camera, width, height, step === 'measure');
      } catch (error) {
        this.fail(error);
        return;
      }
    }
    const endedMs = performance.now();
    if (step === 'measure') {
      if (this.rate.sample(endedMs - beganMs)) this.update();
    } else if (!isSame || pose.number !== this.lastNumber) {
      // The last picture also shows an equal pose that has arrived since.
      this.lastNumber = pose.number;
      this.drawn = { sequence: pose.sequence, width, height, isStill: false, drawnPercent: 100, ageMs: pose.ageMs, atMs: endedMs };
      this.show(endedMs / 1000, isSame);
      this.onShown();
    }
    this.schedule();
  }

  private show(nowS: number, isRest: boolean): void {
    this.rate.shown(nowS, isRest);
    if (this.active.value) return;
    this.element.hidden = false;
    this.active.set(true);
  }
}
