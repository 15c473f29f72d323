// SPDX-License-Identifier: Apache-2.0
// The page's state in the fragment of its URL, so that a reload or a link restores the page. Settings
// have their own names; everything else has short names.
import type { Camera, Vec3 } from '../view/camera';
import type { DrawnBy } from '../view/draw_choice';
import type { StreamKind } from '../view/video_choice';

export type Wipe = 'none' | 'wrinkles' | 'shading';

export interface PageState {
  subject: string;
  /** The name of a preset, or an explicit camera. Null: the first preset. */
  camera: string | Camera | null;
  settings: Map<string, string>;
  wipe: Wipe;
  /** Views in the debug strip, from top to bottom. */
  strip: string[];
  /** Chosen curves. Empty: the most active ones. */
  curves: string[];
  /** The open tab of the side panel. Empty: the panel is closed. Null: as usual on this screen. */
  panel: string | null;
  drawnBy: DrawnBy;
  stream: StreamKind;
  /** The picture alone. */
  kiosk: boolean;
  /** All subjects as tiles. */
  grid: boolean;
  /** The focus goes to the subject that moves. */
  follows: boolean;
  /** The subject beside the one in focus; empty: none. */
  against: string;
  /** The curves are shown. */
  dock: boolean;
}

const RESERVED = ['subject', 'camera', 'wipe', 'debug', 'curves', 'panel', 'drawn', 'stream', 'kiosk', 'grid', 'follow', 'against', 'dock',
  'moves'] as const; // 'moves': see Elsewhere

function writeCamera(camera: Camera): string {
  const numbers = [...camera.eye, ...camera.target, camera.fovDegrees];
  return [...numbers.map((x) => Number(x.toFixed(4))), camera.follows ? 1 : 0].join(',');
}

function readCamera(text: string): string | Camera | null {
  if (text === '') return null;
  const numbers = text.split(',').map(Number);
  if (numbers.length === 1) return text;
  if (numbers.length !== 8 || !numbers.every(Number.isFinite)) return null;
  const fovDegrees = numbers[6]!;
  if (fovDegrees <= 1 || fovDegrees >= 150) return null;
  return {
    eye: numbers.slice(0, 3) as unknown as Vec3,
    target: numbers.slice(3, 6) as unknown as Vec3,
    fovDegrees,
    follows: numbers[7] === 1,
  };
}

const words = (text: string | null): string[] => (text ? text.split(',').filter(Boolean) : []);

/** The state in a URL: its fragment, which the page keeps up to date, or else its query, which frames of other pages use. */
export function addressOf({ hash, search }: Pick<Location, 'hash' | 'search'>): string {
  if (hash !== '') return hash;
  const parameters = new URLSearchParams(search);
  parameters.delete('token'); // a secret, and no part of the state
  return `#${parameters}`;
}

/** Reads the fragment of a URL. Ignores parts that are not valid. */
export function readAddress(hash: string): PageState {
  const parameters = new URLSearchParams(hash.replace(/^#/, ''));
  const wipe = parameters.get('wipe');
  const drawn = parameters.get('drawn');
  const stream = parameters.get('stream');
  const state: PageState = {
    subject: parameters.get('subject') ?? '',
    camera: readCamera(parameters.get('camera') ?? ''),
    settings: new Map(),
    wipe: wipe === 'wrinkles' || wipe === 'shading' ? wipe : 'none',
    strip: words(parameters.get('debug')),
    curves: words(parameters.get('curves')),
    panel: parameters.get('panel'),
    drawnBy: drawn === 'browser' || drawn === 'daemon' ? drawn : 'auto',
    stream: stream === 'h264' || stream === 'jpeg' ? stream : 'auto',
    kiosk: parameters.get('kiosk') === '1',
    grid: parameters.get('grid') === '1',
    follows: parameters.get('follow') === '1',
    against: parameters.get('against') ?? '',
    dock: parameters.get('dock') !== '0',
  };
  for (const [name, value] of parameters) {
    if (!(RESERVED as readonly string[]).includes(name)) state.settings.set(name, value);
  }
  return state;
}

/** The parts of the address that arrange panels, without those that are about the subject or its picture. */
const LAYOUT: readonly string[] = ['debug', 'curves', 'panel', 'kiosk', 'grid', 'dock'];

export function layoutPairs(state: PageState): [string, string][] {
  return pairsOf(state).filter(([name]) => LAYOUT.includes(name));
}

/** Writes the fragment with its '#'. Keeps it readable, because people share these links. */
export function writeAddress(state: PageState): string {
  const pairs = pairsOf(state);
  const encode = (text: string): string => encodeURIComponent(text).replaceAll('%2C', ',');
  return pairs.length === 0 ? '' : `#${pairs.map(([k, v]) => `${encode(k)}=${encode(v)}`).join('&')}`;
}

function pairsOf(state: PageState): [string, string][] {
  const pairs: [string, string][] = [];
  if (state.subject !== '') pairs.push(['subject', state.subject]);
  if (state.camera !== null) {
    const text = typeof state.camera === 'string' ? state.camera : writeCamera(state.camera);
    pairs.push(['camera', text]);
  }
  if (state.wipe !== 'none') pairs.push(['wipe', state.wipe]);
  if (state.strip.length > 0) pairs.push(['debug', state.strip.join(',')]);
  if (state.curves.length > 0) pairs.push(['curves', state.curves.join(',')]);
  if (state.panel !== null) pairs.push(['panel', state.panel]);
  if (state.drawnBy !== 'auto') pairs.push(['drawn', state.drawnBy]);
  if (state.stream !== 'auto') pairs.push(['stream', state.stream]);
  if (state.kiosk) pairs.push(['kiosk', '1']);
  if (state.grid) pairs.push(['grid', '1']);
  if (state.follows) pairs.push(['follow', '1']);
  if (state.against !== '') pairs.push(['against', state.against]);
  if (!state.dock) pairs.push(['dock', '0']);
  pairs.push(...state.settings);
  return pairs;
}
