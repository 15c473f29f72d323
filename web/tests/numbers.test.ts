// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { WeightHistory } from '../src/state/weight_history';
import { limitOf } from '../src/view/limit';
import { PictureStats } from '../src/view/picture_stats';
import { AdaptiveScale, pictureSize } from '../src/view/resolution';

function history(): WeightHistory {
  const weights = new WeightHistory(10);
  weights.setNames(['a', 'b', 'c']);
  return weights;
}

test('old weights are dropped', () => {
  const weights = history();
  for (let i = 0; i <= 30; ++i) weights.add({ sequence: i, atS: i, values: new Float32Array([i / 100, 0, 0]) });
  assert.equal(weights.frames.length, 11);
  assert.equal(weights.frames[0]!.sequence, 20);
  assert(Math.abs(weights.value('a') - 0.3) < 1e-6);
  assert.equal(weights.value('nobody'), 0);
});

test('the most active weights are those that moved, in the daemon’s order', () => {
  const weights = history();
  weights.add({ sequence: 0, atS: 0, values: new Float32Array([0.9, 0, 0.2]) });
  weights.add({ sequence: 1, atS: 1, values: new Float32Array([0.9, 0.4, 0.9]) });
  assert.deepEqual(weights.mostActive(2), ['b', 'c']);
});

test('new names reset the history; frames of another length are ignored', () => {
  const weights = history();
  weights.add({ sequence: 0, atS: 0, values: new Float32Array([1, 1]) });
  assert.equal(weights.frames.length, 0);
  weights.add({ sequence: 0, atS: 0, values: new Float32Array([1, 1, 1]) });
  weights.setNames(['a', 'b', 'c']);
  assert.equal(weights.frames.length, 1);
  weights.setNames(['a', 'b', 'd']);
  assert.equal(weights.frames.length, 0);
});

test('the CSV equals the output of furrow watch', () => {
  const weights = history();
  weights.add({ sequence: 41, atS: 5, values: new Float32Array([0, 0.5, 1]) });
  weights.add({ sequence: 42, atS: 5.25, values: new Float32Array([0, 0.25, 1]) });
  assert.equal(weights.toCsv(weights.frames), 'frame,time,a,b,c\n41,0.000000,0.000000,0.500000,1.000000\n42,0.250000,0.000000,0.250000,1.000000\n');
});

test('timecodes are the last column of the CSV, if the source sends any', () => {
  const weights = history();
  const timecode = { text: '10:00:00;00', frame: 1_078_920, rateNumerator: 30_000, rateDenominator: 1001, subframe: 0, dropFrame: true };
  weights.add({ sequence: 1, atS: 0, values: new Float32Array([0, 0, 0]), timecode: null });
  weights.add({ sequence: 2, atS: 0.5, values: new Float32Array([0, 0, 1]), timecode });
  assert.equal(weights.toCsv(weights.frames),
    'frame,time,a,b,c,timecode\n1,0.000000,0.000000,0.000000,0.000000,\n2,0.500000,0.000000,0.000000,1.000000,10:00:00;00\n');
});

const FACTS = { sequence: 1, ageUs: 0, still: false, tier: 0, dropped: 0, receivedUs: 990_000, width: 640, height: 480, decodeMs: 4,
  codec: '', numBytes: 1000, drawnPercent: 100 };

test('latency is the median of fresh pictures on the daemon’s clock', () => {
  const stats = new PictureStats();
  assert.equal(stats.latencyMs(), null);
  stats.add(FACTS, 500_000, 500_000); // 10 ms
  stats.add({ ...FACTS, sequence: 2 }, 530_000, 500_000); // 40 ms
  stats.add({ ...FACTS, sequence: 3 }, 510_000, 500_000); // 20 ms
  assert.equal(stats.latencyMs(), 20);
  stats.add({ ...FACTS, sequence: 3 }, 900_000, 500_000); // the camera moved, so the same pose is drawn again
  stats.add({ ...FACTS, sequence: 4, still: true }, 900_000, 500_000);
  stats.add({ ...FACTS, sequence: 5, ageUs: 400_000 }, 900_000, 500_000);
  assert.equal(stats.latencyMs(), 20);
});

