// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { Color, MeshPhysicalMaterial, Texture } from 'three';
import { BoundMaterial, readMaterialBinds } from '../src/mesh/material_binds.js';

const BINDS = readMaterialBinds([
  { shape: 'blush', material: 0, baseColor: [0.5, -0.25, 0, 0.5] },
  { shape: 'glow', material: 0, emission: [0, 2, 0], uvOffset: [0.25, 0] },
  { shape: 'wide', material: 0, uvScale: [1, -0.5] },
]);

function material(): MeshPhysicalMaterial {
  const map = new Texture();
  map.repeat.set(2, 2);
  map.offset.set(-1, 0.5);
  return new MeshPhysicalMaterial({ color: new Color(0.5, 0.5, 0.5), opacity: 0.5, emissive: new Color(0.125, 0, 0), map });
}

function applied(weights: Record<string, number>): MeshPhysicalMaterial {
  const made = material();
  new BoundMaterial(made, BINDS).apply((shape) => weights[shape] ?? 0);
  return made;
}

test('entries of another form are left out', () => {
  assert.deepEqual(readMaterialBinds(undefined), []);
  assert.deepEqual(readMaterialBinds([3, null, {}, { shape: 'a' }, { shape: 1, material: 0 }, { shape: 'a', material: 0.5 }]), []);
  const [bind] = readMaterialBinds([{ shape: 'a', material: 1, emission: [1, 'x', Infinity], uvScale: 4 }]);
  assert.deepEqual(bind, { shape: 'a', material: 1, baseColor: [0, 0, 0, 0], emission: [1, 0, 0], uvScale: [0, 0], uvOffset: [0, 0] });
});

test('changes add up, and weights end at 1', () => {
  const half = applied({ blush: 0.5, glow: 0.25 });
  assert.deepEqual(half.color.toArray(), [0.75, 0.375, 0.5]);
  assert.equal(half.opacity, 0.75);
  assert.deepEqual(half.emissive.toArray(), [0.125, 0.5, 0]);
  assert.deepEqual(applied({ blush: 7 }).color.toArray(), [1, 0.25, 0.5]);
  assert.deepEqual(applied({ blush: NaN, glow: -1 }).color.toArray(), [0.5, 0.5, 0.5]);
});

test('the UVs of the textures change as seen at rest', () => {
  const { map } = applied({ glow: 1, wide: 1 });
  assert.deepEqual(map!.repeat.toArray(), [4, 1]);
  assert.deepEqual(map!.offset.toArray(), [-1.75, 0.25]);
  const rest = applied({}).map!;
  assert.deepEqual([rest.repeat.toArray(), rest.offset.toArray()], [[2, 2], [-1, 0.5]]);
});
