// SPDX-License-Identifier: Apache-2.0
// Vertices of a mesh that are one point of the surface (character/mesh/weld.cpp is the same in C++).
import type { BufferAttribute, BufferGeometry, InterleavedBufferAttribute } from 'three';

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** Skin weights quantised to bytes differ by up to half a step. */
const WEIGHT_TOLERANCE = 2e-3;
const MOVE_SHARE = 1e-3;
const MOVE_LEAST = 2e-6; // metres

/** The weight of a joint on a vertex: a joint may occur in several of its four influences. */
export function weightOf(geometry: BufferGeometry, vertex: number, joint: number): number {
  const { skinIndex, skinWeight } = geometry.attributes as Record<string, Attribute>;
  let sum = 0;
  for (let k = 0; k < 4; ++k) {
    if (skinIndex!.getComponent(vertex, k) === joint) sum += skinWeight!.getComponent(vertex, k);
  }
  return sum;
}

function moveAlike(geometry: BufferGeometry, a: number, b: number): boolean {
  const skinIndex = geometry.attributes.skinIndex!;
  for (const vertex of [a, b]) {
    for (let k = 0; k < 4; ++k) {
      const joint = skinIndex.getComponent(vertex, k);
      if (Math.abs(weightOf(geometry, a, joint) - weightOf(geometry, b, joint)) > WEIGHT_TOLERANCE) return false;
    }
  }
  return (geometry.morphAttributes.position ?? []).every((target) => {
    const move = (i: number): [number, number, number] => [target.getX(i), target.getY(i), target.getZ(i)];
    const [p, q] = [move(a), move(b)];
    const longer = Math.max(Math.hypot(...p), Math.hypot(...q));
    return Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= Math.max(MOVE_SHARE * longer, MOVE_LEAST);
  });
}

/** Per vertex, the first vertex of the same point: equal positions that all joints and morph targets move alike. */
export function weldVertices(geometry: BufferGeometry): Uint32Array {
  const position = geometry.attributes.position!;
  const first = new Uint32Array(position.count);
  const at = new Map<string, number[]>();
  for (let i = 0; i < position.count; ++i) {
    const key = `${position.getX(i)} ${position.getY(i)} ${position.getZ(i)}`;
    const here = at.get(key) ?? [];
    const same = here.find((other) => moveAlike(geometry, i, other));
    first[i] = same ?? i;
    if (same !== undefined) continue;
    here.push(i);
    at.set(key, here);
  }
  return first;
}
