// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { CurveSpan } from '../src/state/curve_span';
import { WeightHistory } from '../src/state/weight_history';

const KEPT = { oldestS: 0, newestS: 100 };

test('curves are live until time is moved, and live again at the newest pose', () => {
  const span = new CurveSpan(120);
  assert.deepEqual(span.range(KEPT), [90, 100]);
  assert.deepEqual(span.range({ ...KEPT, newestS: 101 }), [91, 101]);
  span.pan(5, KEPT);
  assert.equal(span.isLive, true); // there is no later
  span.pan(-20, KEPT);
  assert.deepEqual(span.range({ ...KEPT, newestS: 130 }), [70, 80]); // time goes on, the span stays
  assert.equal(span.zero({ ...KEPT, newestS: 130 }), 100);
  span.pan(-500, KEPT);
  assert.deepEqual(span.range(KEPT), [0, 10]);
  span.pan(500, KEPT);
  assert.equal(span.isLive, true);
  assert.equal(span.zero({ ...KEPT, newestS: 130 }), 130);
});

test('zoom keeps the moment under the pointer, and the end of live curves', () => {
  const span = new CurveSpan(120);
  span.zoom(2, 0, KEPT);
  assert.deepEqual(span.range(KEPT), [80, 100]);
  span.pan(-20, KEPT); // 60 to 80
  span.zoom(0.5, 0.25, KEPT);
  assert.deepEqual(span.range(KEPT), [62.5, 72.5]);
  span.zoom(1e-9, 0.5, KEPT);
  assert.equal(span.lengthS, 0.5);
  span.zoom(1e9, 0.5, KEPT);
  assert.equal(span.lengthS, 120);
});

test('frozen curves end where they were stopped', () => {
  const span = new CurveSpan(120);
  span.stop(KEPT);
  assert.deepEqual(span.range({ ...KEPT, newestS: 104 }), [90, 100]);
  span.show(50, KEPT);
  assert.deepEqual(span.range(KEPT), [45, 55]);
  span.reset();
  assert.equal(span.isLive, true);
});

test('markers are numbered, bounded, removed, and forgotten with their poses', () => {
  const span = new CurveSpan(120);
  for (let i = 1; i <= 25; ++i) span.mark(i, 1000 + i);
  assert.equal(span.markers.length, 20);
  assert.deepEqual(span.markers[0], { number: 6, atS: 6, sequence: 1006 });
  span.unmark(7);
  assert.equal(span.markers.length, 19);
  assert.equal(span.forget({ oldestS: 10, newestS: 30 }), true);
  assert.equal(span.markers[0]!.number, 10);
  assert.equal(span.forget({ oldestS: 10, newestS: 30 }), false);
});

test('a span of the history, and its bound', () => {
  const history = new WeightHistory(1000);
  const names = Array.from({ length: 100_000 }, (_, i) => `w${i}`);
  history.setNames(names);
  const values = new Float32Array(names.length);
  for (let i = 0; i < 30; ++i) history.add({ sequence: i, atS: i, values });
  assert.equal(history.frames.length, 20); // two million numbers
  assert.deepEqual(history.between(12, 15).map(({ sequence }) => sequence), [12, 13, 14, 15]);
  assert.deepEqual(history.between(28.5, 99).map(({ sequence }) => sequence), [29]);
  assert.deepEqual(history.between(40, 50), []);
});

test('frames that are shown outlive the history', () => {
  const history = new WeightHistory(10);
  history.setNames(['a']);
  const values = new Float32Array(1);
  const addUntil = (end: number) => {
    for (let i = (history.latest?.sequence ?? -1) + 1; i <= end; ++i) history.add({ sequence: i, atS: i, values });
  };
  const numbers = (from: number, to: number) => history.betweenAndShown(shown, from, to).map(({ sequence }) => sequence);
  addUntil(8);
  const shown = history.between(4, 8);
  assert.deepEqual(numbers(4, 8), [4, 5, 6, 7, 8]); // each once
  addUntil(16);
  assert.deepEqual(numbers(4, 8), [4, 5, 6, 7, 8]);
  addUntil(99);
  assert.deepEqual(numbers(4, 8), [4, 5, 6, 7, 8]);
  assert.deepEqual(numbers(5, 6), [5, 6]);
  assert.equal(history.toCsv(shown, ['of then']).split('\n')[0], 'frame,time,of then');
});