test('rate and drops', () => {
  const stats = new PictureStats();
  for (let i = 0; i < 40; ++i) stats.add({ ...FACTS, sequence: i, dropped: i >> 2 }, i * 50_000, null);
  assert.equal(stats.rateHz(1.95), 20);
  assert.equal(stats.dropped, 9);
  stats.add({ ...FACTS, sequence: 40, dropped: 2 }, 2e6, null); // a new subscription counts from 0
  assert.equal(stats.dropped, 11);
  assert.equal(stats.rateHz(100), 0);
  assert.equal(stats.shown, 41);
});

test('the age of the picture counts from the arrival of its pose, and a new connection begins again', () => {
  const stats = new PictureStats();
  assert.equal(stats.ageMs(500_000, 500_000), null);
  stats.add({ ...FACTS, sequence: 7 }, 500_000, 500_000);
  assert.equal(stats.sequence, 7);
  assert.equal(stats.ageMs(740_000, 500_000), 250);
  assert.equal(stats.ageMs(740_000, null), null);
  stats.reset();
  assert.deepEqual([stats.shown, stats.sequence, stats.ageMs(740_000, 500_000), stats.rateHz(0.74)], [0, null, null, 0]);
});

test('poses that waited for this page, and the time to decode', () => {
  const stats = new PictureStats();
  for (let i = 0; i < 10; ++i) stats.add({ ...FACTS, sequence: i, dropped: 3 * i, decodeMs: i % 2 === 0 ? 2 : 4 }, i * 100_000, null);
  assert.equal(stats.waitedHz(0.9), 13.5);
  assert.equal(stats.decodeMs(), 3);
});

test('format and data rate of the pictures', () => {
  const stats = new PictureStats();
  for (let i = 0; i < 10; ++i) stats.add({ ...FACTS, sequence: i, codec: 'avc1.42c01e', numBytes: 25_000 }, i * 100_000, null);
  assert.equal(stats.mbitPerS(0.9), 1);
  stats.addLoad(125_000, 900_000); // the left picture of a wipe
  assert.equal(stats.mbitPerS(0.9), 1.5);
  assert.equal(stats.rateHz(0.9), 5);
  assert.equal(stats.mbitPerS(10), 0);
  assert.equal(stats.codec, 'avc1.42c01e');
  stats.add({ ...FACTS, sequence: 10, still: true }, 1e6, null);
  assert.equal(stats.codec, 'avc1.42c01e'); // a still is always a file
  stats.add({ ...FACTS, sequence: 11 }, 1.1e6, null);
  assert.equal(stats.codec, '');
});

const PACE = { posesHz: 60, picturesHz: 20, waitedHz: 0, isDrawing: true, decodeMs: 5, isAtRest: false, isHere: false };

test('what limits the pictures', () => {
  assert.equal(limitOf(PACE), 'drawing');
  assert.equal(limitOf({ ...PACE, picturesHz: 58 }), 'none');
  assert.equal(limitOf({ ...PACE, posesHz: 120, picturesHz: 59 }), 'none'); // screens show no more
  assert.equal(limitOf({ ...PACE, isAtRest: true, picturesHz: 0 }), 'none');
  assert.equal(limitOf({ ...PACE, waitedHz: 30 }), 'network');
  assert.equal(limitOf({ ...PACE, waitedHz: 30, decodeMs: 40 }), 'browser');
  assert.equal(limitOf({ ...PACE, isHere: true }), 'browser');
  assert.equal(limitOf({ ...PACE, picturesHz: 0 }), 'drawing');
  assert.equal(limitOf({ ...PACE, picturesHz: 0, isDrawing: false }), 'network');
});

test('weights belong to the pose on the screen', () => {
  const weights = history();
  for (let i = 0; i <= 5; ++i) weights.add({ sequence: 2 * i, atS: i, values: new Float32Array([i / 10, 0, 0]) });
  assert.equal(weights.current!.sequence, 10);
  weights.pinned = 4;
  assert(Math.abs(weights.value('a') - 0.2) < 1e-6);
  assert.equal(weights.between(-1, weights.current!.atS).length, 3);
  weights.pinned = 7; // its weights were not sent: those of the pose before it
  assert.equal(weights.current!.sequence, 6);
  weights.pinned = 2 ** 31; // of a stream that has begun again since
  assert.equal(weights.current!.sequence, 10);
});

test('the first pictures of a slow renderer are small', () => {
  const scale = new AdaptiveScale();
  scale.begin(1280 * 600, 130_000);
  assert.equal(scale.scale, 0.35);
  scale.begin(300 * 300, 130_000);
  assert.equal(scale.scale, 1);
  scale.begin(4000 * 3000, 130_000);
  assert.equal(scale.scale, 0.25);
});

