// SPDX-License-Identifier: Apache-2.0
// The transfer function of sRGB (IEC 61966-2-1), for values in [0, 1].

export const toSrgb = (x: number): number => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
export const toLinear = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
