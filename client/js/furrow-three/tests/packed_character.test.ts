// SPDX-License-Identifier: Apache-2.0
// The default character for browsers, as tools/pack_character.mjs makes it.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { readRig } from '../src/rig/rig_file.js';

const SHARE = process.env.FURROW_SHARE!;
const PACKED = join(SHARE, 'default.web.glb');
const SIZES: Record<number, number> = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const COMPONENTS: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

interface Accessor { bufferView: number; componentType: number; count: number; type: string; normalized?: boolean }
interface Gltf {
  accessors: Accessor[];
  bufferViews: { byteOffset: number; byteLength: number; byteStride?: number }[];
  buffers: { byteLength: number }[];
  images: { name: string; mimeType: string; bufferView: number }[];
  meshes: { name: string; primitives: { attributes: Record<string, number>; indices: number }[] }[];
  scenes: { extras: { furrow_rig: unknown } }[];
}

function read(path: string): { json: Gltf; binary: Buffer; size: number } {
  const file = readFileSync(path);
  const jsonBytes = file.readUInt32LE(12);
  return { json: JSON.parse(file.toString('utf8', 20, 20 + jsonBytes)) as Gltf, binary: file.subarray(28 + jsonBytes), size: file.length };
}

const skip = existsSync(PACKED) ? false : 'the package is not built (openimageio-tools is missing)';

test('the package is small and its parts lie inside', { skip }, () => {
  const { json, binary, size } = read(PACKED);
  assert(size <= 4_000_000, `${size} bytes`);
  assert(!binary.includes('oiiotool'), 'the pictures hold the command that made them');
  assert.equal(json.buffers[0]!.byteLength <= binary.length, true);
  for (const { byteOffset, byteLength } of json.bufferViews) assert(byteOffset + byteLength <= json.buffers[0]!.byteLength);
  for (const { bufferView, componentType, count, type } of json.accessors) {
    const { byteLength, byteStride } = json.bufferViews[bufferView]!;
    const element = SIZES[componentType]! * COMPONENTS[type]!;
    assert((count - 1) * (byteStride ?? element) + element <= byteLength);
  }
});

test('the package has the meshes of the character, and skin weights that sum to 1', { skip }, () => {
  const packed = read(PACKED);
  const source = read(join(SHARE, 'default.glb'));
  assert.deepEqual(packed.json.meshes.map(({ name }) => name), source.json.meshes.map(({ name }) => name));
  packed.json.meshes.forEach(({ primitives }, m) => {
    const { attributes, indices } = primitives[0]!;
    const former = source.json.meshes[m]!.primitives[0]!;
    assert.equal(packed.json.accessors[indices]!.count, source.json.accessors[former.indices]!.count);
    const weights = packed.json.accessors[attributes.WEIGHTS_0!]!;
    assert.deepEqual([weights.componentType, weights.normalized], [5121, true]);
    const start = packed.json.bufferViews[weights.bufferView]!.byteOffset;
    for (let v = 0; v < weights.count; ++v) {
      const four = packed.binary.subarray(start + 4 * v, start + 4 * v + 4);
      assert.equal(four[0]! + four[1]! + four[2]! + four[3]!, 255);
    }
  });
});

test('the package holds the rig and its pictures', { skip }, () => {
  const { json } = read(PACKED);
  const rig = readRig(JSON.stringify(json.scenes[0]!.extras.furrow_rig));
  assert.deepEqual(rig, readRig(readFileSync(join(SHARE, 'default.rig.json'), 'utf8')));
  const names = new Set(json.images.map(({ name }) => name));
  for (const { mask } of rig.places) assert(names.has(mask), mask);
  for (const { normal, colour, cavity } of rig.maps) for (const name of [normal, colour, cavity]) assert(name === '' || names.has(name), name);
  for (const { name, mimeType } of json.images) if (name.startsWith('face_masks')) assert.equal(mimeType, 'image/png'); // its alpha is a mask
});
