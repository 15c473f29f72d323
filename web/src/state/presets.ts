// SPDX-License-Identifier: Apache-2.0
// Named sets of values: built-in ones and those that the user saves in this browser. Presets are sets of settings; a
// setting that a preset does not name has the daemon's value. Layouts are sets of parts of an address.
import type { Values } from './settings';

export interface Preset {
  name: string;
  values: Values;
  /** Saved by the user; can be deleted. */
  own: boolean;
}

type Shipped = Readonly<Record<string, Readonly<Record<string, string>>>>;

const PRESETS: Shipped = {
  'Daemon settings': {},
  'Skin, portrait': { shading: 'skin' },
  'Fast': { shading: 'diffuse', 'shadow.filter': 'off', 'occlusion.method': 'off', 'anti_aliasing.samples': '1' },
  'Wrinkles, exaggerated': { wrinkle_strength: '2.5', 'lights.preset': 'hard' },
  'Thesis (2011)': {
    shading: 'skin', 'lights.preset': 'thesis', 'subsurface.method': 'gaussians',
    'specular.mode': 'gems', 'specular.strength': '0.18', 'occlusion.method': 'ssao', tone_map: 'clip',
  },
};

/** What is open on the page. A part that a layout does not name is as usual. */
const LAYOUTS: Shipped = {
  'Usual': {},
  'Picture only': { panel: '', dock: '0' },
  'All subjects': { panel: '', dock: '0', grid: '1' },
  'Wrinkles': { panel: 'wrinkles', debug: 'weights,normal' },
  'Stage monitor': { kiosk: '1' },
};

/** The part of Storage that presets need. Without storage, presets last until the page is closed. */
export interface Store {
  getItem(key: string): string | null;
  setItem(key: string, value: string): void;
}

/** Null if the browser forbids storage. */
export function browserStore(): Store | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}

const isPlain = (value: unknown): value is object => typeof value === 'object' && value !== null && !Array.isArray(value);
const entriesOf = (value: unknown): [string, unknown][] => (isPlain(value) ? Object.entries(value) : []);

export class PresetShelf {
  private saved: Preset[] = [];

  /** Without storage, what is saved lasts until the page is closed. */
  private constructor(private store: Store | null, private readonly key: string, private readonly shipped: Shipped) {
  }

  static presets(store: Store | null): PresetShelf {
    return new PresetShelf(store, 'furrow.presets', PRESETS);
  }

  static layouts(store: Store | null): PresetShelf {
    return new PresetShelf(store, 'furrow.layouts', LAYOUTS);
  }

  all(): Preset[] {
    this.saved = this.load();
    const built = Object.entries(this.shipped).map(([name, values]) => ({ name, values: new Map(Object.entries(values)), own: false }));
    return [...built, ...this.saved];
  }

  /** Replaces a preset of the same name. Returns false if the name is empty or built-in. */
  save(name: string, values: Values): boolean {
    if (name === '' || Object.hasOwn(this.shipped, name)) return false;
    this.saved = [...this.load().filter((p) => p.name !== name), { name, values, own: true }];
    this.write();
    return true;
  }

  delete(name: string): void {
    this.saved = this.load().filter((preset) => preset.name !== name);
    this.write();
  }

  /** Read each time, because other tabs save, too. Entries that are no sets of values are left out. */
  private load(): Preset[] {
    if (this.store === null) return this.saved;
    try {
      const parsed: unknown = JSON.parse(this.store.getItem(this.key) ?? '{}');
      return entriesOf(parsed).filter(([, values]) => isPlain(values)).map(([name, values]) => ({
        name,
        values: new Map(entriesOf(values).map(([k, v]) => [k, String(v)])),
        own: true,
      }));
    } catch {
      return [];
    }
  }

  private write(): void {
    const plain = this.saved.map(({ name, values }) => [name, Object.fromEntries(values)]);
    try {
      this.store?.setItem(this.key, JSON.stringify(Object.fromEntries(plain)));
    } catch {
      this.store = null; // it is full or forbidden, so what is saved lasts until the page is closed
    }
  }
}
