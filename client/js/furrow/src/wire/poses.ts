// SPDX-License-Identifier: Apache-2.0
// Skeletons and poses (protocol/STANDARD.md sections 5 to 7). Every reader throws Malformed.
import { type Elements, FlatTable, require } from './flat_table.js';
import { Fnv64 } from './hash.js';
import { readTimecode, type Timecode } from './timecode.js';

const MAX_JOINTS = 1024;
const MAX_BLEND_SHAPES = 512;

/** The joints and blend shapes of a stream. Joint `i` has 4 numbers at 4 i of rotations, 3 at 3 i of the others. */
export interface Skeleton {
  subject: string;
  /** Equal skeletons have equal hashes, in all programs. */
  hash: bigint;
  metresPerUnit: number;
  names: string[];
  /** Index of an earlier joint, or -1. */
  parents: Int16Array;
  /** Local rest pose, in units of the stream. Quaternions are x, y, z, w. */
  restTranslations: Float32Array;
  restRotations: Float32Array;
  restScales: Float32Array;
  blendShapeNames: string[];
}

/** A pose as it travels: `joints` and `indices` say which items have values. */
export interface PoseMessage {
  skeletonHash: bigint;
  numJoints: number;
  numBlendShapes: number;
  /** True: items without values stay as they were; false: they rest. */
  partial: boolean;
  rotationJoints: Uint16Array;
  rotations: Float32Array;
  translationJoints: Uint16Array;
  /** Offsets from the rest translations. */
  translations: Float32Array;
  scaleJoints: Uint16Array;
  scales: Float32Array;
  blendShapeIndices: Uint16Array;
  blendShapes: Float32Array;
  /** Null: the source sends none. */
  timecode: Timecode | null;
}

const NONE: Elements = { start: 0, count: 0 };

/** The items that have values. Without a mask, all have one or none has. */
function readMask(mask: Uint8Array | null, numItems: number, numValues: number): Uint16Array {
  if (mask === null) {
    require(numValues === 0 || numValues === numItems, 'a mask is missing');
    return Uint16Array.from({ length: numValues }, (_, i) => i);
  }
  require(mask.length === Math.ceil(numItems / 8), 'length of a mask');
  const items: number[] = [];
  for (let i = 0; i < 8 * mask.length; ++i) {
    if ((mask[i >> 3]! >> (i & 7)) & 1) items.push(i);
  }
  require(items.length === 0 || items[items.length - 1]! < numItems, 'mask bits beyond the last item');
  require(items.length === numValues, 'numbers of bits and values differ');
  return Uint16Array.from(items);
}

function readNumbers(table: FlatTable, from: Elements, perElement: number): Float32Array {
  const values = new Float32Array(from.count * perElement);
  for (let i = 0; i < values.length; ++i) values[i] = table.number(from.start + 4 * i);
  return values;
}

function readRotations(table: FlatTable, from: Elements): Float32Array {
  const values = readNumbers(table, from, 4);
  for (let i = 0; i < values.length; i += 4) {
    const length = Math.hypot(values[i]!, values[i + 1]!, values[i + 2]!, values[i + 3]!);
    require(Math.abs(length - 1) <= 1e-3, 'a rotation that is not of unit length');
  }
  return values;
}

function readPackedRotations(table: FlatTable, from: Elements): Float32Array {
  const values = new Float32Array(from.count * 4);
  const codes = [0, 0, 0];
  for (let i = 0; i < from.count; ++i) {
    const low = table.view.getUint16(from.start + 6 * i, true);
    const middle = table.view.getUint16(from.start + 6 * i + 2, true);
    const high = table.view.getUint16(from.start + 6 * i + 4, true);
    require(high < 0x8000, 'bit 47 of a packed rotation');
    codes[0] = low & 0x7fff;
    codes[1] = (low >> 15) | ((middle & 0x3fff) << 1);
    codes[2] = (middle >> 14) | ((high & 0x1fff) << 2);
    let rest = 1;
    let at = 4 * i;
    for (let component = 0, next = 0; component < 4; ++component, ++at) {
      if (component === high >> 13) continue;
      const code = codes[next++]!;
      require(code <= 32766, '32767 in a packed rotation');
      values[at] = ((code / 32766) * 2 - 1) * Math.SQRT1_2;
      rest -= values[at]! * values[at]!;
    }
    require(rest >= -1e-6, 'a packed rotation longer than 1');
    values[4 * i + (high >> 13)] = Math.sqrt(Math.max(0, rest));
  }
  return values;
}

function readPacked(table: FlatTable, from: Elements, perElement: number, scale: number): Float32Array {
  const values = new Float32Array(from.count * perElement);
  for (let i = 0; i < values.length; ++i) {
    const packed = table.view.getInt16(from.start + 2 * i, true);
    require(packed !== -32768, '-32768 in packed numbers');
    values[i] = packed * scale;
  }
  return values;
}

function oneForm(plain: Elements | null, packed: Elements | null): number {
  require(plain === null || packed === null, 'both forms of one field');
  return (plain ?? packed ?? NONE).count;
}

