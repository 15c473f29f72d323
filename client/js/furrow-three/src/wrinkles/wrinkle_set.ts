// SPDX-License-Identifier: Apache-2.0
// The wrinkle maps of one kind of surface, and the weights that the shader multiplies their masks by.
import { Vector4 } from 'three';
import type { DrawnRig, Surface, WrinkleMap } from '../rig/rig_file.js';

interface Slot {
  /** Index into `weights`, and the component. */
  row: number;
  channel: number;
}

export class WrinkleSet {
  readonly maps: WrinkleMap[];
  /** Names of mask pictures, RGBA: four regions each. */
  readonly masks: string[];
  /** Row `map * masks.length + mask`: the weights of the regions in the four channels of that mask. */
  readonly weights: Vector4[];
  private readonly slots = new Map<string, Slot[]>();

  /** The maps that are drawn on `surface`. */
  constructor(rig: DrawnRig, surface: Exclude<Surface, 'any'>) {
    const drawn = rig.maps.filter((map) => map.surface === 'any' || map.surface === surface);
    const places = rig.places.filter(({ map }) => drawn.includes(rig.maps[map]!));
    this.maps = drawn.filter((map) => places.some((place) => rig.maps[place.map] === map));
    this.masks = [...new Set(places.map(({ mask }) => mask))];
    this.weights = Array.from({ length: this.maps.length * this.masks.length }, () => new Vector4(0, 0, 0, 0)); // three starts with w = 1
    for (const { weight, map, mask, channel } of places) {
      const row = this.maps.indexOf(rig.maps[map]!) * this.masks.length + this.masks.indexOf(mask);
      this.slots.set(weight, [...(this.slots.get(weight) ?? []), { row, channel }]);
    }
  }

  get weightNames(): string[] {
    return [...this.slots.keys()];
  }

  /** Names that are not of this set are ignored; weights that are not named are 0. */
  setWeights(names: readonly string[], values: ArrayLike<number>): void {
    for (const row of this.weights) row.set(0, 0, 0, 0);
    names.forEach((name, i) => {
      for (const { row, channel } of this.slots.get(name) ?? []) {
        const weights = this.weights[row]!;
        weights.setComponent(channel, weights.getComponent(channel) + (values[i] ?? 0));
      }
    });
  }
}
