// SPDX-License-Identifier: Apache-2.0
// Statistics of the pictures: rate, latency and losses.

export interface PictureFacts {
  sequence: number;
  ageUs: number;
  still: boolean;
  tier: number;
  dropped: number;
  receivedUs: number;
}

const WINDOW_S = 2;
/** After this many pictures in a row without a still, the pose or the camera counts as moving. */
const MOVES = 3;

export class PictureStats {
  private times: number[] = [];
  private latencies: number[] = [];
  private lastSequence = -1;
  private lastDropped = 0;
  /** Pictures so far. A pose at rest gets no pictures, so a low rate is not a fault. */
  shown = 0;
  dropped = 0;
  tier = 0;
  still = false;
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
    this.times.push(nowS);
    this.prune(nowS);
    this.tier = picture.tier;
    this.still = picture.still;
    this.sinceStill = picture.still ? 0 : this.sinceStill + 1;
    // The daemon counts per subscription, so a smaller number means a new subscription.
    this.dropped += picture.dropped >= this.lastDropped ? picture.dropped - this.lastDropped : picture.dropped;
    this.lastDropped = picture.dropped;
    const isFresh = picture.ageUs === 0 && !picture.still && picture.sequence !== this.lastSequence;
    this.lastSequence = picture.sequence;
    if (!isFresh || offsetUs === null || picture.receivedUs === 0) return;
    this.latencies.push(Math.max(0, (nowUs + offsetUs - picture.receivedUs) / 1000));
    if (this.latencies.length > 60) this.latencies.shift();
  }

  rateHz(nowS: number): number {
    this.prune(nowS);
    return this.times.length / WINDOW_S;
  }

  /** Median, from the pose's arrival at the daemon to the screen; null: no moving pictures yet. */
  latencyMs(): number | null {
    if (this.latencies.length === 0) return null;
    const sorted = [...this.latencies].sort((a, b) => a - b);
    return sorted[Math.floor(sorted.length / 2)]!;
  }

  private prune(nowS: number): void {
    while (this.times.length > 0 && this.times[0]! < nowS - WINDOW_S) this.times.shift();
  }
}
