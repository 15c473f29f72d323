// SPDX-License-Identifier: Apache-2.0
// Carries poses of a stream's skeleton to a character's joints of the same names. Joint axes may differ: what travels is
// the departure from the rest pose in the axes of the model. Other bodies need the daemon's retargeting.
import { type Object3D, Quaternion, Vector3 } from 'three';

/** What setPose() needs of a skeleton; `Skeleton` of the package `furrow` has it. */
export interface PoseSkeleton {
  hash: bigint;
  metresPerUnit: number;
  names: readonly string[];
  parents: ArrayLike<number>;
  restTranslations: ArrayLike<number>;
  restRotations: ArrayLike<number>;
  restScales: ArrayLike<number>;
  blendShapeNames: readonly string[];
}

/** `PoseFrame` of the package `furrow`. */
export interface Pose {
  skeleton: PoseSkeleton;
  rotations: ArrayLike<number>;
  translations: ArrayLike<number>;
  scales: ArrayLike<number>;
  blendShapes: ArrayLike<number>;
}

/** A joint of the character at rest. */
export interface Joint {
  name: string;
  node: Object3D;
  /** Index of the parent joint; -1: none. */
  parent: number;
}

interface Rest {
  translation: Vector3;
  rotation: Quaternion;
  scale: Vector3;
  /** Rotation of the parent's axes at rest, in the model. */
  parentAxes: Quaternion;
  inverseParentAxes: Quaternion;
}

interface Link {
  source: number;
  joint: Joint;
  from: Rest;
  to: Rest;
}

const quaternionAt = (values: ArrayLike<number>, i: number): Quaternion =>
  new Quaternion(values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]);
const vectorAt = (values: ArrayLike<number>, i: number): Vector3 => new Vector3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);

/** Adds to each joint at rest the axes of its parent. Parents come first. */
function withAxes(joints: { parent: number; translation: Vector3; rotation: Quaternion; scale: Vector3 }[]): Rest[] {
  const axes: Quaternion[] = [];
  return joints.map(({ parent, translation, rotation, scale }, i) => {
    const parentAxes = parent < 0 ? new Quaternion() : axes[parent]!;
    axes[i] = parentAxes.clone().multiply(rotation);
    return { translation, rotation, scale, parentAxes, inverseParentAxes: parentAxes.clone().invert() };
  });
}

export class JointPoser {
  private readonly rest: Rest[];
  private links: Link[] = [];
  private hash: bigint | null = null;
  private readonly turn = new Quaternion();
  private readonly offset = new Vector3();

  /** `joints`: parents first, at rest. */
  constructor(private readonly joints: readonly Joint[]) {
    this.rest = withAxes(joints.map(({ node, parent }) => ({
      parent, translation: node.position.clone(), rotation: node.quaternion.clone(), scale: node.scale.clone(),
    })));
  }

  /** Names of the character's joints that a skeleton moves. */
  covered(skeleton: PoseSkeleton): string[] {
    return this.joints.filter(({ name }) => skeleton.names.includes(name)).map(({ name }) => name);
  }

  /** True if a skeleton has the same joints, which rest at the same places (1 mm) with the same axes. */
  fits(skeleton: PoseSkeleton): boolean {
    return skeleton.names.length === this.joints.length && this.joints.every(({ name, parent }, i) => {
      const source = skeleton.names.indexOf(name);
      if (source < 0) return false;
      const { translation, rotation } = this.rest[i]!;
      const above = skeleton.parents[source]!;
      return (above < 0 ? '' : skeleton.names[above]) === (parent < 0 ? '' : this.joints[parent]!.name) &&
        vectorAt(skeleton.restTranslations, source).multiplyScalar(skeleton.metresPerUnit).distanceTo(translation) < 1e-3 &&
        quaternionAt(skeleton.restRotations, source).angleTo(rotation) < 1e-3;
    });
  }

  private bind(skeleton: PoseSkeleton): void {
    if (skeleton.hash === this.hash) return;
    this.hash = skeleton.hash;
    this.toRest();
    const from = withAxes(skeleton.names.map((_, i) => ({
      parent: skeleton.parents[i]!,
      translation: vectorAt(skeleton.restTranslations, i),
      rotation: quaternionAt(skeleton.restRotations, i),
      scale: vectorAt(skeleton.restScales, i),
    })));
    this.links = this.joints.flatMap((joint, i) => {
      const source = skeleton.names.indexOf(joint.name);
      return source < 0 ? [] : [{ source, joint, from: from[source]!, to: this.rest[i]! }];
    });
  }

  /** Puts all joints into the rest pose. */
  toRest(): void {
    this.joints.forEach(({ node }, i) => {
      const { translation, rotation, scale } = this.rest[i]!;
      node.position.copy(translation);
      node.quaternion.copy(rotation);
      node.scale.copy(scale);
    });
  }

  apply(pose: Pose): void {
    this.bind(pose.skeleton);
    const { turn, offset } = this;
    for (const { source: i, joint: { node }, from, to } of this.links) {
      const { rotations: r, translations: t, scales: s } = pose;
      // Into the model's axes, as a departure from rest, and out into those of the character.
      turn.set(r[4 * i]!, r[4 * i + 1]!, r[4 * i + 2]!, r[4 * i + 3]!).multiply(node.quaternion.copy(from.rotation).invert());
      turn.premultiply(from.parentAxes).multiply(from.inverseParentAxes);
      turn.premultiply(to.inverseParentAxes).multiply(to.parentAxes);
      node.quaternion.copy(turn).multiply(to.rotation).normalize();
      offset.set(t[3 * i]!, t[3 * i + 1]!, t[3 * i + 2]!).sub(from.translation).multiplyScalar(pose.skeleton.metresPerUnit);
      offset.applyQuaternion(from.parentAxes).applyQuaternion(to.inverseParentAxes);
      node.position.copy(to.translation).add(offset);
      node.scale.set(s[3 * i]! / from.scale.x, s[3 * i + 1]! / from.scale.y, s[3 * i + 2]! / from.scale.z).multiply(to.scale);
    }
  }
}
