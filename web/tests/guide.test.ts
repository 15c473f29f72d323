// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import type { Skeleton } from 'furrow/protocol';
import { gesturesOf } from '../src/guide/gestures';
import { FACE, GOOD_MS, Guide, HOLD_MS, READ_MS, WINDOW_MS } from '../src/guide/guide';
import { differenceOf, meanOf, Sampler, wobbleOf } from '../src/guide/measure';

/** hips > head > brow, in centimetres. */
const SKELETON: Skeleton = {
  subject: 'ann', hash: 1n, metresPerUnit: 0.01, names: ['hips', 'Head', 'brow'], parents: Int16Array.from([-1, 0, 1]),
  restTranslations: Float32Array.from([0, 90, 0, 0, 60, 0, 0, 10, 5]),
  restRotations: Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]),
  restScales: new Float32Array(9).fill(1), blendShapeNames: ['jawOpen'],
};
const HALF = Math.SQRT1_2;

function pose(brow: number, hips = [0, 0, 0, 1], jaw = 0) {
  const rotations = SKELETON.restRotations.slice();
  rotations.set(hips, 0);
  rotations.set([HALF, 0, 0, HALF], 4); // the head looks down
  const translations = SKELETON.restTranslations.slice();
  translations[7]! += brow;
  return { rotations, translations, blendShapes: Float32Array.from([jaw]) };
}

test('faces are measured in the space of the anchor, in millimetres', () => {
  const sampler = new Sampler(SKELETON, 'head');
  assert.equal(sampler.isFace, true);
  const still = sampler.sample(pose(0));
  assert.equal(still.positions.length, 3); // the brow alone is below the head
  [0, 0.1, 0.05].forEach((metres, axis) => assert(Math.abs(still.positions[axis]! - metres) < 1e-6));
  // Turning the whole body changes nothing, and so does a nod.
  assert(differenceOf(still, sampler.sample(pose(0, [0, HALF, 0, HALF]))).mm < 1e-3);
  assert(differenceOf(still, sampler.rest()).mm < 1e-3);
  const raised = differenceOf(still, sampler.sample(pose(0.7, [0, 0, 0, 1], 0.4)));
  assert(Math.abs(raised.mm - 7) < 1e-3, String(raised.mm));
  assert(Math.abs(raised.shape - 0.4) < 1e-6);
});

test('without the anchor, all joints count', () => {
  const sampler = new Sampler(SKELETON, 'skull');
  assert.equal(sampler.isFace, false);
  assert.equal(sampler.rest().positions.length, 9);
  assert(Math.abs(sampler.rest().positions[7]! - 1.6) < 1e-6);
});

const sample = (mm: number, shape = 0) => ({ positions: Float32Array.from([mm / 1000, 0, 0]), shapes: Float32Array.from([shape]) });

test('the wobble is the largest distance from the mean', () => {
  const samples = [sample(0), sample(2), sample(4, 0.3)];
  assert(Math.abs(meanOf(samples).positions[0]! - 0.002) < 1e-6);
  const { mm, shape } = wobbleOf(samples);
  assert(Math.abs(mm - 2) < 1e-3);
  assert(Math.abs(shape - 0.2) < 1e-6);
});

test('both sides of a face are one gesture; poses that no driver uses are left out', () => {
  const values = (...poses: string[]) => poses.map((reference_pose) => ({ name: 'x', reference_pose }));
  const gestures = gesturesOf({
    reference_poses: ['unused', 'brow_raise_inner_l', 'brow_raise_outer_r', 'jaw_open', 'my_pose'],
    drivers: [{ name: 'a', values: values('brow_raise_inner_l', 'brow_raise_outer_r') }, { name: 'b', values: [...values('jaw_open', 'my_pose'), { name: 'y' }] }],
  });
  assert.deepEqual(gestures.map(({ words, poses }) => [words, poses.join()]), [
    ['Relax your face and look straight ahead', 'neutral'],
    ['Raise your brows', 'brow_raise_inner_l,brow_raise_outer_r'],
    ['Open your mouth wide', 'jaw_open'],
    ['Make the pose “my_pose”', 'my_pose'],
  ]);
});

test('poses of the rig makehuman have words', () => {
  const poses = ['brow_down_l', 'brow_outer_up_l', 'brow_inner_up_r', 'nose_wrinkle', 'lid_open_l', 'lid_closed_r', 'lower_lid_up_l', 'cheek_up_l', 'sneer',
    'chin_up', 'upper_lip_up', 'upper_lip_back', 'lip_wide', 'smile_l', 'corner_down_r'];
  const values = poses.map((reference_pose) => ({ name: 'x', reference_pose }));
  const said = gesturesOf({ reference_poses: poses, drivers: [{ name: 'a', values }] }).map(({ words }) => words);
  assert.equal(said.length, 15); // both parts of the brows are one
  assert.deepEqual(said.filter((words) => words.startsWith('Make the pose')), []);
});

