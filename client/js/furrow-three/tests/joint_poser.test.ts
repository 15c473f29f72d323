// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { Bone, Euler, Quaternion, Vector3 } from 'three';
import { type Joint, JointPoser, type Pose, type PoseSkeleton } from '../src/pose/joint_poser.js';

const NAMES = ['hips', 'spine', 'head'];

/** A chain of three joints, each 0.5 units above the former. `turned`: the joint axes differ from those of the model. */
function skeleton(turned: readonly Quaternion[], metresPerUnit: number): PoseSkeleton {
  const axes: Quaternion[] = [];
  const rotations: number[] = [];
  const translations: number[] = [];
  NAMES.forEach((_, i) => {
    const parent = i === 0 ? new Quaternion() : axes[i - 1]!;
    const local = parent.clone().invert().multiply(turned[i]!);
    axes.push(turned[i]!.clone());
    rotations.push(...local.toArray());
    translations.push(...new Vector3(0, 0.5 / metresPerUnit, 0).applyQuaternion(parent.clone().invert()).toArray());
  });
  return {
    hash: BigInt(Math.round(metresPerUnit * 1000)), metresPerUnit, names: NAMES, parents: [-1, 0, 1],
    restRotations: rotations, restTranslations: translations, restScales: new Array<number>(9).fill(1), blendShapeNames: [],
  };
}

function character(turned: readonly Quaternion[]): Joint[] {
  const at = skeleton(turned, 1);
  const nodes = NAMES.map((name, i) => {
    const node = new Bone();
    node.name = name;
    node.position.fromArray(Array.from(at.restTranslations), 3 * i);
    node.quaternion.fromArray(Array.from(at.restRotations), 4 * i);
    return node;
  });
  nodes[0]!.add(nodes[1]!);
  nodes[1]!.add(nodes[2]!);
  return nodes.map((node, i) => ({ name: node.name, node, parent: i - 1 }));
}

const STRAIGHT = NAMES.map(() => new Quaternion());
const TURNED = [new Euler(0.3, 1, -0.2), new Euler(-1, 0.4, 2), new Euler(0.7, -0.6, 0.1)].map((e) => new Quaternion().setFromEuler(e));
const BEND = new Quaternion().setFromEuler(new Euler(0.4, -0.3, 0.2));

/** Every joint turns by BEND in the model's axes of its parent, and the hips move by 1 m to the left. */
function bent(at: PoseSkeleton, turned: readonly Quaternion[]): Pose {
  const rotations: number[] = [];
  NAMES.forEach((_, i) => {
    const parent = i === 0 ? new Quaternion() : turned[i - 1]!;
    const rest = new Quaternion().fromArray(Array.from(at.restRotations), 4 * i);
    const local = parent.clone().invert().multiply(BEND).multiply(parent).multiply(rest);
    rotations.push(...local.toArray());
  });
  const translations = Array.from(at.restTranslations);
  translations[0]! += 1 / at.metresPerUnit;
  return { skeleton: at, rotations, translations, scales: new Array<number>(9).fill(1), blendShapes: [] };
}

function places(joints: readonly Joint[]): number[][] {
  joints[0]!.node.updateMatrixWorld(true);
  return joints.map(({ node }) => new Vector3().setFromMatrixPosition(node.matrixWorld).toArray());
}

test('equal skeletons take the pose as it is', () => {
  const joints = character(STRAIGHT);
  new JointPoser(joints).apply(bent(skeleton(STRAIGHT, 1), STRAIGHT));
  for (const { node } of joints) assert(node.quaternion.angleTo(BEND) < 1e-6);
  assert.deepEqual(joints[0]!.node.position.toArray(), [1, 0.5, 0]);
});

test('joint axes and units may differ', () => {
  const expected = character(STRAIGHT);
  new JointPoser(expected).apply(bent(skeleton(STRAIGHT, 1), STRAIGHT));
  for (const [own, stream, unit] of [[TURNED, STRAIGHT, 1], [STRAIGHT, TURNED, 0.01], [TURNED, TURNED, 0.1]] as const) {
    const joints = character(own);
    new JointPoser(joints).apply(bent(skeleton(stream, unit), stream));
    places(joints).forEach((place, i) => place.forEach((x, axis) =>
      assert(Math.abs(x - places(expected)[i]![axis]!) < 1e-5, `joint ${i}, axis ${axis}`)));
  }
});

test('a skeleton fits if its joints rest at the same places', () => {
  const poser = new JointPoser(character(TURNED));
  assert(poser.fits(skeleton(TURNED, 1)));
  assert(poser.fits(skeleton(TURNED, 0.01)));
  assert(!poser.fits(skeleton(STRAIGHT, 1)));
  const moved = skeleton(TURNED, 1);
  assert(!poser.fits({ ...moved, restTranslations: Array.from(moved.restTranslations, (x) => x + 0.002) }));
  assert(!poser.fits({ ...moved, names: ['hips', 'spine', 'neck'] }));
  assert(!poser.fits({ ...moved, parents: [-1, 0, 0] }));
  assert(!poser.fits({ ...moved, names: [...NAMES, 'more'] }));
});

test('joints that the stream lacks rest, also after a stream that had them', () => {
  const joints = character(TURNED);
  const rest = places(joints);
  const poser = new JointPoser(joints);
  poser.apply(bent(skeleton(STRAIGHT, 1), STRAIGHT));
  const strangers = { ...skeleton(STRAIGHT, 1), hash: 99n, names: ['a', 'b', 'c'] };
  poser.apply(bent(strangers, STRAIGHT));
  assert.deepEqual(places(joints), rest);
  assert.deepEqual(poser.covered(strangers), []);
  assert.deepEqual(poser.covered(skeleton(STRAIGHT, 1)), NAMES);
});
