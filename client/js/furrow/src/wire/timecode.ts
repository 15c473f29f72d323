// SPDX-License-Identifier: Apache-2.0
// SMPTE timecodes of sources (protocol/STANDARD.md section 5).
import type { FlatTable } from './flat_table.js';

/** The timecode that a source gives to a pose. It labels the pose; times come from the capture time. */
export interface Timecode {
  /** "HH:MM:SS:FF", with ";" before the frames of drop-frame timecode. */
  text: string;
  /** Frames since 00:00:00:00. Drop-frame timecode leaves out numbers, never frames. */
  frame: number;
  /** Frames per second: numerator / denominator. */
  rateNumerator: number;
  rateDenominator: number;
  /** The part of the frame that has passed, in 1/256 of a frame. */
  subframe: number;
  dropFrame: boolean;
}

const BYTES = 12;
const DROP_FRAME = 1;
const MAX_RATE = 240;

/** Null if the field is absent or the timecode is invalid: the message is used without it. */
export function readTimecode(table: FlatTable, slot: number): Timecode | null {
  const at = table.struct(slot, BYTES);
  if (at === 0) return null;
  const { view } = table;
  const fields = {
    frame: view.getUint32(at, true),
    rateNumerator: view.getUint32(at + 4, true),
    rateDenominator: view.getUint16(at + 8, true),
    subframe: view.getUint8(at + 10),
    dropFrame: (view.getUint8(at + 11) & DROP_FRAME) !== 0,
  };
  const text = textOf(fields);
  return text === '' ? null : { text, ...fields };
}

/** Empty: the timecode is invalid. */
function textOf({ frame, rateNumerator, rateDenominator, dropFrame }: Omit<Timecode, 'text'>): string {
  if (rateNumerator === 0 || rateDenominator === 0) return '';
  const rate = Math.ceil(rateNumerator / rateDenominator);
  const slower = rate * rateDenominator - rateNumerator;
  if (rate > MAX_RATE || slower * 500 > rate * rateDenominator) return '';
  if (dropFrame && ((rate !== 30 && rate !== 60) || slower === 0)) return '';
  // The first minute of ten has all frame numbers, and each of the other nine lacks some.
  const dropped = dropFrame ? rate / 15 : 0;
  const perMinute = 60 * rate - dropped;
  const perTenMinutes = 10 * perMinute + dropped;
  const tens = Math.floor(frame / perTenMinutes);
  if (tens >= 24 * 6) return '';
  const rest = frame % perTenMinutes;
  const minute = rest < 60 * rate ? 0 : Math.floor((rest - dropped) / perMinute);
  const number = rest + dropped * minute + tens * 600 * rate;
  const seconds = Math.floor(number / rate);
  const two = (value: number, digits = 2): string => String(Math.floor(value)).padStart(digits, '0');
  return `${two(seconds / 3600)}:${two((seconds / 60) % 60)}:${two(seconds % 60)}${dropFrame ? ';' : ':'}${two(number % rate, rate > 100 ? 3 : 2)}`;
}
