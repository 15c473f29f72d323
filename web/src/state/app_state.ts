// SPDX-License-Identifier: Apache-2.0
// The complete state of the page. The URL follows it.
import { Signal } from '../ui/signal';
import { type Camera, type CameraPreset, fromPreset, sameCamera } from '../view/camera';
import type { DrawnBy } from '../view/draw_choice';
import type { Sharpness } from '../view/resolution';
import type { StreamKind } from '../view/video_choice';
import { layoutPairs, type PageState, readAddress, type Wipe, writeAddress } from './address';
import { isCompact } from './layout';
import { SettingsModel, type Values } from './settings';

const ADDRESS_DELAY_MS = 250;
/** Browsers allow few changes of the address, and a turntable would use them up. */
const TURNING_DELAY_MS = 2000;

/** Small screens show the picture first, and a panel when somebody asks for it. */
function usualPanel(compact = isCompact.value): string {
  return compact ? '' : 'look';
}

export class AppState {
  readonly settings = new SettingsModel();
  readonly subject: Signal<string>;
  readonly presets = new Signal<readonly CameraPreset[]>([]);
  readonly camera = new Signal<Camera | null>(null);
  readonly wipe: Signal<Wipe>;
  readonly strip: Signal<readonly string[]>;
  /** Empty: the most active ones. */
  readonly curves: Signal<readonly string[]>;
  /** The open tab of the side panel. Empty: closed. */
  readonly panel: Signal<string>;
  readonly sharpness = new Signal<Sharpness>('auto');
  readonly drawnBy: Signal<DrawnBy>;
  readonly stream: Signal<StreamKind>;
  /** The picture alone. */
  readonly kiosk: Signal<boolean>;
  /** All subjects as tiles. */
  readonly grid: Signal<boolean>;
  /** The focus goes to the subject that moves, while there are tiles. */
  readonly follows: Signal<boolean>;
  /** The subject beside the one in focus; empty: none. */
  readonly against: Signal<string>;
  /** The curves are shown. */
  readonly dock: Signal<boolean>;
  /** A drag moves the lamps instead of the camera. */
  readonly lighting = new Signal(false);
  /** The camera goes around the subject by itself. */
  readonly turning = new Signal(false);
  /** True while the user compares: the picture is drawn without the last change. */
  readonly comparing = new Signal(false);
  private readonly wishes: PageState;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private writesAtMs = Infinity;
  private began = false;
  /** The state has changed before `begin`, when the address could not follow yet. */
  private changedEarly = false;

  constructor(hash: string) {
    this.wishes = readAddress(hash);
    this.subject = new Signal(this.wishes.subject);
    this.wipe = new Signal(this.wishes.wipe);
    this.strip = new Signal<readonly string[]>(this.wishes.strip);
    this.curves = new Signal<readonly string[]>(this.wishes.curves);
    this.panel = new Signal(this.wishes.panel ?? usualPanel());
    isCompact.watch((compact) => {
      // Only what the user did not choose.
      if (this.panel.value === usualPanel(!compact)) this.panel.set(usualPanel());
    });
    this.drawnBy = new Signal(this.wishes.drawnBy);
    this.stream = new Signal(this.wishes.stream);
    this.kiosk = new Signal(this.wishes.kiosk);
    this.grid = new Signal(this.wishes.grid);
    this.follows = new Signal(this.wishes.follows);
    this.against = new Signal(this.wishes.against);
    this.dock = new Signal(this.wishes.dock);
    this.writeOn([this.subject, this.wipe, this.strip, this.curves, this.panel, this.drawnBy, this.stream, this.kiosk, this.grid,
      this.follows, this.against, this.dock, this.turning]);
  }

  /** Applies the URL once the daemon has replied. Returns names in the URL that the daemon does not know. */
  begin(presets: readonly CameraPreset[]): string[] {
    this.began = true;
    const unknown = this.settings.begin(this.wishes.settings);
    this.setPresets(presets);
    this.writeOn([this.camera, this.settings.changed]);
    if (this.changedEarly) this.writeSoon();
    return unknown;
  }

