// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import type { SubjectInfo } from '../src/api';
import { MAX_TILES, neighbour, TileBudget, tilesOf, whoMoves } from '../src/grid/plan';
import { isAtRest } from '../src/view/rest';

type State = SubjectInfo['state'];
const subject = (name: string, moved_ms: number | null = null, state: State = 'live') => ({ name, state, moved_ms });

test('more tiles are slower, and a slow large picture slows them more', () => {
  const budget = new TileBudget();
  const rates = () => [1, 3, 6, 12, 24].map((count) => budget.rateHz(count));
  const slowest = [5, 1.25, 0.5, 0.5, 0.25];
  assert.deepEqual(rates(), slowest);
  for (let i = 0; i < 5; ++i) budget.observe('live', 30, 60, false);
  assert.deepEqual(rates(), [10, 10, 5, 2.5, 1.25]);
  budget.observe('live', 5, 60, false);
  assert.deepEqual(rates(), [10, 5, 2.5, 1.25, 0.5]);
  for (let i = 0; i < 5; ++i) budget.observe('live', 0, 60, true); // a pose at rest needs no pictures
  assert.deepEqual(rates(), [10, 10, 5, 2.5, 1.25]);
  budget.observe('stale', 1, 60, false);
  assert.deepEqual(rates(), slowest);
});

test('all tiles together keep the budget, however many there are', () => {
  const budget = new TileBudget();
  const mostOf = () => Math.max(...Array.from({ length: MAX_TILES }, (_, i) => (i + 1) * budget.rateHz(i + 1)));
  assert(mostOf() <= 6, `${mostOf()} per second`);
  for (let i = 0; i < 5; ++i) budget.observe('live', 30, 60, false);
  assert(mostOf() <= 30 && mostOf() > 20, `${mostOf()} per second`);
});

test('tiles are bounded, and keep the daemon’s order', () => {
  const few = [subject('b'), subject('gone', null, 'ended'), subject('a', null, 'lost')];
  assert.deepEqual(tilesOf(few, '').map(({ name }) => name), ['b', 'a']);
  const many = Array.from({ length: 40 }, (_, i) => subject(`s${i}`, null, i < 30 ? 'lost' : 'live'));
  const shown = tilesOf(many, 's7').map(({ name }) => name);
  assert.equal(shown.length, MAX_TILES);
  assert(shown.includes('s7') && shown.includes('s39'), shown.join());
  assert.deepEqual(shown, [...shown].sort((a, b) => Number(a.slice(1)) - Number(b.slice(1))));
});

test('the focus follows the one who moves, once the present one rests', () => {
  assert.equal(whoMoves([subject('a', 100), subject('b', 20)], 'a'), 'a');
  assert.equal(whoMoves([subject('a', 1400), subject('b', 20)], 'a'), 'a');
  assert.equal(whoMoves([subject('a', 1600), subject('b', 90), subject('c', 20)], 'a'), 'c');
  assert.equal(whoMoves([subject('a', 1600), subject('b', 900)], 'a'), 'a'); // nobody moves
  assert.equal(whoMoves([subject('a', 10, 'lost'), subject('b', 20)], 'a'), 'b');
  assert.equal(whoMoves([subject('a', null), subject('b', 20)], 'a'), 'b');
  assert.equal(whoMoves([subject('b', null)], 'gone'), 'gone');
});

test('arrow keys move between tiles, and stop at the edges', () => {
  const from4 = (key: string) => neighbour(key, 4, 8, 3);
  assert.deepEqual(['ArrowRight', 'ArrowLeft', 'ArrowDown', 'ArrowUp', 'Home', 'End', 'x'].map(from4), [5, 3, 7, 1, 0, 7, -1]);
  assert.equal(neighbour('ArrowDown', 6, 8, 3), 6);
  assert.equal(neighbour('ArrowLeft', 0, 8, 3), 0);
});

test('a picture rests if nothing has moved since its pose', () => {
  const at = (ageMs: number | null, isStill: boolean, moved_ms: number | null, rate_hz = 60) =>
    isAtRest({ ageMs, isStill }, { moved_ms, rate_hz }, 500);
  assert.equal(at(5000, true, 4900), true);
  assert.equal(at(5000, true, 100), false); // it has moved
  assert.equal(at(5000, false, 4900), false); // at 60 poses per second, the answer is too old to tell
  assert.equal(at(5000, false, 4900, 0), true);
  assert.equal(at(null, true, 4900), false);
  assert.equal(at(5000, true, null), false);
  assert.equal(isAtRest(null, { moved_ms: 0, rate_hz: 60 }, 0), false);
});
