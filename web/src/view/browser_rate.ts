// SPDX-License-Identifier: Apache-2.0
// How fast this browser draws: measured before it draws for the viewer, and watched from then on. Times are in seconds.
import { dropOld, median, WINDOW_S } from './recent';

/** The first pictures compile shaders and upload textures. */
export const WARM_UP = 3;
export const MEASURED = 8;
/** Slow seconds after which the measurement counts as wrong. */
export const SLOW_S = 3;
/** Rates are counted, and screens have rates of their own, so this share of a rate counts as the whole. */
export const ENOUGH = 0.8;

export class BrowserRate {
  /** Pictures per second; null: not measured. */
  hz: number | null = null;
  private samplesMs: number[] = [];
  private pictures: { atS: number }[] = [];
  private restedAtS = -Infinity;
  private slowS = 0;

  /** A picture was drawn for measurement. Returns true if the rate is known now: that of the median picture. */
  sample(ms: number): boolean {
    this.samplesMs.push(ms);
    if (this.samplesMs.length < WARM_UP + MEASURED) return false;
    this.hz = 1000 / Math.max(median(this.samplesMs.slice(WARM_UP)), 1);
    this.samplesMs = [];
    return true;
  }

  /** The viewer sees the picture of a new pose. `isRest`: it is the last picture, because the pose equals the last one. */
  shown(nowS: number, isRest: boolean): void {
    this.pictures.push({ atS: nowS });
    if (isRest) this.restedAtS = nowS;
  }

  /** Pictures per second, of the last two seconds. */
  shownHz(nowS: number): number {
    dropOld(this.pictures, nowS);
    return this.pictures.length / WINDOW_S;
  }

  /**
   * Called once per second while the viewer sees this browser's pictures, because the GPU may be busier than it was when it was measured.
   * After SLOW_S seconds with fewer pictures than `wantedHz`, the rate is what was shown. A pose at rest and a hidden page draw nothing,
   * which says nothing.
   */
  check(nowS: number, wantedHz: number, isVisible: boolean): void {
    if (nowS - this.restedAtS <= WINDOW_S) return;
    const hz = this.shownHz(nowS);
    this.slowS = isVisible && hz < ENOUGH * wantedHz ? this.slowS + 1 : 0;
    if (this.slowS >= SLOW_S) this.hz = hz;
  }

  /** Somebody else draws from now on, or this browser again: former pictures count no longer. */
  restart(): void {
    this.pictures = [];
  }

  /** Another character or shading: it must be measured again. */
  forget(): void {
    this.hz = null;
    this.samplesMs = [];
    this.slowS = 0;
  }
}
