// SPDX-License-Identifier: Apache-2.0
// How far a pose is from another one, and how steady it is held. Pure. docs/PREVIEW.md states the measure.
import type { PoseFrame, Skeleton } from 'furrow/protocol';

/** What a pose looks like: positions of joints in metres, 3 numbers each, in the space of the anchor; and coefficients. */
export interface Sample {
  positions: Float32Array;
  shapes: Float32Array;
}

/** The largest difference of a joint's position, and of a coefficient. */
export interface Difference {
  mm: number;
  shape: number;
}

type Joints = Pick<PoseFrame, 'rotations' | 'translations' | 'blendShapes'>;
type Numbers = ArrayLike<number>;

/** A vector turned by the quaternion at `q` of `rotations`; `sign` -1: by its inverse. */
function turn(rotations: Numbers, q: number, [x, y, z]: readonly [number, number, number], sign = 1): [number, number, number] {
  const [a, b, c, w] = [sign * rotations[q]!, sign * rotations[q + 1]!, sign * rotations[q + 2]!, rotations[q + 3]!];
  const [u, v, n] = [2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)];
  return [x + w * u + b * n - c * v, y + w * v + c * u - a * n, z + w * n + a * v - b * u];
}

function multiply(into: Float32Array, at: number, p: Numbers, pi: number, q: Numbers, qi: number): void {
  const [a, b, c, d] = [p[pi]!, p[pi + 1]!, p[pi + 2]!, p[pi + 3]!];
  const [x, y, z, w] = [q[qi]!, q[qi + 1]!, q[qi + 2]!, q[qi + 3]!];
  into.set([d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x, d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z], at);
}

/** Turns poses of one skeleton into samples. */
export class Sampler {
  /** The joints whose positions count: those below the anchor, else all. */
  private readonly counted: number[];
  private readonly anchor: number;

  /** `anchor`: the joint in whose space the rig measures faces. A skeleton may not have it. */
  constructor(private readonly skeleton: Skeleton, anchor: string) {
    const { names, parents } = skeleton;
    this.anchor = names.findIndex((name) => name.toLowerCase() === anchor.toLowerCase());
    const isBelow = (joint: number): boolean => {
      const parent = parents[joint]!;
      return parent >= 0 && (parent === this.anchor || isBelow(parent));
    };
    const below = this.anchor < 0 ? [] : [...names.keys()].filter(isBelow);
    if (below.length === 0) this.anchor = -1;
    this.counted = below.length > 0 ? below : [...names.keys()];
  }

  /** True if the positions are those of a face. */
  get isFace(): boolean {
    return this.anchor >= 0;
  }

  get hasJoints(): boolean {
    return this.skeleton.names.length > 0;
  }

  get hasShapes(): boolean {
    return this.skeleton.blendShapeNames.length > 0;
  }

  rest(): Sample {
    const { restRotations: rotations, restTranslations: translations, blendShapeNames } = this.skeleton;
    return this.sample({ rotations, translations, blendShapes: new Float32Array(blendShapeNames.length) });
  }

  sample({ rotations, translations, blendShapes }: Joints): Sample {
    const { parents, metresPerUnit } = this.skeleton;
    const turns = new Float32Array(rotations.length);
    const places = new Float32Array(translations.length);
    for (let joint = 0; joint < parents.length; ++joint) {
      const parent = parents[joint]!;
      const at: [number, number, number] = [translations[3 * joint]!, translations[3 * joint + 1]!, translations[3 * joint + 2]!];
      if (parent < 0) {
        turns.set(rotations.subarray(4 * joint, 4 * joint + 4), 4 * joint);
        places.set(at, 3 * joint);
        continue;
      }
      multiply(turns, 4 * joint, turns, 4 * parent, rotations, 4 * joint);
      const turned = turn(turns, 4 * parent, at);
      for (let axis = 0; axis < 3; ++axis) places[3 * joint + axis] = places[3 * parent + axis]! + turned[axis]!;
    }
    const positions = new Float32Array(3 * this.counted.length);
    const from = this.anchor < 0 ? [0, 0, 0] : [...places.subarray(3 * this.anchor, 3 * this.anchor + 3)];
    this.counted.forEach((joint, i) => {
      const offset = [0, 1, 2].map((axis) => (places[3 * joint + axis]! - from[axis]!) * metresPerUnit) as [number, number, number];
      positions.set(this.anchor < 0 ? offset : turn(turns, 4 * this.anchor, offset, -1), 3 * i);
    });
    return { positions, shapes: blendShapes.slice() };
  }
}

export function differenceOf(a: Sample, b: Sample): Difference {
  let squared = 0;
  for (let i = 0; i < Math.min(a.positions.length, b.positions.length); i += 3) {
    let sum = 0;
    for (let axis = i; axis < i + 3; ++axis) sum += (a.positions[axis]! - b.positions[axis]!) ** 2;
    squared = Math.max(squared, sum);
  }
  let shape = 0;
  for (let i = 0; i < Math.min(a.shapes.length, b.shapes.length); ++i) shape = Math.max(shape, Math.abs(a.shapes[i]! - b.shapes[i]!));
  return { mm: 1000 * Math.sqrt(squared), shape };
}

function mean(vectors: readonly Float32Array[]): Float32Array {
  const sum = new Float32Array(vectors[0]!.length);
  for (const vector of vectors) vector.forEach((value, i) => (sum[i]! += value / vectors.length));
  return sum;
}

/** The mean of samples of one skeleton; there is at least one. */
export function meanOf(samples: readonly Sample[]): Sample {
  return { positions: mean(samples.map(({ positions }) => positions)), shapes: mean(samples.map(({ shapes }) => shapes)) };
}

/** The largest difference of a sample from the mean of all. */
export function wobbleOf(samples: readonly Sample[]): Difference {
  const middle = meanOf(samples);
  const all = samples.map((sample) => differenceOf(sample, middle));
  return { mm: Math.max(...all.map(({ mm }) => mm)), shape: Math.max(...all.map(({ shape }) => shape)) };
}
