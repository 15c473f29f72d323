// SPDX-License-Identifier: Apache-2.0
// The part of time that the curves show, and markers in it. Pure: times are parameters, in seconds on the page's clock.

export const USUAL_S = 10;
const SHORTEST_S = 0.5;
const MOST_MARKERS = 20;

/** What is kept of the past. */
export interface Kept {
  oldestS: number;
  newestS: number;
}

export interface Marker {
  number: number;
  atS: number;
  /** Of its pose. */
  sequence: number;
}

export class CurveSpan {
  private spanS = USUAL_S;
  /** Null: the curves end with the newest pose. */
  private endS: number | null = null;
  private zeroS = 0;
  private numMarkers = 0;
  private marked: Marker[] = [];

  /** `longestS`: what is kept at most. */
  constructor(private readonly longestS: number) {}

  get isLive(): boolean {
    return this.endS === null;
  }
  get lengthS(): number {
    return this.spanS;
  }
  get markers(): readonly Marker[] {
    return this.marked;
  }

  /** The first and the last moment that is shown. */
  range({ newestS }: Kept): [number, number] {
    const end = this.endS ?? newestS;
    return [end - this.spanS, end];
  }

  /** The moment that the axis calls 0: the newest pose, or the one that was the newest when time was stopped. */
  zero({ newestS }: Kept): number {
    return this.isLive ? newestS : this.zeroS;
  }

  stop({ newestS }: Kept): void {
    if (!this.isLive) return;
    this.endS = this.zeroS = newestS;
  }

  live(): void {
    this.endS = null;
  }

  /** `share`: where in the span, in [0, 1], time stays where it is. Live curves keep their end. */
  zoom(factor: number, share: number, kept: Kept): void {
    const [from, to] = this.range(kept);
    const length = Math.min(this.longestS, Math.max(SHORTEST_S, this.spanS * factor));
    if (!this.isLive) {
      const fixed = from + share * (to - from);
      this.place(fixed + (1 - share) * length, length, kept);
    }
    this.spanS = length;
  }

  /** Positive: later. The curves are live again at the newest pose. */
  pan(seconds: number, kept: Kept): void {
    if (this.isLive && seconds >= 0) return;
    this.stop(kept);
    this.place(this.endS! + seconds, this.spanS, kept);
    if (this.endS! >= kept.newestS) this.live();
  }

  /** Brings a moment to the middle. */
  show(atS: number, kept: Kept): void {
    this.stop(kept);
    this.place(atS + this.spanS / 2, this.spanS, kept);
  }

  private place(endS: number, length: number, { oldestS, newestS }: Kept): void {
    const earliest = Math.min(newestS, oldestS + length);
    this.endS = Math.min(newestS, Math.max(earliest, endS));
  }

  /** The oldest of too many goes. */
  mark(atS: number, sequence: number): void {
    this.marked = [...this.marked, { number: ++this.numMarkers, atS, sequence }].slice(-MOST_MARKERS);
  }

  unmark(number: number): void {
    this.marked = this.marked.filter((marker) => marker.number !== number);
  }

  /** Markers whose pose is no longer kept go. Returns true if there were any. */
  forget({ oldestS }: Kept): boolean {
    const count = this.marked.length;
    this.marked = this.marked.filter(({ atS }) => atS >= oldestS);
    return this.marked.length < count;
  }

  /** Another subject has another past. */
  reset(): void {
    this.marked = [];
    this.numMarkers = 0;
    this.live();
  }
}
