// SPDX-License-Identifier: Apache-2.0
// Walks through gestures: says when a pose is far enough from neutral, steady, and held. Time is a parameter.
import { type Difference, differenceOf, meanOf, type Sample, wobbleOf } from './measure';
import type { Gesture } from './gestures';

/** Time to read what is asked for. */
export const READ_MS = 2000;
/** The time over which steadiness is judged. */
export const WINDOW_MS = 1000;
/** Time for which a good pose is held before it is captured. */
export const HOLD_MS = 500;
/** Time for which the page says that the pose was good. */
export const GOOD_MS = 1200;
/** A window with a gap says nothing about steadiness. Longer than a busy browser pauses. */
const MOST_GAP_MS = 500;
/** Samples that follow sooner say nothing new. */
const LEAST_GAP_MS = 15;

/** What is far, and what is steady. */
export interface Limits {
  far: Difference;
  steady: Difference;
}
export const FACE: Limits = { far: { mm: 3, shape: 0.3 }, steady: { mm: 1, shape: 0.05 } };
export const BODY: Limits = { far: { mm: 30, shape: 0.3 }, steady: { mm: 10, shape: 0.05 } };

/** - read: the instruction is new. - move: not far enough. - hold: far enough. - take: capture it now. - good: it is captured. */
export type Phase = 'read' | 'move' | 'hold' | 'take' | 'good';

export interface Progress {
  phase: Phase;
  /** From the neutral pose. */
  distance: Difference;
  /** Of the last second; null: it is too short yet. */
  wobble: Difference | null;
  /** In [0, 1]; 1: far enough, steady enough, held long enough. */
  far: number;
  steady: number;
  held: number;
}

/** The quality of a pose when it was captured. Null: it has none (the neutral pose), or it was captured before it was known. */
export interface Taken {
  distance: Difference | null;
  wobble: Difference | null;
}

const NONE: Difference = { mm: 0, shape: 0 };
const share = (value: Difference, whole: Difference): number => Math.min(1, Math.max(value.mm / whole.mm, value.shape / whole.shape));
/** 1 up to the limit, 0 at three times as much. */
const calm = (value: Difference, limit: Difference): number =>
  Math.min(1, Math.max(0, (3 - Math.max(value.mm / limit.mm, value.shape / limit.shape)) / 2));

export class Guide {
  /** Index of the present gesture; the number of gestures: all were shown. */
  at = 0;
  /** Null: not captured. */
  readonly taken: (Taken | null)[];
  private samples: (Sample & { atMs: number })[] = [];
  private beganMs: number;
  private goodMs: number | null = null;
  private farMs: number | null = null;

  /** `neutral`: from which distances are measured until the performer's own is captured. */
  constructor(readonly gestures: readonly Gesture[], private neutral: Sample, private readonly limits: Limits, nowMs: number) {
    this.taken = gestures.map(() => null);
    this.beganMs = nowMs;
  }

  get gesture(): Gesture | null {
    return this.gestures[this.at] ?? null;
  }
  get isOver(): boolean {
    return this.at >= this.gestures.length;
  }
  private get isNeutral(): boolean {
    return this.at === 0;
  }

  add(sample: Sample, nowMs: number): void {
    const last = this.samples.at(-1);
    if (last !== undefined && nowMs - last.atMs < LEAST_GAP_MS) return;
    this.samples.push({ ...sample, atMs: nowMs });
    while (this.samples[0]!.atMs < nowMs - WINDOW_MS) this.samples.shift();
  }

  /** True if no pose has arrived for a while. */
  isSilent(nowMs: number): boolean {
    const last = this.samples.at(-1);
    return nowMs - (last?.atMs ?? this.beganMs) > WINDOW_MS;
  }

  progress(nowMs: number): Progress {
    const last = this.samples.at(-1);
    const distance = last === undefined || this.isOver ? NONE : differenceOf(last, this.neutral);
    const wobble = this.isSilent(nowMs) ? null : this.wobble();
    const far = this.isNeutral ? 1 : share(distance, this.limits.far);
    const steady = wobble === null ? 0 : calm(wobble, this.limits.steady);
    if (far < 1 || steady < 1) this.farMs = null;
    else this.farMs ??= nowMs;
    const held = this.farMs === null ? 0 : Math.min(1, (nowMs - this.farMs) / HOLD_MS);
    return { phase: this.phase(nowMs, far, held), distance, wobble, far, steady, held };
  }

  private phase(nowMs: number, far: number, held: number): Phase {
    if (this.goodMs !== null) return 'good';
    if (nowMs - this.beganMs < READ_MS) return 'read';
    if (far < 1) return 'move';
    return held < 1 ? 'hold' : 'take';
  }

  /** Null: the poses of the last second do not say. */
  private wobble(): Difference | null {
    const { samples } = this;
    if (samples.length < 2 || samples.at(-1)!.atMs - samples[0]!.atMs < 0.8 * WINDOW_MS) return null;
    if (samples.some(({ atMs }, i) => i > 0 && atMs - samples[i - 1]!.atMs > MOST_GAP_MS)) return null;
    return wobbleOf(samples);
  }

  /** The daemon has captured the present pose, and has just said so. */
  accept(nowMs: number): void {
    const { distance, wobble } = this.progress(nowMs);
    this.taken[this.at] = { distance: this.isNeutral ? null : distance, wobble };
    if (this.isNeutral && this.samples.length > 0) this.neutral = meanOf(this.samples);
    this.goodMs = nowMs;
  }

  /** The present pose was not captured. The performer shows it again; what was captured of it before stays. */
  refuse(nowMs: number): void {
    this.goTo(this.at, nowMs);
  }

  /** True while the page says that a pose was good. */
  get isPraising(): boolean {
    return this.goodMs !== null;
  }

  /** Goes on once a captured pose was praised. Returns true if the gesture has changed. */
  advance(nowMs: number): boolean {
    if (this.goodMs === null || nowMs - this.goodMs < GOOD_MS) return false;
    this.goTo(this.next(), nowMs);
    return true;
  }

  skip(nowMs: number): void {
    this.goTo(this.at + 1, nowMs);
  }

  back(nowMs: number): void {
    this.goTo(this.at - 1, nowMs);
  }

  /** Shows a gesture again. */
  goTo(index: number, nowMs: number): void {
    this.at = Math.min(this.gestures.length, Math.max(0, index));
    this.beganMs = nowMs;
    this.goodMs = this.farMs = null;
    this.samples = [];
  }

  /** The next gesture that was not captured. */
  private next(): number {
    const later = this.taken.findIndex((taken, i) => i > this.at && taken === null);
    return later < 0 ? this.gestures.length : later;
  }
}