  /** The user has chosen a subject: the page no longer follows movement, or it would leave the subject at once. */
  chooseSubject(name: string): void {
    this.follows.set(false);
    this.subject.set(name);
  }

  /** Also called after a restart with another character. Chooses the same preset again. */
  setPresets(presets: readonly CameraPreset[]): void {
    const chosen = this.presetName();
    this.presets.set(presets);
    const wished = chosen ?? this.wishes.camera;
    if (typeof wished === 'string') this.choosePreset(wished);
    else if (this.camera.value === null && wished !== null) this.camera.set(wished);
    if (this.camera.value === null && presets[0] !== undefined) this.camera.set(fromPreset(presets[0]));
  }

  /** The user moves the camera, which ends the turntable. */
  moveCamera(camera: Camera): void {
    this.turning.set(false);
    this.camera.set(camera);
  }

  choosePreset(name: string): void {
    const preset = this.presets.value.find((candidate) => candidate.name === name);
    if (preset !== undefined) this.camera.set(fromPreset(preset));
  }

  /** The preset that equals the current camera, or null. */
  presetName(): string | null {
    const camera = this.camera.value;
    if (camera === null) return null;
    return this.presets.value.find((preset) => sameCamera(fromPreset(preset), camera))?.name ?? null;
  }

  page(): PageState {
    const preset = this.presetName();
    const isFirst = preset !== null && preset === this.presets.value[0]?.name;
    return {
      subject: this.subject.value,
      camera: isFirst ? null : (preset ?? this.camera.value),
      settings: new Map(this.settings.overrides),
      wipe: this.wipe.value,
      strip: [...this.strip.value],
      curves: [...this.curves.value],
      panel: this.panel.value === usualPanel() ? null : this.panel.value,
      drawnBy: this.drawnBy.value,
      stream: this.stream.value,
      kiosk: this.kiosk.value,
      grid: this.grid.value,
      follows: this.follows.value,
      against: this.against.value,
      dock: this.dock.value,
    };
  }

  /** The arrangement of the page as parts of an address. */
  layout(): Values {
    return new Map(layoutPairs(this.page()));
  }

  /** Arranges the page as a layout says; what the layout does not name is as usual. */
  arrange(layout: Values): void {
    const wanted = pageOf(layout);
    this.strip.set(wanted.strip);
    this.curves.set(wanted.curves);
    this.panel.set(wanted.panel ?? usualPanel());
    this.grid.set(wanted.grid);
    this.dock.set(wanted.dock);
    this.kiosk.set(wanted.kiosk);
  }

  /** True if the page is arranged as a layout says, whatever the layout leaves as usual. */
  isArranged(layout: Values): boolean {
    const whole = (page: PageState): string => JSON.stringify(layoutPairs({ ...page, panel: page.panel ?? usualPanel() }));
    return whole(this.page()) === whole(pageOf(layout));
  }

  /** The address of the present state. The browser's address bar follows a little later. */
  link(): string {
    if (!this.began) return location.href; // what the address says was not applied yet
    return location.href.replace(/#.*$/, '') + writeAddress(this.page());
  }

  private writeOn(signals: readonly unknown[]): void {
    for (const signal of signals) (signal as Signal<unknown>).watch(() => this.writeSoon());
  }

  private writeSoon(): void {
    if (!this.began) {
      this.changedEarly = true;
      return;
    }
    const delayMs = this.turning.value ? TURNING_DELAY_MS : ADDRESS_DELAY_MS;
    const atMs = performance.now() + delayMs;
    if (this.timer !== null) {
      if (this.writesAtMs <= atMs) return;
      clearTimeout(this.timer);
    }
    this.writesAtMs = atMs;
    this.timer = setTimeout(() => {
      this.timer = null;
      history.replaceState(null, '', this.link());
    }, delayMs);
  }
}

/** The page as a layout arranges it. */
function pageOf(layout: Values): PageState {
  return readAddress(new URLSearchParams([...layout]).toString());
}