test('a single change at rest is not movement, several in a row are', () => {
  const stats = new PictureStats();
  const see = (still: boolean): boolean => {
    stats.add({ ...FACTS, still }, 0, null);
    return stats.resting;
  };
  assert.deepEqual([false, true, false, false, true, false, false, false, true].map(see),
    [false, true, true, true, true, true, true, false, true]);
});

/** Pixels of a picture whose quarter still shows folds. */
const LARGE = 1920 * 1200;

test('slow pictures reduce the pixels, which return after a while', () => {
  const scale = new AdaptiveScale();
  for (let s = 0; s < 4; ++s) assert.equal(scale.observe(5, 60, s, 100, LARGE), s % 2 === 1);
  assert.equal(scale.scale, 0.5);
  assert(!scale.observe(20, 60, 4, 100, LARGE)); // neither slow nor fast
  for (let s = 5; s < 9; ++s) assert(!scale.observe(50, 60, s, 100, LARGE));
  assert(scale.observe(50, 60, 9, 100, LARGE));
  assert.equal(scale.scale, 0.75);
});

test('pictures stay large enough for folds', () => {
  const pixels = 940 * 507;
  const scale = new AdaptiveScale();
  for (let s = 0; s < 20; ++s) scale.observe(3, 30, s, 50, pixels);
  assert.equal(scale.scale, 0.5); // 119,000 pixels
  assert(!scale.observe(3, 30, 20, 50, pixels));
  // Of a smaller window, half the size would hide them.
  for (let s = 21; s < 24; ++s) scale.observe(12, 30, s, 50, pixels / 2);
  assert.equal(scale.scale, 0.75);
});

test('one slow second changes nothing', () => {
  const scale = new AdaptiveScale();
  for (let s = 0; s < 20; ++s) assert(!scale.observe(s % 2 === 0 ? 5 : 50, 60, s, 100, LARGE));
  assert.equal(scale.scale, 1);
});

test('a slow publisher is not the renderer’s fault', () => {
  const scale = new AdaptiveScale();
  assert(!scale.observe(9.5, 10, 0, 100, LARGE));
  assert.equal(scale.scale, 1);
});

test('a daemon that draws fewer pixels than it sends gets time for it', () => {
  const scale = new AdaptiveScale();
  for (let s = -5; s < 1; ++s) assert(!scale.observe(15, 60, s, 75, LARGE)); // it may still go down to a half
  assert(scale.observe(15, 60, 1, 50, LARGE));
  assert.equal(scale.scale, 0.75);
  for (let s = 2; s < 20; ++s) assert(!scale.observe(50, 60, s, 69, LARGE)); // it has no time for more
  for (let s = 20; s < 24; ++s) assert(!scale.observe(50, 60, s, 75, LARGE));
  assert(scale.observe(50, 60, 24, 75, LARGE));
});

test('the share that was drawn is that of the picture on the screen', () => {
  const stats = new PictureStats();
  stats.add({ ...FACTS, drawnPercent: 63 }, 0, null);
  assert.equal(stats.picture(0, null)!.drawnPercent, 63);
  stats.add({ ...FACTS, still: true }, 0, null);
  assert.equal(stats.picture(0, null)!.drawnPercent, 100);
});

test('failed attempts become rarer', () => {
  const scale = new AdaptiveScale();
  for (const s of [-1, 0]) scale.observe(5, 60, s, 100, LARGE);
  let raised = 0;
  for (let s = 1; raised === 0; ++s) if (scale.observe(50, 60, s, 100, LARGE)) raised = s;
  for (const s of [1, 2]) scale.observe(5, 60, raised + s, 100, LARGE); // the larger size was too slow
  let again = 0;
  for (let s = raised + 3; again === 0; ++s) if (scale.observe(50, 60, s, 100, LARGE)) again = s;
  assert(again - raised - 3 >= 2 * (raised - 1));
});

test('pictures have the screen’s pixels, within the wire’s limits', () => {
  assert.deepEqual(pictureSize(800, 600, 2, 1), { width: 1600, height: 1200 });
  assert.deepEqual(pictureSize(801, 601, 1, 0.5), { width: 400, height: 300 });
  assert.deepEqual(pictureSize(4000, 2000, 2, 1), { width: 4096, height: 2048 });
  assert.deepEqual(pictureSize(2, 2, 1, 1), { width: 16, height: 16 });
});
