// SPDX-License-Identifier: Apache-2.0
// The number of pixels to request. "sharp" uses the density of the screen. If the daemon cannot draw
// that fast enough, "auto" requests fewer pixels while the picture moves and all of them at rest. A daemon
// without a GPU first draws fewer pixels than it sends, and completes them from former pictures.

export type Sharpness = 'auto' | 'sharp' | 'fast';

/** Share of the width and height, percent, below which a daemon draws no picture. */
const LEAST_DRAWN = 50;
/** From this share on, the daemon has time for more pixels. */
const SPARE_DRAWN = 75;
/** Seconds in a row; in the first one, the daemon may still be about to draw fewer pixels. */
const SLOW_S = 2;
const STEPS = [1, 0.75, 0.5, 0.35, 0.25] as const;
/** Below this, the eye sees single pictures rather than motion. */
const TOO_SLOW_HZ = 20;
/** Pictures of fewer pixels hide the folds, and save little: the vertices take as long in any size. */
const FOLD_PIXELS = 100_000;
const FAST_HZ = 27;
/** If a larger size turns out too slow within this time, the next attempt waits longer. */
const SOON_S = 10;
const MAX_PATIENCE_S = 64;

/** Chooses one of STEPS from the picture rate of a moving pose. */
export class AdaptiveScale {
  private step = 0;
  private slowSeconds = 0;
  private fastSinceS: number | null = null;
  private raisedAtS = -Infinity;
  private patienceS = 4;

  get scale(): number {
    return STEPS[this.step]!;
  }

  /** Chooses the first scale: the largest one with at most `affordable` of `pixels`. */
  begin(pixels: number, affordable: number): void {
    const fits = STEPS.findIndex((scale) => pixels * scale * scale <= affordable);
    this.step = fits < 0 ? STEPS.length - 1 : fits;
  }

  /**
   * Called once per second with pictures and poses per second. `drawnPercent`: of the last picture. `pixels`: of a
   * picture of scale 1. Returns true if the scale changed.
   */
  observe(picturesHz: number, posesHz: number, nowS: number, drawnPercent: number, pixels: number): boolean {
    const showsFolds = (step: number): boolean => pixels * (STEPS[step] ?? 0) ** 2 >= FOLD_PIXELS;
    if (this.step > 0 && !showsFolds(this.step)) { // the window has become smaller
      --this.step;
      return true;
    }
    if (picturesHz < Math.min(TOO_SLOW_HZ, 0.8 * posesHz)) {
      this.fastSinceS = null;
      if (++this.slowSeconds < SLOW_S) return false;
      // In between, the daemon has something left to do about it.
      return (drawnPercent === 100 || drawnPercent <= LEAST_DRAWN) && showsFolds(this.step + 1) && this.lower(nowS);
    }
    this.slowSeconds = 0;
    if (picturesHz < Math.min(FAST_HZ, 0.9 * posesHz) || this.step === 0 || drawnPercent < SPARE_DRAWN) {
      this.fastSinceS = null;
      return false;
    }
    this.fastSinceS ??= nowS;
    if (nowS - this.fastSinceS < this.patienceS) return false;
    --this.step;
    this.raisedAtS = nowS;
    this.fastSinceS = null;
    return true;
  }

  private lower(nowS: number): boolean {
    this.slowSeconds = 0;
    if (nowS - this.raisedAtS < SOON_S) this.patienceS = Math.min(MAX_PATIENCE_S, this.patienceS * 2);
    ++this.step;
    return true;
  }
}

/** Pixels to request: CSS size times density, rounded to even numbers in [16, 4096]. */
export function pictureSize(cssWidth: number, cssHeight: number, density: number, scale: number):
    { width: number; height: number } {
  const factor = Math.min(density * scale, 4096 / Math.max(cssWidth, cssHeight, 1));
  const side = (css: number): number => Math.max(16, Math.round((css * factor) / 2) * 2);
  return { width: side(cssWidth), height: side(cssHeight) };
}
