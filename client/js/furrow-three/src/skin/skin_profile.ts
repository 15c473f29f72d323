// SPDX-License-Identifier: Apache-2.0
// The diffusion profile of skin (render/skin/skin_profile.h), read from the shader that holds it, so that it exists once.
import { glslOf } from './glsl.js';

/** Red, green and blue. */
export type Rgb = readonly [number, number, number];

/** One isotropic Gaussian; `variance` in mm^2. The weights of a profile sum to 1 per channel. */
export interface SkinGaussian {
  variance: number;
  weight: Rgb;
}

function numbersAfter(text: string, name: string, type: string): number[] {
  const list = new RegExp(`${name}\\[\\w+\\] =\\s*${type}\\[\\]\\(([^;]*)\\);`).exec(text)?.[1];
  if (list === undefined) throw new Error(`furrow-three: shaders/skin/diffusion.glsl has no ${name}`);
  return [...list.matchAll(/\d+\.\d+/g)].map(([number]) => Number(number));
}

function readProfile(): SkinGaussian[] {
  const text = glslOf('skin/diffusion.glsl');
  const variances = numbersAfter(text, 'GAUSSIAN_VARIANCE', 'float');
  const weights = numbersAfter(text, 'GAUSSIAN_WEIGHT', 'vec3');
  return variances.map((variance, i) => ({ variance, weight: [weights[3 * i]!, weights[3 * i + 1]!, weights[3 * i + 2]!] }));
}

/** D'Eon and Luebke's fit to human skin (GPU Gems 3, chapter 14). */
export const HUMAN_SKIN: readonly SkinGaussian[] = readProfile();

/** The error function, within 1.2e-7 (Press et al. 1992, "Numerical Recipes", erfcc). */
function erf(x: number): number {
  const t = 1 / (1 + 0.5 * Math.abs(x));
  const series = [1.00002368, 0.37409196, 0.09678418, -0.18628806, 0.27886807, -1.13520398, 1.48851587, -0.82215223, 0.17087277];
  const sum = series.reduceRight((rest, each) => each + t * rest, 0);
  const tail = t * Math.exp(-x * x - 1.26551223 + t * sum);
  return x >= 0 ? 1 - tail : tail - 1;
}

/** Light at `x` (mm) from a straight edge, where skin is lit with 1 for x > 0 and dark elsewhere; [0, 1] per channel. */
export function stepResponse(profile: readonly SkinGaussian[], x: number): [number, number, number] {
  const light: [number, number, number] = [0, 0, 0];
  for (const { variance, weight } of profile) {
    const share = 0.5 * (1 + erf(x / Math.sqrt(2 * variance)));
    for (let c = 0; c < 3; ++c) light[c]! += weight[c]! * share;
  }
  return light;
}
