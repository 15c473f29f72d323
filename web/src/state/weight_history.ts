// SPDX-License-Identifier: Apache-2.0
// The wrinkle weights of the last seconds, for curves, the face map and the download.
import type { Timecode } from 'furrow/protocol';

export interface WeightFrame {
  sequence: number;
  /** Arrival time in seconds on the page's clock. */
  atS: number;
  values: Float32Array;
  /** Null or absent: the source sends none. */
  timecode?: Timecode | null;
}

/** Numbers that are kept at most, 8 MB. */
const MOST_VALUES = 2_000_000;

export class WeightHistory {
  names: readonly string[] = [];
  /** Sequence of the pose on the screen, whose weights current() returns; null: the newest pose. */
  pinned: number | null = null;
  private frames_: WeightFrame[] = [];
  private index = new Map<string, number>();

  /** Drops frames older than `seconds`. */
  constructor(readonly seconds = 120) {}

  get frames(): readonly WeightFrame[] {
    return this.frames_;
  }
  get latest(): WeightFrame | undefined {
    return this.frames_.at(-1);
  }

  /** Index of the frame that belongs to the picture; -1: there are no frames. */
  private get currentIndex(): number {
    const { frames_, pinned } = this;
    if (pinned === null) return frames_.length - 1;
    // Weights arrive before their picture, and pictures are recent, so the search begins at the end.
    for (let i = frames_.length - 1; i >= 0; --i) {
      if (((frames_[i]!.sequence - pinned) | 0) <= 0) return i;
    }
    return frames_.length - 1;
  }
  /** The weights of the pose on the screen, or of the last pose before it that has any. */
  get current(): WeightFrame | undefined {
    return this.frames_[this.currentIndex];
  }

  /** Discards all frames, because the subject or the rig changed. */
  setNames(names: readonly string[]): void {
    if (names.length === this.names.length && names.every((n, i) => n === this.names[i])) return;
    this.names = names;
    this.index = new Map(names.map((name, i) => [name, i]));
    this.frames_ = [];
  }

  clear(): void {
    this.frames_ = [];
  }

  add(frame: WeightFrame): void {
    if (frame.values.length !== this.names.length) return;
    this.frames_.push(frame);
    const oldest = frame.atS - this.seconds;
    let stale = 0;
    const most = Math.max(1, Math.floor(MOST_VALUES / Math.max(1, this.names.length)));
    while (this.frames_[stale]!.atS < oldest || this.frames_.length - stale > most) ++stale;
    if (stale > 0) this.frames_.splice(0, stale);
  }

  /** The frames of a span of time, both ends included. */
  between(fromS: number, toS: number): readonly WeightFrame[] {
    const first = (isAfter: (frame: WeightFrame) => boolean): number => {
      let [low, high] = [0, this.frames_.length];
      while (low < high) {
        const middle = (low + high) >> 1;
        if (isAfter(this.frames_[middle]!)) high = middle;
        else low = middle + 1;
      }
      return low;
    };
    return this.frames_.slice(first(({ atS }) => atS >= fromS), first(({ atS }) => atS > toS));
  }

  /** Like between(), together with frames that are no longer kept but are `shown`. */
  betweenAndShown(shown: readonly WeightFrame[], fromS: number, toS: number): readonly WeightFrame[] {
    const keptS = this.frames_[0]?.atS ?? Infinity;
    return [...shown.filter(({ atS }) => atS >= fromS && atS <= toS && atS < keptS), ...this.between(fromS, toS)];
  }

  indexOf(name: string): number {
    return this.index.get(name) ?? -1;
  }

  /** The weight of the pose on the screen; 0 where there is none. */
  value(name: string): number {
    const i = this.indexOf(name);
    return i < 0 ? 0 : (this.current?.values[i] ?? 0);
  }

  /** The `count` names that moved most in what is kept, in the daemon's order. */
  mostActive(count: number): string[] {
    const ranges = this.names.map((name, i) => {
      let low = Infinity;
      let high = -Infinity;
      for (const { values } of this.frames_) {
        low = Math.min(low, values[i]!);
        high = Math.max(high, values[i]!);
      }
      return { name, i, range: high - low };
    });
    ranges.sort((a, b) => b.range - a.range || a.i - b.i);
    return ranges.slice(0, count).sort((a, b) => a.i - b.i).map(({ name }) => name);
  }

  /**
   * The format of `furrow watch --format csv`; time in seconds since the first row. If any frame has a timecode, the last
   * column has them.
   */
  toCsv(frames: readonly WeightFrame[], names = this.names): string {
    const first = frames[0]?.atS ?? 0;
    const hasTimecodes = frames.some(({ timecode }) => timecode);
    const rows = frames.map(({ sequence, atS, values, timecode }) =>
      [sequence, (atS - first).toFixed(6), ...Array.from(values, (v) => v.toFixed(6)), ...(hasTimecodes ? [timecode?.text ?? ''] : [])].join(','));
    return `${['frame,time', ...names, ...(hasTimecodes ? ['timecode'] : [])].join(',')}\n${rows.map((row) => `${row}\n`).join('')}`;
  }
}
