// SPDX-License-Identifier: Apache-2.0
// The kernel in TypeScript has the properties of the one in C++ (tests/unit/render/skin/pixel_kernel_test.cpp).
import assert from 'node:assert/strict';
import test from 'node:test';
import { pixelKernel, type PixelTaps } from '../src/skin/pixel_kernel.js';
import { HUMAN_SKIN, stepResponse } from '../src/skin/skin_profile.js';

const near = (actual: number, expected: number, within: number, what = ''): void =>
  assert(Math.abs(actual - expected) <= within, `${what}: ${actual}, expected ${expected}`);

/** Light at `mm` from an edge after one pass along the axis. */
function edgeOf({ offsets, weights }: PixelTaps, pixelsPerMm: number, mm: number, channel: number): number {
  let sum = 0;
  offsets.forEach(([x], i) => {
    for (const side of i === 0 ? [0] : [-x, x]) if (mm * pixelsPerMm + side > 0) sum += weights[i]![channel]!;
  });
  return sum;
}

test('the profile is the one of the shaders', () => {
  assert.equal(HUMAN_SKIN.length, 6);
  for (let c = 0; c < 3; ++c) near(HUMAN_SKIN.reduce((sum, { weight }) => sum + weight[c]!, 0), 1, 1e-6);
  assert.deepEqual([HUMAN_SKIN[5]!.variance, HUMAN_SKIN[4]!.weight[0]], [7.41, 0.358]);
  near(stepResponse(HUMAN_SKIN, 0)[0], 0.5, 1e-6);
  near(stepResponse(HUMAN_SKIN, 1)[0], 0.875, 1e-3, 'red at 1 mm');
});

test('weights sum to 1 on whole pixels', () => {
  for (const taps of [11, 17, 25]) {
    for (const pixelsPerMm of [0.05, 0.3, 1, 2.4, 8, 40]) {
      const { offsets, weights } = pixelKernel(HUMAN_SKIN, taps, pixelsPerMm);
      assert(2 * weights.length - 1 <= taps);
      for (let c = 0; c < 3; ++c) {
        near(weights.reduce((sum, weight, i) => sum + (i === 0 ? 1 : 2) * weight[c]!, 0), 1, 1e-5, `${taps} ${pixelsPerMm}`);
        for (const weight of weights) assert(weight[c]! >= 0);
      }
      assert.deepEqual(offsets[0], [0, 0]);
      for (let i = 1; i < offsets.length; ++i) {
        assert(offsets[i]![0] > offsets[i - 1]![0]);
        assert.deepEqual(offsets[i]!.map(Math.round), offsets[i]);
      }
    }
  }
});

test('wider pixels make the kernel shorter', () => {
  assert.equal(pixelKernel(HUMAN_SKIN, 17, 0.01).weights.length, 1);
  assert(pixelKernel(HUMAN_SKIN, 17, 0.5).weights.length < 9);
  assert.equal(pixelKernel(HUMAN_SKIN, 17, 5).weights.length, 9);
});

test('most of the variance is kept', () => {
  for (const [taps, least] of [[11, 1.09], [17, 1.22], [25, 1.3]] as const) {
    const { offsets, weights } = pixelKernel(HUMAN_SKIN, taps, 8);
    const variance = weights.reduce((sum, weight, i) => sum + (i === 0 ? 1 : 2) * weight[0]! * (offsets[i]![0] ** 2 + offsets[i]![1] ** 2), 0) / 64;
    assert(variance > least && variance < 1.383, `${taps}: ${variance}`);
  }
});

test('an edge becomes the staircase nearest to the profile', () => {
  for (const pixelsPerMm of [2.4, 8]) {
    const kernel = pixelKernel(HUMAN_SKIN, 17, pixelsPerMm);
    let sum = 0;
    let count = 0;
    for (let pixel = -20 * pixelsPerMm; pixel < 20 * pixelsPerMm; ++pixel) {
      const mm = (pixel + 0.5) / pixelsPerMm;
      stepResponse(HUMAN_SKIN, mm).forEach((expected, c) => {
        sum += (edgeOf(kernel, pixelsPerMm, mm, c) - expected) ** 2;
        ++count;
      });
    }
    assert(Math.sqrt(sum / count) < 0.01, `${pixelsPerMm}: ${Math.sqrt(sum / count)}`);
  }
});
