// SPDX-License-Identifier: Apache-2.0
// What stands below the picture of a page: what a bug report needs and the page does not show, or not at every size. Pure.
import { text } from '../text';

const t = text.screenshot;
const MOST_WEIGHTS = 10;

export interface PageFacts {
  date: Date;
  /** Host and port of the daemon. */
  host: string;
  /** Of the daemon; empty: unknown. */
  version: string;
  userAgent: string;
  width: number;
  height: number;
  density: number;
  condition: string;
  /** What the bar at the top says of the picture, as name and words. */
  figures: readonly (readonly [string, string])[];
  /** The pose on the screen; null: there is none. */
  sequence: number | null;
  /** Of that pose; empty: its source sends none. */
  timecode: string;
  weights: readonly (readonly [string, number])[];
  /** The fragment of the page's address. It restores subject, camera and settings. */
  fragment: string;
}

/** "2026-11-29 14:30:15 +01:00": the local time, and how it differs from UTC. */
export function timeWords(date: Date, offsetMinutes = -date.getTimezoneOffset()): string {
  const local = new Date(date.getTime() + 60_000 * offsetMinutes).toISOString();
  const two = (n: number): string => String(Math.floor(n)).padStart(2, '0');
  const away = Math.abs(offsetMinutes);
  return `${local.slice(0, 10)} ${local.slice(11, 19)} ${offsetMinutes < 0 ? '-' : '+'}${two(away / 60)}:${two(away % 60)}`;
}

/** "Firefox 145"; empty: unknown. */
export function browserWords(userAgent: string): string {
  const found = /\b(Edg|OPR|Firefox|Chrome|Version)\/(\d+)/g;
  const names: Record<string, string> = { Edg: 'Edge', OPR: 'Opera', Version: 'Safari' };
  // Browsers name those that they resemble first, except Safari, which is the only one with "Version" alone.
  const last = [...userAgent.matchAll(found)].at(-1);
  return last === undefined ? '' : `${names[last[1]!] ?? last[1]} ${last[2]}`;
}

function plain(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

export function captionLines(facts: PageFacts): string[] {
  const { date, host, version, userAgent, width, height, density, condition, figures, sequence, timecode, weights, fragment } = facts;
  const largest = [...weights].sort(([, a], [, b]) => b - a).slice(0, MOST_WEIGHTS).filter(([, value]) => value >= 0.005);
  return [
    [timeWords(date), t.daemon(version, host), browserWords(userAgent), t.screen(width, height, density)],
    [condition, ...figures.map(([name, words]) => `${name} ${words}`), sequence === null ? '' : t.pose(sequence),
      timecode === '' ? '' : t.timecode(timecode)],
    [largest.length === 0 ? '' : t.weights(largest.map(([name, value]) => `${name} ${value.toFixed(2)}`).join(', '))],
    [fragment === '' ? t.noSettings : t.settings(fragment.split('&').map(plain).join('  '))],
  ].map((parts) => parts.filter((part) => part !== '').join(t.between)).filter((line) => line !== '');
}
