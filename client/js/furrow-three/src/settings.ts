// SPDX-License-Identifier: Apache-2.0
// The renderer's settings that StudioView follows, by the names and with the defaults of render/settings/settings.h
// (`furrow render --print-settings`).

export type Rgb = [number, number, number];

/** Parts of the light that can be shown instead of the finished picture. */
export const SKIN_VIEWS = ['final', 'shadow', 'specular', 'translucency', 'albedo', 'material'] as const;
export type SkinViewName = (typeof SKIN_VIEWS)[number];

export interface LightSettings {
  preset: 'studio' | 'hard' | 'thesis';
  intensity: number;
  ambient: number;
  turn_degrees: number;
  tilt_degrees: number;
  key: Rgb;
  fill: Rgb;
  rim: Rgb;
  sky: Rgb;
}

export interface ShadowSettings {
  filter: 'off' | 'pcf' | 'pcss';
  resolution: number;
  fit: boolean;
  lamps: number;
  taps: number;
  softness_mm: number;
  lamp_mm: number;
  normal_offset_mm: number;
}

export interface StudioSettings {
  view: SkinViewName;
  shading: 'diffuse' | 'skin';
  wrinkles: boolean;
  wrinkle_strength: number;
  background: Rgb;
  exposure: number;
  tone_map: 'neutral' | 'clip';
  lights: LightSettings;
  shadow: ShadowSettings;
  occlusion: { method: 'off' | 'gtao' | 'ssao'; radius_mm: number; strength: number; samples: number; half_resolution: boolean };
  subsurface: { method: 'off' | 'separable'; taps: number; width: number; strength: number; gradient: number; depth_range_mm: number; mix: number };
  translucency: { enabled: boolean; strength: number; scale: number; shrink_mm: number };
  specular: { mode: 'physical' | 'gems'; strength: number; roughness: number; second_lobe: number; conserve_energy: boolean; widen: boolean };
  wrinkle_maps: { blood_flow: number; cavity: number };
  bloom: { strength: number; threshold: number; radius: number };
}

/** Settings with the renderer's defaults, which the caller may change. */
export function defaultSettings(): StudioSettings {
  return {
    view: 'final',
    shading: 'diffuse',
    wrinkles: true,
    wrinkle_strength: 1,
    background: [0.028, 0.029, 0.031],
    exposure: 1,
    tone_map: 'neutral',
    lights: {
      preset: 'studio', intensity: 1, ambient: 1, turn_degrees: 0, tilt_degrees: 0,
      key: [1, 1, 1], fill: [1, 1, 1], rim: [1, 1, 1], sky: [1, 1, 1],
    },
    shadow: { filter: 'pcf', resolution: 1024, fit: true, lamps: 3, taps: 8, softness_mm: 3, lamp_mm: 60, normal_offset_mm: 1 },
    occlusion: { method: 'gtao', radius_mm: 25, strength: 1, samples: 12, half_resolution: true },
    subsurface: { method: 'separable', taps: 17, width: 1, strength: 1, gradient: 1, depth_range_mm: 6, mix: 0.5 },
    translucency: { enabled: true, strength: 1, scale: 1, shrink_mm: 5 },
    specular: { mode: 'physical', strength: 1, roughness: 1, second_lobe: 0.3, conserve_energy: true, widen: true },
    wrinkle_maps: { blood_flow: 1, cavity: 1 },
    bloom: { strength: 0.05, threshold: 1, radius: 0.015 },
  };
}

const WORDS: Readonly<Record<string, readonly string[]>> = {
  view: SKIN_VIEWS,
  shading: ['diffuse', 'skin'],
  tone_map: ['neutral', 'clip'],
  'lights.preset': ['studio', 'hard', 'thesis'],
  'shadow.filter': ['off', 'pcf', 'pcss'],
  'occlusion.method': ['off', 'gtao', 'ssao'],
  'subsurface.method': ['off', 'separable'],
  'specular.mode': ['physical', 'gems'],
};

