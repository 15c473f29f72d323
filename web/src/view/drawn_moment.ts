// SPDX-License-Identifier: Apache-2.0
// What the last picture shows, so that a pose at rest is drawn once although it keeps arriving.
import type { PoseFrame, WeightFrame } from 'furrow/protocol';

/** Weights that differ by less look the same: a channel of a picture has 256 steps. Filtered weights approach a pose slowly. */
const UNSEEN = 1 / 2048;

const PARTS = ['rotations', 'translations', 'scales', 'blendShapes'] as const;
type Pose = Pick<PoseFrame, typeof PARTS[number]> & { skeleton: { hash: bigint } };
type Weights = Pick<WeightFrame, 'layout' | 'values'>;

function areClose(a: Float32Array, b: Float32Array, tolerance: number): boolean {
  return a.length === b.length && a.every((value, i) => Math.abs(value - b[i]!) <= tolerance);
}

export class DrawnMoment {
  private last: { pose: Pose; weights: Weights; view: string } | null = null;

  /** True if these would give the last picture again. `view`: everything else that changes the picture, as text. */
  isSame(pose: Pose, weights: Weights, view: string): boolean {
    const { last } = this;
    return last !== null && view === last.view && pose.skeleton.hash === last.pose.skeleton.hash && weights.layout === last.weights.layout &&
      PARTS.every((part) => areClose(pose[part], last.pose[part], 0)) && areClose(weights.values, last.weights.values, UNSEEN);
  }

  /** The arrays of poses and weights never change, so they are kept as they are. */
  set(pose: Pose, weights: Weights, view: string): void {
    this.last = { pose, weights, view };
  }

  forget(): void {
    this.last = null;
  }
}
