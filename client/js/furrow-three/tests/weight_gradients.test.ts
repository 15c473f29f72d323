// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { BufferAttribute, BufferGeometry } from 'three';
import { addWeightGradients } from '../src/mesh/weight_gradients.js';
import { weldVertices } from '../src/mesh/weld.js';

const SIDE = 5;
const STEP = 0.1;

/** A flat grid; joint 1 takes over from joint 0 along x, at `slope` per metre. Each quad has vertices of its own. */
function grid(slope: number): BufferGeometry {
  const [position, normal, tangent, joints, weights]: number[][] = [[], [], [], [], []];
  for (let quad = 0; quad < SIDE * SIDE; ++quad) {
    for (const [dx, dy] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]] as const) {
      const x = ((quad % SIDE) + dx) * STEP;
      position!.push(x, (Math.floor(quad / SIDE) + dy) * STEP, 0);
      normal!.push(0, 0, 1);
      tangent!.push(1, 0, 0, 1);
      joints!.push(0, 1, 0, 0);
      weights!.push(1 - slope * x, slope * x, 0, 0);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(position!), 3));
  geometry.setAttribute('normal', new BufferAttribute(Float32Array.from(normal!), 3));
  geometry.setAttribute('tangent', new BufferAttribute(Float32Array.from(tangent!), 4));
  geometry.setAttribute('skinIndex', new BufferAttribute(Uint8Array.from(joints!), 4));
  geometry.setAttribute('skinWeight', new BufferAttribute(Float32Array.from(weights!), 4));
  return geometry;
}

test('vertices of one point are welded, unless joints or morph targets part them', () => {
  const geometry = grid(0);
  assert.equal(new Set(weldVertices(geometry)).size, (SIDE + 1) ** 2);
  geometry.attributes.skinWeight!.setXYZW(1, 0.5, 0.5, 0, 0); // the corner of one triangle
  assert.equal(new Set(weldVertices(geometry)).size, (SIDE + 1) ** 2 + 1);
  const move = new Float32Array(3 * geometry.attributes.position!.count);
  move[0] = 0.01;
  geometry.morphAttributes.position = [new BufferAttribute(move, 3)];
  assert.equal(new Set(weldVertices(geometry)).size, (SIDE + 1) ** 2 + 2);
});

test('gradients are the slopes of the skin weights', () => {
  const geometry = grid(1.5);
  addWeightGradients(geometry);
  const { furrowAlong, furrowAcross, position } = geometry.attributes;
  for (let i = 0; i < position!.count; ++i) {
    const at = `${position!.getX(i)}, ${position!.getY(i)}`;
    // Weight 0 counts as no influence, so joint 1 has no gradient at x = 0.
    const second = position!.getX(i) === 0 ? 0 : 1.5;
    assert(Math.abs(furrowAlong!.getX(i) + 1.5) < 1e-4 && Math.abs(furrowAlong!.getY(i) - second) < 1e-4, at);
    assert(Math.abs(furrowAcross!.getX(i)) < 1e-4 && furrowAlong!.getZ(i) === 0, at);
  }
});