/**
 * Settings that change nothing that is drawn here, whatever their value: they choose how something is computed, or belong
 * to methods, crowds and displacement, which StudioView does not have and which are refused by other names.
 */
const WITHOUT_EFFECT = /^(detail\..*|displacement\.(strength|edge_pixels|max_level)|wrinkle_maps\.cache|specular\.table|subsurface\.samples)$/;

/** The values that settings must have which StudioView does not know. */
const REQUIRED: Readonly<Record<string, readonly string[]>> = {
  normal_blend: ['partial_derivative'],
  mask_mode: ['rig'],
  'displacement.enabled': ['off'],
  // With shading "skin", StudioView always has one sample and FXAA. With "diffuse", the renderer's antialiasing is drawn.
  'anti_aliasing.samples': ['0', '1'],
  'anti_aliasing.fxaa': ['off', 'on'],
  'strip.views': [''],
};

/** What StudioView follows with the shading "diffuse"; other settings must have their defaults or have no effect. */
const DIFFUSE_FOLLOWS = /^(shading|background|lights\..*)$/;
const SKIN_ONLY = /^(shadow|occlusion|subsurface|translucency|specular|wrinkle_maps|bloom)\./;

type Values = Record<string, unknown>;

function slotOf(settings: StudioSettings, name: string): { owner: Values; key: string } | null {
  const [first, second] = name.split('.') as [string, string?];
  const top = settings as unknown as Values;
  const owner = second === undefined ? top : (top[first] as Values | undefined);
  const key = second ?? first;
  return owner !== undefined && Object.hasOwn(owner, key) ? { owner, key } : null;
}

/** The value that a text means, of the kind of `former`; undefined: none. */
function parse(name: string, text: string, former: unknown): unknown {
  if (typeof former === 'boolean') {
    return text === 'on' || text === 'true' ? true : text === 'off' || text === 'false' ? false : undefined;
  }
  if (typeof former === 'string') return WORDS[name]?.includes(text) ? text : undefined;
  const numbers = text.split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  if (!numbers.every(Number.isFinite) || numbers.length !== (Array.isArray(former) ? 3 : 1)) return undefined;
  return Array.isArray(former) ? numbers : numbers[0];
}

function isSame(a: unknown, b: unknown): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

export interface ReadSettings {
  settings: StudioSettings;
  /** Names of settings with values that StudioView cannot draw; the picture would be another one than the daemon's. */
  unsupported: string[];
}

/** Reads settings by the daemon's names and in its text form, such as ["shadow.filter", "off"]. */
export function readSettings(values: Iterable<readonly [string, string]>): ReadSettings {
  const settings = defaultSettings();
  const defaults = defaultSettings();
  const unsupported: string[] = [];
  const read: string[] = [];
  for (const [name, text] of values) {
    if (WITHOUT_EFFECT.test(name)) continue;
    const slot = slotOf(settings, name);
    if (slot === null || typeof slot.owner[slot.key] === 'object' && !Array.isArray(slot.owner[slot.key])) {
      if (!REQUIRED[name]?.includes(text)) unsupported.push(name);
      continue;
    }
    const value = parse(name, text, slot.owner[slot.key]);
    if (value === undefined) unsupported.push(name);
    else slot.owner[slot.key] = value;
    read.push(name);
  }
  if (settings.shading === 'diffuse' && settings.view === 'final') {
    for (const name of read) {
      if (DIFFUSE_FOLLOWS.test(name) || unsupported.includes(name)) continue;
      const slot = slotOf(settings, name)!;
      const usual = slotOf(defaults, name)!;
      if (!SKIN_ONLY.test(name) && !isSame(slot.owner[slot.key], usual.owner[usual.key])) unsupported.push(name);
    }
    // Values that only matter to skin do not count.
    return { settings, unsupported: unsupported.filter((name) => !SKIN_ONLY.test(name)) };
  }
  return { settings, unsupported };
}
