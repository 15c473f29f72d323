// SPDX-License-Identifier: Apache-2.0
// Lamps that follow a drag, and the exposure that a point of the picture asks for. Pure.
import { toLinear, toSrgb } from './srgb';

/** lights.turn_degrees and lights.tilt_degrees. */
export interface LampAngles {
  turn: number;
  tilt: number;
}

export type Rgb = readonly [number, number, number];

/** A drag across the height of the picture turns the lamps half around. */
const DEGREES_PER_HEIGHT = 180;
const MOST_TILT = 90;

/** Linear luminance of a grey card, which reflects 18% of the light. */
export const CARD = 0.18;
/** Darker points say nothing about the exposure. */
const LEAST = 0.0005;
/** Where the tone map begins to compress, and how much colour highlights lose (tonemap.glsl). */
const COMPRESSED = 0.76;
const DESATURATION = 0.15;
/** The least exposure that the page sets. The daemon takes any above 0. */
const LEAST_EXPOSURE = 0.01;
/** Views that show data or colours: no exposure and no tone map (composite_pass.cpp). */
const WITHOUT_LIGHT: readonly string[] =
  ['normal', 'mask_dynamic', 'mask_texture', 'shadow', 'shadow_maps', 'depth', 'material', 'occlusion', 'albedo'];

/** The lamps after a drag to the right and up, in heights of the picture. Turning goes round, tilting ends at the poles. */
export function dragged({ turn, tilt }: LampAngles, right: number, up: number): LampAngles {
  const round = (degrees: number): number => Math.round(degrees * 10) / 10;
  const turned = turn + right * DEGREES_PER_HEIGHT;
  return {
    turn: round(turned - 360 * Math.floor((turned + 180) / 360)),
    tilt: round(Math.min(MOST_TILT, Math.max(-MOST_TILT, tilt + up * DEGREES_PER_HEIGHT))),
  };
}

/** sRGB in [0, 255] to linear light before the tone map; `neutral`: tone_map is 'neutral', not 'clip'. */
export function linearOf(srgb: Rgb, neutral: boolean): Rgb {
  const [r, g, b] = srgb.map((value) => toLinear(value / 255)) as [number, number, number];
  const peak = Math.max(r, g, b);
  if (!neutral || peak <= COMPRESSED) return [r, g, b];
  const rest = 1 - COMPRESSED;
  const before = (rest * rest) / Math.max(1 - peak, 1e-3) - rest + COMPRESSED;
  return [r, g, b].map((value) => (value * before) / peak) as [number, number, number];
}

/** The exposure with which a point of this linear colour is as bright as a grey card; null: it is too dark to tell. */
export function exposureFor([r, g, b]: Rgb, exposure: number): number | null {
  const luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  if (luminance < LEAST || exposure <= 0) return null;
  return (exposure * CARD) / luminance;
}

/** The nearest exposure that the page sets, in hundredths. */
export function withinRange(exposure: number, most: number): number {
  return Math.min(most, Math.max(LEAST_EXPOSURE, Math.round(exposure * 100) / 100));
}

/** True if the brightness of a view follows the exposure. */
export function isOfLight(view: string): boolean {
  return !WITHOUT_LIGHT.includes(view);
}

/** The tone map of tonemap.glsl. */
function toneMapped(linear: Rgb): Rgb {
  const peak = Math.max(...linear);
  if (peak < COMPRESSED) return linear;
  const rest = 1 - COMPRESSED;
  const newPeak = 1 - (rest * rest) / (peak + rest - COMPRESSED);
  const white = 1 - 1 / (DESATURATION * (peak - newPeak) + 1);
  return linear.map((value) => ((1 - white) * value * newPeak) / peak + white * newPeak) as unknown as Rgb;
}

/** True if both colours look alike in a compressed picture. `linear`: the setting `background` times the exposure. */
export function isBackground(srgb: Rgb, linear: Rgb, neutral: boolean): boolean {
  const shown = (neutral ? toneMapped(linear) : linear).map((value) => Math.min(1, Math.max(0, value)));
  return srgb.every((value, i) => Math.abs(value - 255 * toSrgb(shown[i]!)) <= 3);
}

/** Where the lamps are, for the turntable: radians after `seconds`; with reduced motion, in steps. */
export function turntableRadians(seconds: number, reduced: boolean): number {
  const STEP_S = 2;
  const RADIANS_PER_S = Math.PI / 8;
  const at = reduced ? Math.floor(seconds / STEP_S) * STEP_S : seconds;
  return at * RADIANS_PER_S;
}