export function readPose(payload: Uint8Array): PoseMessage {
  const table = new FlatTable(payload);
  const numJoints = table.u16(1);
  const numBlendShapes = table.u16(2);
  require(numJoints <= MAX_JOINTS && numBlendShapes <= MAX_BLEND_SHAPES, 'too many joints or blend shapes');
  const rotations = table.vector(5, 16, MAX_JOINTS);
  const packedRotations = table.vector(6, 6, MAX_JOINTS);
  const translations = table.vector(8, 12, MAX_JOINTS);
  const packedTranslations = table.vector(9, 6, MAX_JOINTS);
  const range = table.f32(10);
  require(range >= 0, 'a range below 0');
  const scales = table.vector(12, 12, MAX_JOINTS) ?? NONE;
  const shapes = table.vector(14, 4, MAX_BLEND_SHAPES);
  const packedShapes = table.vector(15, 2, MAX_BLEND_SHAPES);
  return {
    skeletonHash: table.u64(0),
    numJoints,
    numBlendShapes,
    partial: table.flag(3),
    rotationJoints: readMask(table.bytes(4), numJoints, oneForm(rotations, packedRotations)),
    rotations: packedRotations ? readPackedRotations(table, packedRotations) : readRotations(table, rotations ?? NONE),
    translationJoints: readMask(table.bytes(7), numJoints, oneForm(translations, packedTranslations)),
    translations: packedTranslations ? readPacked(table, packedTranslations, 3, range / 32767)
      : readNumbers(table, translations ?? NONE, 3),
    scaleJoints: readMask(table.bytes(11), numJoints, scales.count),
    scales: readNumbers(table, scales, 3),
    blendShapeIndices: readMask(table.bytes(13), numBlendShapes, oneForm(shapes, packedShapes)),
    blendShapes: packedShapes ? readPacked(table, packedShapes, 1, 1 / 16384) : readNumbers(table, shapes ?? NONE, 1),
    timecode: readTimecode(table, 18),
  };
}

export function readSkeleton(payload: Uint8Array): Skeleton {
  const table = new FlatTable(payload);
  const subject = table.text(0);
  require(subject !== '', 'a skeleton without a subject');
  const names = table.names(3, MAX_JOINTS);
  const blendShapeNames = table.names(10, MAX_BLEND_SHAPES);
  require(names.length + blendShapeNames.length > 0, 'neither joints nor blend shapes');
  const parents = table.vector(4, 2, MAX_JOINTS) ?? NONE;
  const translations = table.vector(5, 12, MAX_JOINTS) ?? NONE;
  const rotations = table.vector(6, 16, MAX_JOINTS) ?? NONE;
  const scales = table.vector(7, 12, MAX_JOINTS);
  const tails = table.vector(9, 12, MAX_JOINTS) ?? NONE;
  require([parents, translations, rotations, scales ?? parents].every(({ count }) => count === names.length),
    'vectors of different lengths');
  const tailJoints = tails.count > 0 ? readMask(table.bytes(8), names.length, tails.count) : new Uint16Array();
  const metresPerUnit = table.f32(2, 1);
  require(metresPerUnit > 0, 'metres_per_unit is not above 0');
  readNumbers(table, tails, 3);
  const skeleton = {
    subject,
    hash: table.u64(1),
    metresPerUnit,
    names,
    parents: Int16Array.from({ length: names.length }, (_, i) => table.view.getInt16(parents.start + 2 * i, true)),
    restTranslations: readNumbers(table, translations, 3),
    restRotations: readRotations(table, rotations),
    restScales: scales ? readNumbers(table, scales, 3) : new Float32Array(3 * names.length).fill(1),
    blendShapeNames,
  };
  require(skeleton.parents.every((parent, i) => parent >= -1 && parent < i), 'a parent that is not an earlier joint');
  require(hashOf(skeleton, tailJoints, readNumbers(table, tails, 3)) === skeleton.hash, 'a wrong skeleton hash');
  return skeleton;
}

/** Section 6. A Float32Array holds the transmitted bits again, because all numbers are finite. */
function hashOf(skeleton: Skeleton, tailJoints: Uint16Array, tails: Float32Array): bigint {
  const hash = new Fnv64();
  const scratch = new DataView(new ArrayBuffer(4));
  const bytes = (count: number): Uint8Array => new Uint8Array(scratch.buffer, 0, count);
  const addInt = (value: number): void => {
    scratch.setInt16(0, value, true);
    hash.add(bytes(2));
  };
  const addFloats = (values: Float32Array): void => {
    for (const value of values) {
      scratch.setFloat32(0, value, true);
      hash.add(bytes(4));
    }
  };
  const tailOf = new Map([...tailJoints].map((joint, i) => [joint, tails.subarray(3 * i, 3 * i + 3)]));
  addInt(skeleton.names.length);
  skeleton.names.forEach((name, i) => {
    hash.addName(name);
    addInt(skeleton.parents[i]!);
    addFloats(skeleton.restTranslations.subarray(3 * i, 3 * i + 3));
    addFloats(skeleton.restRotations.subarray(4 * i, 4 * i + 4));
    addFloats(skeleton.restScales.subarray(3 * i, 3 * i + 3));
    const tail = tailOf.get(i);
    addInt(tail ? 1 : 0);
    if (tail) addFloats(tail);
  });
  addFloats(Float32Array.of(skeleton.metresPerUnit));
  addInt(skeleton.blendShapeNames.length);
  for (const name of skeleton.blendShapeNames) hash.addName(name);
  return hash.value;
}
