// SPDX-License-Identifier: Apache-2.0
// The table in TypeScript against plain quadrature over light directions (tests/unit/render/skin/beckmann_test.cpp).
import assert from 'node:assert/strict';
import test from 'node:test';
import { twoLobeAlbedoTable } from '../src/skin/specular_albedo.js';

const SIZE = 32;
const F0 = 0.028;

/** The term of Kelemen and Szirmay-Kalos, over pi. */
function brdf(cosLight: number, cosView: number, between: number, m: number): number {
  const length = Math.sqrt(2 + 2 * between);
  const cosH = Math.min((cosLight + cosView) / length, 1);
  const cos2 = cosH * cosH;
  const ph = Math.exp((cos2 - 1) / (cos2 * m * m)) / (m * m * cos2 * cos2);
  return (ph * (F0 + (1 - F0) * (1 - 0.5 * length) ** 5)) / length ** 2 / Math.PI;
}

function plain(cosView: number, m: number): number {
  const [cosines, azimuths] = [600, 300];
  const sinView = Math.sqrt(1 - cosView * cosView);
  let sum = 0;
  for (let i = 0; i < cosines; ++i) {
    const cosLight = (i + 0.5) / cosines;
    const sinLight = Math.sqrt(1 - cosLight * cosLight);
    for (let j = 0; j < azimuths; ++j) {
      sum += brdf(cosLight, cosView, cosLight * cosView + sinLight * sinView * Math.cos((Math.PI * (j + 0.5)) / azimuths), m) * cosLight;
    }
  }
  return (sum * 2 * Math.PI) / (cosines * azimuths);
}

test('the table holds the share of light that both lobes reflect', () => {
  const table = twoLobeAlbedoTable();
  assert.equal(table.length, 4 * SIZE * SIZE);
  const at = (column: number, row: number, lobe: 0 | 2): number => {
    const first = 4 * (row * SIZE + column) + lobe;
    return F0 * table[first]! + (1 - F0) * table[first + 1]!;
  };
  for (const row of [6, 12, 20]) {
    const m = row / (SIZE - 1);
    for (const column of [6, 16, 31]) {
      const cosine = column / (SIZE - 1);
      const [one, half] = [plain(cosine, m), plain(cosine, 0.5 * m)];
      assert(Math.abs(at(column, row, 0) - one) < 0.02 * one, `m ${m}, cosine ${cosine}: ${at(column, row, 0)}, expected ${one}`);
      assert(Math.abs(at(column, row, 2) - half) < 0.03 * half, `half of m ${m}, cosine ${cosine}: ${at(column, row, 2)}, expected ${half}`);
    }
  }
  for (const value of table) assert(value >= 0 && value <= 1.01);
});
