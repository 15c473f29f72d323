// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { DrawnMoment } from '../src/view/drawn_moment';

/** A pose of one joint and one blend shape. */
function pose(changes: Partial<Record<'rotations' | 'translations' | 'scales' | 'blendShapes', number[]>> = {}, hash = 1n) {
  const parts = { rotations: [0, 0, 0, 1], translations: [0, 1, 0], scales: [1, 1, 1], blendShapes: [0.5], ...changes };
  const [rotations, translations, scales, blendShapes] = [parts.rotations, parts.translations, parts.scales, parts.blendShapes]
    .map((values) => new Float32Array(values)) as [Float32Array, Float32Array, Float32Array, Float32Array];
  return { skeleton: { hash }, rotations, translations, scales, blendShapes };
}
const weights = (value: number, layout = 1n) => ({ layout, values: new Float32Array([0, value]) });

test('nothing is drawn yet, and nothing after it was forgotten', () => {
  const moment = new DrawnMoment();
  assert(!moment.isSame(pose(), weights(0.5), ''));
  moment.set(pose(), weights(0.5), '');
  assert(moment.isSame(pose(), weights(0.5), ''));
  moment.forget();
  assert(!moment.isSame(pose(), weights(0.5), ''));
});

test('every part of a pose changes the picture', () => {
  const moment = new DrawnMoment();
  moment.set(pose(), weights(0.5), '');
  for (const change of [{ rotations: [0, 0, 1e-4, 1] }, { translations: [0, 1.00001, 0] }, { scales: [1, 1, 1.0001] }, { blendShapes: [0.5001] },
    { blendShapes: [] }]) {
    assert(!moment.isSame(pose(change), weights(0.5), ''), JSON.stringify(change));
  }
  assert(!moment.isSame(pose({}, 2n), weights(0.5), ''), 'another skeleton');
});

test('weights, their layout and the view change the picture', () => {
  const moment = new DrawnMoment();
  moment.set(pose(), weights(0.5), 'front');
  assert(!moment.isSame(pose(), weights(0.51), 'front'));
  assert(!moment.isSame(pose(), weights(0.5, 2n), 'front'));
  assert(!moment.isSame(pose(), weights(0.5), 'side'));
});

test('weights that drift by little are drawn once they have moved visibly', () => {
  const moment = new DrawnMoment();
  moment.set(pose(), weights(0.5), '');
  let drawn = 0;
  for (let i = 1; i <= 100; ++i) {
    const now = weights(0.5 + i * 1e-4);
    if (moment.isSame(pose(), now, '')) continue;
    moment.set(pose(), now, '');
    ++drawn;
  }
  assert(drawn >= 15 && drawn <= 21, `${drawn}`);
});
