// SPDX-License-Identifier: Apache-2.0
// The parts of a wrinkle rig that drawing needs: where each weight's wrinkles lie, and what they look like. The daemon
// evaluates the rest (docs/RIG.md).
import { withoutComments } from './json_comments.js';

export type Surface = 'any' | 'skin' | 'cloth';

export interface WrinkleMap {
  name: string;
  /** Names of pictures; empty: none. */
  normal: string;
  derivative: string;
  /** The derivative of a full texel of `derivative`. */
  derivativeScale: number;
  colour: string;
  /** The linear factor of a full texel of `colour`. */
  colourScale: number;
  cavity: string;
  amplitude: number;
  surface: Surface;
}

/** One wrinkle weight, "<region>.<map>": it scales a map where a channel of a mask is above 0. */
export interface WeightPlace {
  weight: string;
  map: number;
  mask: string;
  channel: number;
}

export interface DrawnRig {
  name: string;
  maps: WrinkleMap[];
  /** Regions with painted masks. Masks that follow joints are left out; `notDrawn` names their regions. */
  places: WeightPlace[];
  notDrawn: string[];
}

type Json = Record<string, unknown>;

const CHANNELS = ['r', 'g', 'b', 'a'];

function fail(where: string, expected: string): never {
  throw new Error(`wrinkle rig: ${where}: expected ${expected}`);
}

function objects(from: Json, key: string): Json[] {
  const value = from[key] ?? [];
  if (!Array.isArray(value) || value.some((each) => typeof each !== 'object' || each === null)) fail(key, 'a list of objects');
  return value as Json[];
}

function text(from: Json, key: string, where: string, otherwise = ''): string {
  const value = from[key] ?? otherwise;
  if (typeof value !== 'string') fail(`${where}.${key}`, 'text');
  return value;
}

function number(from: Json, key: string, where: string, otherwise: number): number {
  const value = from[key] ?? otherwise;
  if (typeof value !== 'number' || !Number.isFinite(value)) fail(`${where}.${key}`, 'a number');
  return value;
}

function readMap(json: Json, where: string): WrinkleMap {
  const name = text(json, 'name', where);
  const surface = text(json, 'surface', where, 'any');
  if (name === '') fail(`${where}.name`, 'a name');
  if (surface !== 'any' && surface !== 'skin' && surface !== 'cloth') fail(`${where}.surface`, 'any, skin or cloth');
  return {
    name,
    surface,
    normal: text(json, 'normal', where),
    derivative: text(json, 'derivative', where),
    derivativeScale: number(json, 'derivative_scale', where, 1),
    colour: text(json, 'colour', where),
    colourScale: number(json, 'colour_scale', where, 1),
    cavity: text(json, 'cavity', where),
    amplitude: number(json, 'amplitude', where, 1),
  };
}

/** Reads a rig file, JSON with comments. Throws an Error that names the field. */
export function readRig(json: string): DrawnRig {
  const root = JSON.parse(withoutComments(json)) as Json;
  if (typeof root !== 'object' || root === null) fail('file', 'a JSON object');
  const rig: DrawnRig = {
    name: text(root, 'name', 'rig'),
    maps: objects(root, 'wrinkle_maps').map((map, i) => readMap(map, `wrinkle_maps[${i}]`)),
    places: [],
    notDrawn: [],
  };
  objects(root, 'regions').forEach((region, i) => {
    const where = `regions[${i}]`;
    const name = text(region, 'name', where);
    const mask = (region.mask ?? {}) as Json;
    const texture = text(mask, 'texture', `${where}.mask`);
    const channel = CHANNELS.indexOf(text(mask, 'channel', `${where}.mask`, 'r'));
    if (channel < 0) fail(`${where}.mask.channel`, 'r, g, b or a');
    if (texture === '' || text(mask, 'kind', `${where}.mask`, 'texture') !== 'texture') {
      rig.notDrawn.push(name);
      return;
    }
    for (const feed of objects(region, 'feeds')) {
      const map = rig.maps.findIndex((each) => each.name === feed.map);
      if (map < 0) fail(`${where}.feeds`, 'the name of a wrinkle map');
      rig.places.push({ weight: `${name}.${String(feed.map)}`, map, mask: texture, channel });
    }
  });
  return rig;
}
