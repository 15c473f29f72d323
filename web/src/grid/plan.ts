// SPDX-License-Identifier: Apache-2.0
// What the grid of subjects decides: which subjects have a tile, what a tile may cost, and who is followed. Pure.
import type { SubjectInfo } from '../api';
import type { PictureState } from '../panels/condition';

/** A tile is a subscription, of which a daemon allows 64 per page (limits.max_subscriptions). */
export const MAX_TILES = 24;
/** Pictures per second of all visible tiles together. */
const MOST_HZ = 30;
const LEAST_HZ = 6;
/** Pictures per second of one tile: few steps, so that the rate changes seldom. The last one suits MAX_TILES with LEAST_HZ. */
const RATES_HZ = [10, 5, 2.5, 1.25, 0.5, 0.25] as const;
/** The large picture moves well enough with this many pictures per second. */
const ENOUGH_HZ = 15;
/** The one who is followed rests when nothing has moved for this long. */
const RESTS_MS = 1500;
/** Somebody else moves if the last movement is at most this old. */
const MOVES_MS = 500;

type Followed = Pick<SubjectInfo, 'name' | 'state' | 'moved_ms'>;

/** What the tiles may cost: less while the large picture is slow, which goes first. */
export class TileBudget {
  private allHz = LEAST_HZ;

  /** Called once per second, with the state and the rate of the large picture. */
  observe(state: PictureState, picturesHz: number, posesHz: number, isAtRest: boolean): void {
    const isSlow = state === 'live' && !isAtRest && picturesHz < 0.6 * Math.min(posesHz, ENOUGH_HZ);
    if (state === 'loading' || state === 'stale') this.allHz = LEAST_HZ;
    else this.allHz = Math.min(MOST_HZ, Math.max(LEAST_HZ, this.allHz * (isSlow ? 0.5 : 1.5)));
  }

  /** Pictures per second of one tile while `numVisible` are in sight. */
  rateHz(numVisible: number): number {
    return RATES_HZ.find((hz) => hz * numVisible <= this.allHz) ?? RATES_HZ.at(-1)!;
  }
}

/** The subjects that get tiles, in the daemon's order. Where there are too many, live ones and the one in focus go first. */
export function tilesOf<T extends Pick<SubjectInfo, 'name' | 'state'>>(subjects: readonly T[], focus: string): T[] {
  const present = subjects.filter(({ state }) => state !== 'ended');
  if (present.length <= MAX_TILES) return present;
  const rank = ({ name, state }: T): number => (name === focus ? 0 : state === 'live' ? 1 : 2);
  const chosen = new Set([...present].sort((a, b) => rank(a) - rank(b)).slice(0, MAX_TILES));
  return present.filter((subject) => chosen.has(subject));
}

/**
 * The subject to put in focus while the page follows movement: the present one until it has rested, then the one who moved
 * last. Daemons know it of the subjects that somebody watches.
 */
export function whoMoves(subjects: readonly Followed[], focus: string): string {
  const movedMs = (subject: Followed | undefined): number => (subject?.state === 'live' ? (subject.moved_ms ?? Infinity) : Infinity);
  if (movedMs(subjects.find(({ name }) => name === focus)) < RESTS_MS) return focus;
  let found = focus;
  let leastMs = MOVES_MS;
  for (const subject of subjects) {
    if (movedMs(subject) >= leastMs) continue;
    leastMs = movedMs(subject);
    found = subject.name;
  }
  return found;
}

/** The tile that a key leads to from tile `at` of `count`, in rows of `columns`; -1: the key moves nothing. */
export function neighbour(key: string, at: number, count: number, columns: number): number {
  const to = { ArrowRight: at + 1, ArrowLeft: at - 1, ArrowDown: at + columns, ArrowUp: at - columns, Home: 0, End: count - 1 }[key];
  if (to === undefined) return -1;
  return to < 0 || to >= count ? at : to;
}
