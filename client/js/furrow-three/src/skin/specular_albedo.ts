// SPDX-License-Identifier: Apache-2.0
// How much light the specular term reflects in total: render/skin/beckmann.h explains it and is the same in C++.

export const ALBEDO_TABLE_SIZE = 32;
const SMALLEST_M = 1 / 32;
const SAMPLES = 32; // per dimension

/** The share is f0 x + (1 - f0) y for a reflectance f0 at normal incidence. */
function specularAlbedo(cosine: number, m: number): [number, number] {
  const cosV = Math.min(Math.max(cosine, 1e-4), 1);
  const sinV = Math.sqrt(1 - cosV * cosV);
  const sum: [number, number] = [0, 0];
  for (let i = 0; i < SAMPLES; ++i) {
    const tan2 = -m * m * Math.log(1 - (i + 0.5) / SAMPLES);
    const cosH = 1 / Math.sqrt(1 + tan2);
    const sinH = Math.sqrt(tan2) * cosH;
    for (let j = 0; j < SAMPLES; ++j) {
      const cosVh = cosV * cosH + sinV * sinH * Math.cos((Math.PI * (j + 0.5)) / SAMPLES);
      const cosL = 2 * cosVh * cosH - cosV;
      if (cosVh <= 0 || cosL <= 0) continue;
      const share = cosL / (cosVh * cosH);
      sum[0] += share;
      sum[1] += share * (1 - cosVh) ** 5;
    }
  }
  return [sum[0] / SAMPLES ** 2, sum[1] / SAMPLES ** 2];
}

/** Rows are m, columns cosines, both from 0 to 1. Four numbers per texel: xy for m, zw for the lobe of m / 2. */
export function twoLobeAlbedoTable(size = ALBEDO_TABLE_SIZE): Float32Array {
  const row = (m: number): [number, number][] =>
    Array.from({ length: size }, (_, column) => specularAlbedo(column / (size - 1), Math.max(m, SMALLEST_M)));
  const rows = Array.from({ length: size }, (_, r) => row(r / (size - 1)));
  const table = new Float32Array(4 * size * size);
  rows.forEach((one, r) => {
    const half = Math.max(0.5 * r, SMALLEST_M * (size - 1));
    const below = Math.min(Math.floor(half), size - 2);
    one.forEach(([x, y], column) => {
      const [from, to] = [rows[below]![column]!, rows[below + 1]![column]!];
      const mix = (k: 0 | 1): number => from[k] + (to[k] - from[k]) * (half - below);
      table.set([x, y, mix(0), mix(1)], 4 * (r * size + column));
    });
  });
  return table;
}
