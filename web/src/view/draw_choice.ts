// SPDX-License-Identifier: Apache-2.0
// Decides whether the browser or the daemon draws the picture. Pure, so every case has a test.
import { text } from '../text';

/** 'auto': the browser, once it has proved faster than the daemon. */
export type DrawnBy = 'auto' | 'browser' | 'daemon';

export interface DrawSituation {
  choice: DrawnBy;
  isConnected: boolean;
  /** The name of the GPU; empty: this browser has no WebGL 2. */
  gpu: string;
  /** The settings, the view or a wipe ask for a picture that only the daemon draws. */
  isSpecial: boolean;
  /** Why this browser cannot draw the skin shading that the settings ask for; empty: it can, or they do not. */
  whyNoSkin: string;
  /** A neutral pose was captured for the subject. */
  hasNeutral: boolean;
  /** 'none': the daemon has no character for browsers. 'failed': it does not load or draw, or the GPU is lost. */
  character: 'unknown' | 'loading' | 'ready' | 'none' | 'failed';
  /** Null: no pose or no weights yet. False: the subject has another skeleton or other weights. */
  fits: boolean | null;
  /** Pictures per second that the browser could draw; null: not measured. */
  browserHz: number | null;
  /** The most pictures per second that the daemon has sent; 0: none yet. */
  daemonHz: number;
}

export interface DrawDecision {
  /** 'measure': draw some pictures without showing them. */
  step: 'daemon' | 'load' | 'measure' | 'browser';
  /** Why the daemon draws; empty if the browser does. */
  why: string;
}

/** The browser has to be this much faster. Equal rates are no reason to change. */
const ADVANTAGE = 1.2;
const LEAST_HZ = 15;

/** A GPU in software competes with the daemon for the processor, and loses. */
export function isSoftware(gpu: string): boolean {
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(gpu);
}

const { why } = text;
const byDaemon = (reason: string): DrawDecision => ({ step: 'daemon', why: reason });

export function decide(at: DrawSituation): DrawDecision {
  const isAuto = at.choice === 'auto';
  if (at.choice === 'daemon') return byDaemon(why.chosen);
  if (!at.isConnected) return byDaemon(why.noConnection);
  if (at.gpu === '') return byDaemon(why.noWebGl);
  if (isAuto && isSoftware(at.gpu)) return byDaemon(why.software);
  if (at.character === 'none') return byDaemon(why.noCharacter);
  if (at.character === 'failed') return byDaemon(why.failed);
  if (at.isSpecial) return byDaemon(why.special);
  if (at.hasNeutral) return byDaemon(why.neutral);
  if (at.character === 'unknown') return { step: isAuto && at.daemonHz === 0 ? 'daemon' : 'load', why: why.notLoaded };
  if (at.character === 'loading') return byDaemon(why.loading);
  if (at.fits === null) return byDaemon(why.noPose);
  if (!at.fits) return byDaemon(why.otherSkeleton);
  if (at.whyNoSkin !== '') return byDaemon(why.noSkin(at.whyNoSkin));
  if (isAuto && at.daemonHz === 0) return byDaemon(why.noRate);
  if (at.browserHz === null) return { step: 'measure', why: why.measuring };
  if (isAuto && at.browserHz < Math.max(LEAST_HZ, ADVANTAGE * at.daemonHz)) {
    return byDaemon(why.slower(at.daemonHz.toFixed(0), at.browserHz.toFixed(0)));
  }
  return { step: 'browser', why: '' };
}
