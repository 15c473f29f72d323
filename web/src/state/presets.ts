// SPDX-License-Identifier: Apache-2.0
// Named sets of settings: built-in presets and those that the user saves in this browser. A setting
// that a preset does not name has the daemon's value.
import type { Values } from './settings';

export interface Preset {
  name: string;
  values: Values;
  /** Saved by the user; can be deleted. */
  own: boolean;
}

const SHIPPED: Record<string, Record<string, string>> = {
  'Daemon settings': {},
  'Skin, portrait': { shading: 'skin' },
  'Fast': { shading: 'diffuse', 'shadow.filter': 'off', 'occlusion.method': 'off', 'anti_aliasing.samples': '1' },
  'Wrinkles, exaggerated': { wrinkle_strength: '2.5', 'lights.preset': 'hard' },
  'Thesis (2011)': {
    shading: 'skin', 'lights.preset': 'thesis', 'subsurface.method': 'gaussians',
    'specular.mode': 'gems', 'specular.strength': '0.18', 'occlusion.method': 'ssao', tone_map: 'clip',
  },
};

const KEY = 'furrow.presets';

export function shippedPresets(): Preset[] {
  return Object.entries(SHIPPED).map(([name, values]) => ({
    name,
    values: new Map(Object.entries(values)),
    own: false,
  }));
}

/** The part of Storage that presets need. Without storage, presets last until the page is closed. */
export interface Store {
  getItem(key: string): string | null;
  setItem(key: string, value: string): void;
}

export class PresetShelf {
  private saved: Preset[];

  constructor(private readonly store: Store | null) {
    this.saved = this.load();
  }

  all(): Preset[] {
    return [...shippedPresets(), ...this.saved];
  }

  /** Replaces a preset of the same name. Returns false if the name is empty or built-in. */
  save(name: string, values: Values): boolean {
    if (name === '' || name in SHIPPED) return false;
    this.saved = [...this.saved.filter((p) => p.name !== name), { name, values, own: true }];
    this.write();
    return true;
  }

  delete(name: string): void {
    this.saved = this.saved.filter((preset) => preset.name !== name);
    this.write();
  }

  private load(): Preset[] {
    try {
      const parsed = JSON.parse(this.store?.getItem(KEY) ?? '{}') as Record<string, object>;
      return Object.entries(parsed).map(([name, values]) => ({
        name,
        values: new Map(Object.entries(values).map(([k, v]) => [k, String(v)])),
        own: true,
      }));
    } catch {
      return [];
    }
  }

  private write(): void {
    const plain = this.saved.map(({ name, values }) => [name, Object.fromEntries(values)]);
    try {
      this.store?.setItem(KEY, JSON.stringify(Object.fromEntries(plain)));
    } catch {
      // The storage is full or forbidden. The preset lasts until the page is closed.
    }
  }
}
