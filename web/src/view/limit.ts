// SPDX-License-Identifier: Apache-2.0
// Finds what limits the rate of the pictures. Pure, so every case has a test.

/** 'none': the pictures keep up with the poses. */
export type Limit = 'none' | 'drawing' | 'network' | 'browser';

export interface Pace {
  /** Poses per second that reach the daemon. */
  posesHz: number;
  /** Pictures per second on the screen. */
  picturesHz: number;
  /** Poses per second that the daemon skipped because two pictures were not acknowledged yet. */
  waitedHz: number;
  /** The daemon draws a picture, of whatever viewer. */
  isDrawing: boolean;
  /** Mean time to decode a picture here. */
  decodeMs: number;
  /** The picture does not change because the pose rests. */
  isAtRest: boolean;
  /** This browser draws the pictures. */
  isHere: boolean;
}

/** Screens show no more. */
const SCREEN_HZ = 60;
/** Rates are counted, so this share of a rate counts as the whole. */
const ENOUGH = 0.85;
/** The share of the poses that waited for this viewer, above which the renderer is not the limit. */
const WAITED = 0.2;
/** The share of the time spent on decoding, above which this browser is busy. */
const BUSY = 0.5;

export function limitOf(pace: Pace): Limit {
  if (pace.isAtRest || pace.posesHz < 1) return 'none';
  if (pace.picturesHz >= ENOUGH * Math.min(pace.posesHz, SCREEN_HZ)) return 'none';
  if (pace.isHere) return 'browser';
  // The count of skipped poses comes with pictures. Without any, an idle renderer waits until the last ones are acknowledged.
  if (pace.picturesHz === 0 && !pace.isDrawing) return 'network';
  if (pace.waitedHz < WAITED * pace.posesHz) return 'drawing';
  return (pace.decodeMs * pace.picturesHz) / 1000 > BUSY ? 'browser' : 'network';
}
