// SPDX-License-Identifier: Apache-2.0
// The light around the subject by name: the settings files of render/environments, which `furrow render --settings` reads
// as well. All of them name the same settings, so that none keeps a part of another.
import type { LightSettings, Rgb } from 'furrow-three/settings';
import neutral from '../../../render/environments/neutral.toml?raw';
import overcast from '../../../render/environments/overcast.toml?raw';
import stage from '../../../render/environments/stage.toml?raw';
import studio from '../../../render/environments/studio.toml?raw';
import sunset from '../../../render/environments/sunset.toml?raw';
import type { Values } from '../state/settings';
import { fromToml } from '../state/toml';
import { toSrgb } from './srgb';

const FILES = { studio, overcast, sunset, stage, neutral } as const;

export type EnvironmentName = keyof typeof FILES;

export interface Environment {
  name: EnvironmentName;
  values: Values;
}

export const ENVIRONMENTS: readonly Environment[] = Object.entries(FILES)
  .map(([name, toml]) => ({ name: name as EnvironmentName, values: fromToml(toml) }));

/** The settings that make up an environment. */
export const ENVIRONMENT_SETTINGS: readonly string[] = [...ENVIRONMENTS[0]!.values.keys()];

/** Light of each lamp and of the sky without filters, roughly as in render/scene/lighting.cpp: enough for a swatch. */
const LAMPS: Record<LightSettings['preset'], Record<'key' | 'fill' | 'rim' | 'sky', Rgb>> = {
  studio: { key: [1.12, 0.98, 0.84], fill: [0.22, 0.225, 0.25], rim: [0.28, 0.31, 0.36], sky: [0.1, 0.1, 0.1] },
  hard: { key: [2.1, 1.95, 1.78], fill: [0, 0, 0], rim: [0, 0, 0], sky: [0.03, 0.03, 0.03] },
  thesis: { key: [0.75, 0.75, 0.75], fill: [0.45, 0.45, 0.45], rim: [0.45, 0.45, 0.45], sky: [0.05, 0.05, 0.05] },
};
const GREY = 0.6;

/** A grey ball in this light, as a CSS image: the key from the upper left, the fill from the right, the rim at the edge. */
export function swatchOf(values: Values): string {
  const number = (name: string): number => Number(values.get(name));
  const preset = LAMPS[values.get('lights.preset') as LightSettings['preset']];
  const light = (lamp: keyof typeof preset): Rgb => {
    const filter = values.get(`lights.${lamp}`)!.split(',').map(Number);
    const scale = GREY * number('exposure') * number(lamp === 'sky' ? 'lights.ambient' : 'lights.intensity');
    return preset[lamp].map((each, channel) => each * filter[channel]! * scale) as Rgb;
  };
  const sky = light('sky');
  const colour = (...lights: Rgb[]): string => {
    const bytes = sky.map((each, channel) => lights.reduce((sum, one) => sum + one[channel]!, each))
      .map((linear) => Math.round(255 * toSrgb(Math.min(1, linear))));
    return `rgb(${bytes.join(' ')})`;
  };
  return `radial-gradient(circle at 34% 32%, ${colour(light('key'))} 12%, ${colour(light('fill'))} 68%, ${colour(light('rim'))} 100%)`;
}