const GESTURES = ['neutral', 'one', 'two'].map((id) => ({ id, words: id, poses: [id] }));

/** Shows a pose for a while; returns the time after it. */
function show(guide: Guide, from: number, lastsMs: number, mm: (at: number) => number): number {
  for (let at = from; at < from + lastsMs; at += 50) {
    guide.add(sample(mm(at)), at);
    guide.progress(at);
  }
  return from + lastsMs;
}

test('a gesture is captured when it is far, steady and held', () => {
  const guide = new Guide(GESTURES, sample(100), FACE, 0);
  let now = show(guide, 0, READ_MS - 100, () => 1);
  assert.equal(guide.progress(now).phase, 'read');
  now = show(guide, now, 200, () => 1);
  assert.equal(guide.progress(now).phase, 'take'); // the neutral pose needs no distance
  guide.accept(now);
  assert.equal(guide.progress(now).phase, 'good');
  assert.equal(guide.advance(now), false);
  assert.equal(guide.advance(now + GOOD_MS), true);
  assert.equal(guide.gesture?.id, 'one');
  now = show(guide, now + GOOD_MS, READ_MS + WINDOW_MS, () => 3);
  assert.equal(guide.progress(now).phase, 'move'); // 2 mm from the neutral that was captured
  assert(Math.abs(guide.progress(now).far - 2 / 3) < 1e-3);
  now = show(guide, now, 2 * WINDOW_MS, (at) => (at % 100 === 0 ? 10 : 17));
  assert.equal(guide.progress(now).phase, 'hold'); // far, but it trembles
  assert(guide.progress(now).steady < 1);
  now = show(guide, now, WINDOW_MS + HOLD_MS + 100, () => 12);
  const { phase, distance, wobble } = guide.progress(now);
  assert.equal(phase, 'take');
  assert(Math.abs(distance.mm - 11) < 1e-3 && wobble!.mm < 1e-3);
  guide.accept(now);
  assert(Math.abs(guide.taken[1]!.distance!.mm - 11) < 1e-3);
  assert.equal(guide.advance(now + GOOD_MS), true);
  now = show(guide, now + GOOD_MS, READ_MS + WINDOW_MS + HOLD_MS, () => 20);
  assert.equal(guide.progress(now).phase, 'take');
  assert.equal(guide.advance(now + 2 * GOOD_MS), false); // the daemon has not captured it yet
  guide.refuse(now); // and does not
  assert.equal(guide.gesture?.id, 'two');
  assert.equal(guide.progress(now).phase, 'read');
  assert.equal(guide.taken[2], null);
  assert.notEqual(guide.taken[1], null);
});

test('gestures can be skipped, shown again and ended', () => {
  const guide = new Guide(GESTURES, sample(0), FACE, 0);
  guide.skip(0);
  guide.skip(0);
  guide.back(0);
  assert.equal(guide.at, 1);
  let now = show(guide, 0, 3000, () => 9);
  guide.accept(now);
  assert.equal(guide.advance(now + GOOD_MS), true);
  assert.equal(guide.at, 2);
  guide.skip(now);
  assert.equal(guide.isOver, true);
  guide.goTo(0, now);
  now = show(guide, now, 3000, () => 0);
  guide.accept(now);
  guide.advance(now + GOOD_MS);
  assert.equal(guide.at, 2); // the one between was captured
});

test('silence and gaps say nothing about steadiness', () => {
  const guide = new Guide(GESTURES, sample(0), FACE, 0);
  assert.equal(guide.isSilent(500), false);
  assert.equal(guide.isSilent(1500), true);
  const now = show(guide, 2000, 1000, () => 1);
  assert.notEqual(guide.progress(now).wobble, null);
  assert.equal(guide.progress(now + 2000).wobble, null);
  assert.equal(guide.isSilent(now + 2000), true);
  guide.add(sample(1), now + 350);
  assert.notEqual(guide.progress(now + 350).wobble, null); // a busy browser
  const later = show(guide, now + 400, 300, () => 1) + 550;
  guide.add(sample(1), later);
  assert.equal(guide.progress(later).wobble, null); // nothing for half a second
  show(guide, later, 1000, () => 1);
  guide.add(sample(100), later + 955); // comes too soon after another one to count
  assert.equal(guide.progress(later + 960).wobble!.mm < 1, true);
});
