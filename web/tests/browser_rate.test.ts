// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { BrowserRate, ENOUGH, MEASURED, SLOW_S, WARM_UP } from '../src/view/browser_rate';

/** Measures a picture's time, and says how many samples that took. */
function measure(rate: BrowserRate, ms: number): number {
  let count = 1;
  while (!rate.sample(count <= WARM_UP ? 100 * ms : ms)) ++count;
  return count;
}

/** Shows `hz` pictures per second from `fromS` on, for `seconds`, and checks the rate after each. */
function watch(rate: BrowserRate, fromS: number, seconds: number, hz: number, wantedHz: number, options: { isRest?: boolean; isVisible?: boolean } = {}) {
  for (let second = 0; second < seconds; ++second) {
    for (let i = 0; i < hz; ++i) rate.shown(fromS + second + (i + 0.5) / hz, options.isRest ?? false);
    rate.check(fromS + second + 1, wantedHz, options.isVisible ?? true);
  }
}

test('the rate is that of the median picture after the first ones', () => {
  const rate = new BrowserRate();
  assert.equal(rate.hz, null);
  assert.equal(measure(rate, 20), WARM_UP + MEASURED);
  assert.equal(rate.hz, 50);
  rate.forget();
  assert.equal(rate.hz, null);
  measure(rate, 0.001);
  assert.equal(rate.hz, 1000, 'a clock does not measure less than a millisecond');
});

test('too few pictures for long enough replace the measurement', () => {
  const rate = new BrowserRate();
  measure(rate, 20);
  watch(rate, 0, SLOW_S - 1, 10, 30);
  assert.equal(rate.hz, 50, 'not yet');
  watch(rate, SLOW_S - 1, 1, 10, 30);
  assert.equal(rate.hz, 10);
});

test('a second with enough pictures counts from the beginning again', () => {
  const rate = new BrowserRate();
  measure(rate, 20);
  const enough = Math.ceil(ENOUGH * 30);
  for (let from = 0; from < 40; from += SLOW_S + 1) {
    watch(rate, from, SLOW_S - 1, 10, 30);
    // Two seconds are counted together, so it takes two to be fast again.
    watch(rate, from + SLOW_S - 1, 2, 2 * enough, 30);
  }
  assert.equal(rate.hz, 50);
});

test('a hidden page says nothing', () => {
  const rate = new BrowserRate();
  measure(rate, 20);
  watch(rate, 0, 10, 0, 30, { isVisible: false });
  assert.equal(rate.hz, 50);
});

test('a pose at rest says nothing, and a pose that moves again does', () => {
  const rate = new BrowserRate();
  measure(rate, 20);
  watch(rate, 0, 10, 5, 30, { isRest: true });
  assert.equal(rate.hz, 50);
  watch(rate, 10, SLOW_S + 2, 5, 30);
  assert.equal(rate.hz, 5);
});

test('pictures from before count no longer after a restart', () => {
  const rate = new BrowserRate();
  watch(rate, 0, 2, 30, 30);
  assert.equal(rate.shownHz(2), 30);
  rate.restart();
  assert.equal(rate.shownHz(2), 0);
});
