// SPDX-License-Identifier: Apache-2.0
// Statistics of the pictures: rate, latency, age and losses.
import { dropOld, median, WINDOW_S } from './recent';

export interface PictureFacts {
  sequence: number;
  ageUs: number;
  still: boolean;
  tier: number;
  dropped: number;
  receivedUs: number;
  width: number;
  height: number;
  /** Time that this browser took to decode the picture. */
  decodeMs: number;
  /** Of a video (RFC 6381); empty: the picture came as a file. */
  codec: string;
  numBytes: number;
  /** Share of the width and height at which the daemon drew it, percent. */
  drawnPercent: number;
}

/** What is on the screen, whoever drew it. */
export interface ShownPicture {
  /** Of its pose. */
  sequence: number;
  width: number;
  height: number;
  isStill: boolean;
  /** Below 100, the picture is enlarged. */
  drawnPercent: number;
  /** Time since the pose reached the daemon; null: unknown. */
  ageMs: number | null;
}

/** After this many pictures in a row without a still, the pose or the camera counts as moving. */
const MOVES = 3;
const MOST_SAMPLES = 60;

interface Sample {
  atS: number;
  dropped: number;
  decodeMs: number;
}

interface Load {
  atS: number;
  numBytes: number;
}

export class PictureStats {
  private samples: Sample[] = [];
  private loads: Load[] = [];
  private latencies: number[] = [];
  private lastDropped = 0;
  /** Pictures of the current connection. A pose at rest gets no pictures, so a low rate is not a fault. */
  shown = 0;
  dropped = 0;
  tier = 0;
  still = false;
  /** Of the last picture that was no still, which is always a file. */
  codec = '';
  /** Sequence of the pose on the screen; null: there is no picture. */
  sequence: number | null = null;
  width = 0;
  height = 0;
  drawnPercent = 100;
  /** When the pose on the screen reached the daemon, on the daemon's clock; 0: unknown. */
  private receivedUs = 0;
  private sinceStill = Infinity;

  /**
   * True while nothing moves. A single change at rest causes a picture and its still, which does not count as
   * movement. Otherwise a request for another size would end the rest.
   */
  get resting(): boolean {
    return this.sinceStill < MOVES;
  }

  /** `nowUs`: time on this page's clock. `offsetUs`: its offset to the daemon's clock, null while unknown. */
  add(picture: PictureFacts, nowUs: number, offsetUs: number | null): void {
    const nowS = nowUs / 1e6;
    ++this.shown;
    // The daemon counts per subscription, so a smaller number means a new subscription.
    const dropped = picture.dropped >= this.lastDropped ? picture.dropped - this.lastDropped : picture.dropped;
    this.lastDropped = picture.dropped;
    this.dropped += dropped;
    this.samples.push({ atS: nowS, dropped, decodeMs: picture.decodeMs });
    this.addLoad(picture.numBytes, nowUs);
    this.prune(nowS);
    this.tier = picture.tier;
    this.still = picture.still;
    if (!picture.still) this.codec = picture.codec;
    this.width = picture.width;
    this.height = picture.height;
    this.drawnPercent = picture.drawnPercent;
    this.receivedUs = picture.receivedUs;
    this.sinceStill = picture.still ? 0 : this.sinceStill + 1;
    const isFresh = picture.ageUs === 0 && !picture.still && picture.sequence !== this.sequence;
    this.sequence = picture.sequence;
    if (!isFresh || offsetUs === null || picture.receivedUs === 0) return;
    this.latencies.push(Math.max(0, (nowUs + offsetUs - picture.receivedUs) / 1000));
    if (this.latencies.length > MOST_SAMPLES) this.latencies.shift();
  }

  /** Also for the left picture of a wipe, which add() must not count. */
  addLoad(numBytes: number, nowUs: number): void {
    this.loads.push({ atS: nowUs / 1e6, numBytes });
    this.prune(nowUs / 1e6);
  }

  /** Forgets the pictures of a daemon or a subject that has gone. */
  reset(): void {
    this.samples = [];
    this.loads = [];
    this.latencies = [];
    this.shown = this.lastDropped = this.receivedUs = 0;
    this.sequence = null;
    this.still = false;
    this.codec = '';
    this.sinceStill = Infinity;
  }

  rateHz(nowS: number): number {
    this.prune(nowS);
    return this.samples.length / WINDOW_S;
  }

  /** Poses per second that were skipped because this viewer or its network was slow. */
  waitedHz(nowS: number): number {
    this.prune(nowS);
    return this.samples.reduce((sum, { dropped }) => sum + dropped, 0) / WINDOW_S;
  }

  /** Megabits per second that the pictures took, both of a wipe. */
  mbitPerS(nowS: number): number {
    this.prune(nowS);
    return (this.loads.reduce((sum, { numBytes }) => sum + numBytes, 0) * 8) / 1e6 / WINDOW_S;
  }

  /** Mean time to decode a picture; 0 if there is none in the last two seconds. */
  decodeMs(): number {
    const { samples } = this;
    return samples.length === 0 ? 0 : samples.reduce((sum, { decodeMs }) => sum + decodeMs, 0) / samples.length;
  }

  /** Median, from the pose's arrival at the daemon to the screen; null: no moving pictures yet. */
  latencyMs(): number | null {
    return this.latencies.length === 0 ? null : median(this.latencies);
  }

  /** Time since the pose on the screen reached the daemon; null: unknown. */
  ageMs(nowUs: number, offsetUs: number | null): number | null {
    if (this.sequence === null || this.receivedUs === 0 || offsetUs === null) return null;
    return Math.max(0, (nowUs + offsetUs - this.receivedUs) / 1000);
  }

  /** What is on the screen; null: there is no picture of this connection. */
  picture(nowUs: number, offsetUs: number | null): ShownPicture | null {
    const { sequence, width, height, still, drawnPercent } = this;
    if (sequence === null) return null;
    return { sequence, width, height, isStill: still, drawnPercent, ageMs: this.ageMs(nowUs, offsetUs) };
  }

  private prune(nowS: number): void {
    for (const list of [this.samples, this.loads]) dropOld(list, nowS);
  }
}
