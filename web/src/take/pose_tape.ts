// SPDX-License-Identifier: Apache-2.0
// Poses of one subject as they arrived, in bounded memory. Pure: times are parameters, in seconds on the page's clock.

/** Memory of one pose beside its payload: its envelope, and the objects of the browser, here and while a take is written. */
const OVERHEAD_BYTES = 400;
/** A larger gap is a restart of the sender, not a loss. */
const MOST_MISSED = 100_000;

export interface TapedPose {
  atS: number;
  sequence: number;
  captureTimeUs: bigint;
  /** FPOS without its envelope. */
  payload: Uint8Array;
}

/** The poses of one skeleton from one session of the sender. */
export interface Reel {
  session: bigint;
  /** FSKO without its envelope. */
  skeleton: Uint8Array;
  /** In order of arrival. */
  poses: TapedPose[];
}

/** Poses that were skipped or lost on their way here. A reel goes on after a reconnect, so its poses count, too. */
export function numMissed(reels: readonly Reel[]): number {
  let missed = 0;
  for (const { poses } of reels) {
    for (let i = 1; i < poses.length; ++i) {
      const ahead = (poses[i]!.sequence - poses[i - 1]!.sequence) >>> 0;
      if (ahead > 1 && ahead <= MOST_MISSED) missed += ahead - 1;
    }
  }
  return missed;
}

export class PoseTape {
  /** Poses that the daemon dropped, because the page or the network was too slow. */
  numDropped = 0;
  private readonly reels: Reel[] = [];
  private used = 0;

  /** `originMs`: time since 1970 at which the page's clock began, as of the beginning of the recording. */
  constructor(readonly subject: string, readonly originMs: number, private readonly mostBytes: number) {}

  get numBytes(): number {
    return this.used;
  }
  /** When the first and the last pose arrived; null: there is none. */
  get range(): [number, number] | null {
    const filled = this.reels.filter(({ poses }) => poses.length > 0);
    return filled.length === 0 ? null : [filled[0]!.poses[0]!.atS, filled.at(-1)!.poses.at(-1)!.atS];
  }

  /** The poses that follow have this skeleton. The daemon sends it again after a reconnect. False: the tape is full. */
  addSkeleton(session: bigint, skeleton: Uint8Array): boolean {
    const last = this.reels.at(-1);
    if (last !== undefined && last.session === session && isEqual(last.skeleton, skeleton)) return true;
    if (last?.poses.length === 0) {
      this.reels.pop();
      this.used -= last.skeleton.length + OVERHEAD_BYTES;
    }
    const size = skeleton.length + OVERHEAD_BYTES;
    if (this.used + size > this.mostBytes) return false;
    this.reels.push({ session, skeleton, poses: [] });
    this.used += size;
    return true;
  }

  /** False: the tape is full. A pose without a skeleton and the pose that came last are left out. */
  addPose(pose: TapedPose): boolean {
    const reel = this.reels.at(-1);
    if (reel === undefined || reel.poses.at(-1)?.sequence === pose.sequence) return true;
    const size = pose.payload.length + OVERHEAD_BYTES;
    if (this.used + size > this.mostBytes) return false;
    reel.poses.push(pose);
    this.used += size;
    return true;
  }

  /** The poses that arrived from `fromS` to `toS`, both included, with their skeletons. Empty: there are none. */
  between(fromS: number, toS: number): Reel[] {
    return this.reels
      .map((reel) => ({ ...reel, poses: reel.poses.filter(({ atS }) => atS >= fromS && atS <= toS) }))
      .filter(({ poses }) => poses.length > 0);
  }
}

function isEqual(a: Uint8Array, b: Uint8Array): boolean {
  return a.length === b.length && a.every((byte, i) => byte === b[i]);
}
