// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { withoutComments } from '../src/rig/json_comments.js';
import { readRig } from '../src/rig/rig_file.js';
import { WrinkleSet } from '../src/wrinkles/wrinkle_set.js';

const RIG = `{
  "name": "toy", // "quoted" in a comment
  "wrinkle_maps": [
    {"name": "squash", "normal": "n//ot a comment", "surface": "skin", "amplitude": 0.5},
    {"name": "any", "derivative": "d", "derivative_scale": 2},
    {"name": "folds", "normal": "f", "surface": "cloth"}],
  "regions": [
    {"name": "brow", "mask": {"texture": "a", "channel": "g"}, "feeds": [{"map": "squash"}, {"map": "any"}]},
    {"name": "chin", "mask": {"texture": "b", "channel": "a"}, "feeds": [{"map": "squash"}]},
    {"name": "nape", "mask": {"texture": "b", "channel": "a"}, "feeds": [{"map": "squash"}]},
    {"name": "knee", "mask": {"texture": "c"}, "feeds": [{"map": "folds"}]},
    {"name": "hip", "mask": {"kind": "sliding", "driver": "hip"}, "feeds": [{"map": "folds"}]}]
}`;

test('comments are removed outside of texts only', () => {
  assert.equal(withoutComments('{"a//b": 1, /* c */ "d\\"//": 2} // e'), '{"a//b": 1,  "d\\"//": 2} ');
});

test('a rig says where each weight is drawn', () => {
  const rig = readRig(RIG);
  assert.equal(rig.maps[0]!.normal, 'n//ot a comment');
  assert.deepEqual(rig.places.map(({ weight }) => weight), ['brow.squash', 'brow.any', 'chin.squash', 'nape.squash', 'knee.folds']);
  assert.deepEqual(rig.places[1], { weight: 'brow.any', map: 1, mask: 'a', channel: 1 });
  assert.deepEqual(rig.notDrawn, ['hip']);
});

test('weights become rows of mask channels', () => {
  const set = new WrinkleSet(readRig(RIG), 'skin');
  assert.deepEqual(set.maps.map(({ name }) => name), ['squash', 'any']);
  assert.deepEqual(set.masks, ['a', 'b']);
  set.setWeights(['knee.folds', 'brow.squash', 'chin.squash', 'nape.squash', 'brow.any'], [1, 0.25, 0.5, 0.125, 0.75]);
  // chin and nape share a channel: their weights add up, as where masks overlap.
  assert.deepEqual(set.weights.map((row) => row.toArray()), [[0, 0.25, 0, 0], [0, 0, 0, 0.625], [0, 0.75, 0, 0], [0, 0, 0, 0]]);
  set.setWeights([], []);
  assert(set.weights.every((row) => row.lengthSq() === 0));
  assert.deepEqual(new WrinkleSet(readRig(RIG), 'cloth').masks, ['a', 'c']); // maps without a surface belong to both
});

test('the rig of the default character is drawn completely', () => {
  const rig = readRig(readFileSync(join(process.env.FURROW_SHARE!, 'default.rig.json'), 'utf8'));
  assert.deepEqual(rig.notDrawn, []);
  assert(rig.places.length > 40);
  assert.deepEqual(new WrinkleSet(rig, 'skin').masks, ['face_masks_a', 'face_masks_b']);
});

test('errors name the field', () => {
  for (const [json, where] of [
    ['{"wrinkle_maps": {}}', 'wrinkle_maps'], ['{"wrinkle_maps": [{}]}', 'wrinkle_maps\\[0\\].name'],
    ['{"wrinkle_maps": [{"name": "a", "surface": "wood"}]}', 'surface'], ['{"regions": [{"name": "a", "mask": {"texture": "m", "channel": "x"}}]}', 'channel'],
    ['{"regions": [{"name": "a", "mask": {"texture": "m"}, "feeds": [{"map": "b"}]}]}', 'feeds'],
    ['{"wrinkle_maps": [{"name": "a", "amplitude": "1"}]}', 'amplitude'],
  ] as const) {
    assert.throws(() => readRig(json), new RegExp(where), json);
  }
  assert.throws(() => readRig('{'), SyntaxError);
});
