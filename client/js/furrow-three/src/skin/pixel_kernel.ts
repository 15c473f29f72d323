// SPDX-License-Identifier: Apache-2.0
// The separable kernel on a grid of pixels: render/skin/pixel_kernel.h explains it and is the same in C++.
import { type SkinGaussian, stepResponse } from './skin_profile.js';

/** One side of the kernel: the centre, then taps at increasing distance. The other side mirrors it. */
export interface PixelTaps {
  /** Whole pixels: x along the axis, y across it. */
  offsets: [number, number][];
  /** Per channel, weights[0] plus twice the others is 1. */
  weights: [number, number, number][];
}

const LEAST_WEIGHT = 5e-4;
const MAX_CELLS_PER_MM = 24;
const TAIL = 2;
const ASIDE = 0.2;
const [LEAST_TAPS, MOST_TAPS] = [5, 41];

type Triple = [number, number, number];

const plus = (a: Triple, b: Triple, scale = 1): Triple => [a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]];
const dot = (a: Triple, b: Triple): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The profile's response to an edge, cell by cell, and the staircases that approximate it. */
class EdgeResponse {
  private readonly counts = [0];
  private readonly rests: Triple[] = [[0, 0, 0]];
  private readonly squares = [0];

  constructor(profile: readonly SkinGaussian[], cellsPerMm: number) {
    for (;;) {
      const mm = (this.cells + 0.5) / cellsPerMm;
      const rest = stepResponse(profile, mm).map((light) => 1 - light) as Triple;
      if (Math.max(...rest) < LEAST_WEIGHT) return;
      const counts = 1 + TAIL * mm;
      this.counts.push(this.counts.at(-1)! + counts);
      this.rests.push(plus(this.rests.at(-1)!, rest, counts));
      this.squares.push(this.squares.at(-1)! + counts * dot(rest, rest));
    }
  }

  /** Number of cells until the response is within LEAST_WEIGHT of 1. */
  get cells(): number {
    return this.rests.length - 1;
  }

  private rest(from: number, to: number): Triple {
    return plus(this.rests[to]!, this.rests[from]!, -1);
  }

  /** The best level for the cells [from, to). */
  level(from: number, to: number): Triple {
    const counts = this.counts[to]! - this.counts[from]!;
    return this.rest(from, to).map((rest) => 1 - rest / counts) as Triple;
  }

  private error(from: number, to: number): number {
    const rest = this.rest(from, to);
    return this.squares[to]! - this.squares[from]! - dot(rest, rest) / (this.counts[to]! - this.counts[from]!);
  }

  /** The start of each step of the best staircase, followed by the cell where the level 1 begins. */
  bestSteps(steps: number): number[] {
    const n = this.cells;
    const errors = Array.from({ length: n + 1 }, (_, j) => (j === 0 ? 0 : this.error(0, j)));
    const starts = Array.from({ length: steps + 1 }, () => new Array<number>(n + 2).fill(0));
    for (let m = 2; m <= steps; ++m) {
      const before = [...errors];
      starts[m]![n + 1] = n - 1;
      for (let j = n; j >= m; --j) {
        errors[j] = Infinity;
        const first = Math.max(starts[m - 1]![j]!, m - 1);
        const last = Math.max(first, Math.min(starts[m]![j + 1]!, j - 1));
        for (let i = first; i <= last; ++i) {
          const error = before[i]! + this.error(i, j);
          if (error >= errors[j]!) continue;
          errors[j] = error;
          starts[m]![j] = i;
        }
      }
    }
    let end = n;
    for (let j = steps; j < n; ++j) if (errors[j]! - this.squares[j]! < errors[end]! - this.squares[end]!) end = j;
    const best = new Array<number>(steps + 1).fill(end);
    for (let m = steps; m > 0; --m) best[m - 1] = starts[m]![best[m]!]!;
    return best;
  }
}

/** `taps`: of both sides and the centre, odd. */
export function pixelKernel(profile: readonly SkinGaussian[], taps: number, pixelsPerMm: number): PixelTaps {
  const pixelsPerCell = Math.max(1, Math.ceil(pixelsPerMm / MAX_CELLS_PER_MM));
  const edge = new EdgeResponse(profile, pixelsPerMm / pixelsPerCell);
  const pairs = Math.min(Math.max(LEAST_TAPS, Math.min(MOST_TAPS, taps)) >> 1, edge.cells);
  if (pairs === 0) return { offsets: [[0, 0]], weights: [[1, 1, 1]] };
  const places = edge.bestSteps(pairs);
  const kernel: PixelTaps = { offsets: [], weights: [] };
  let level: Triple = [0, 0, 0];
  for (let i = 0; i <= pairs; ++i) {
    const next: Triple = i < pairs ? edge.level(places[i]!, places[i + 1]!) : [1, 1, 1];
    // At the edge itself, one side of the kernel is lit, and half of the centre's weight counts.
    kernel.weights.push(next.map((each, c) => Math.max(i === 0 ? 2 * each - 1 : each - level[c]!, 0)) as Triple);
    level = next;
    const before = i === 0 ? 0 : places[i - 1]!;
    kernel.offsets.push([places[i]! * pixelsPerCell, Math.round(ASIDE * (places[i]! - before) * pixelsPerCell)]);
  }
  return kernel;
}
