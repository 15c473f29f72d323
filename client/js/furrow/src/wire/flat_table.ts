// SPDX-License-Identifier: Apache-2.0
// Reads FlatBuffers tables with a check before every access. The readers that flatc generates for TypeScript check
// nothing, and a length that lies would make a loop run for minutes.

/** Why a message is dropped. */
export class Malformed extends Error {}

export function require(condition: boolean, why: string): asserts condition {
  if (!condition) throw new Malformed(why);
}

/** Elements of a vector: `count` of them from byte `start` of the payload. */
export interface Elements {
  start: number;
  count: number;
}

export const MAX_NAME_BYTES = 255;

const UTF8 = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true });
const CONTROL = /[\u0000-\u001f\u007f]/;

/** A table of a message's payload. Slots are the field ids in protocol/STANDARD.md. */
export class FlatTable {
  readonly view: DataView;
  private readonly table: number;
  private readonly vtable: number;
  private readonly numSlots: number;

  /** The root table. `payload` may lie at any alignment. */
  constructor(readonly payload: Uint8Array) {
    this.view = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
    this.table = this.uint32(0);
    this.check(this.table, 4, 'the root table');
    this.vtable = this.table - this.view.getInt32(this.table, true);
    this.check(this.vtable, 4, 'a vtable');
    const bytes = this.view.getUint16(this.vtable, true);
    require(bytes >= 4 && bytes % 2 === 0, 'length of a vtable');
    this.check(this.vtable, bytes, 'a vtable');
    this.numSlots = (bytes - 4) / 2;
  }

  private check(start: number, bytes: number, what: string): void {
    require(start >= 0 && start + bytes <= this.payload.length, `${what} outside the message`);
  }

  private uint32(at: number): number {
    this.check(at, 4, 'an offset');
    return this.view.getUint32(at, true);
  }

  /** The place of a field of `bytes` bytes, or 0 if it is absent. */
  private field(slot: number, bytes: number): number {
    if (slot >= this.numSlots) return 0;
    const offset = this.view.getUint16(this.vtable + 4 + 2 * slot, true);
    if (offset === 0) return 0;
    this.check(this.table + offset, bytes, 'a field');
    return this.table + offset;
  }

  /** The place of a struct of `bytes` bytes, or 0 if it is absent. */
  struct(slot: number, bytes: number): number {
    return this.field(slot, bytes);
  }

  u8(slot: number, absent = 0): number {
    const at = this.field(slot, 1);
    return at === 0 ? absent : this.view.getUint8(at);
  }

  flag(slot: number): boolean {
    const value = this.u8(slot);
    require(value <= 1, 'a boolean that is neither true nor false');
    return value === 1;
  }

  u16(slot: number): number {
    const at = this.field(slot, 2);
    return at === 0 ? 0 : this.view.getUint16(at, true);
  }

  u32(slot: number): number {
    const at = this.field(slot, 4);
    return at === 0 ? 0 : this.view.getUint32(at, true);
  }

  u64(slot: number): bigint {
    const at = this.field(slot, 8);
    return at === 0 ? 0n : this.view.getBigUint64(at, true);
  }

  i64(slot: number): bigint {
    const at = this.field(slot, 8);
    return at === 0 ? 0n : this.view.getBigInt64(at, true);
  }

  /** A finite number of a magnitude that the protocol permits. */
  f32(slot: number, otherwise = 0): number {
    const at = this.field(slot, 4);
    return at === 0 ? otherwise : this.number(at);
  }

  number(at: number): number {
    const value = this.view.getFloat32(at, true);
    require(Math.abs(value) <= 1e6, 'a number that is not finite or too large');
    return value;
  }

  /** A vector of elements of `size` bytes; null if the field is absent. */
  vector(slot: number, size: number, most: number): Elements | null {
    const at = this.field(slot, 4);
    return at === 0 ? null : this.vectorAt(at, size, most);
  }

  private vectorAt(at: number, size: number, most: number): Elements {
    const start = at + this.uint32(at);
    const count = this.uint32(start);
    require(count <= most, 'too many elements');
    this.check(start + 4, count * size, 'a vector');
    return { start: start + 4, count };
  }

  /** The bytes of a vector, which belong to the message. */
  bytes(slot: number): Uint8Array | null {
    const found = this.vector(slot, 1, this.payload.length);
    return found && this.payload.subarray(found.start, found.start + found.count);
  }

  /** Text without control characters, of at most `most` bytes. Empty if the field is absent. */
  text(slot: number, most = MAX_NAME_BYTES): string {
    const at = this.field(slot, 4);
    return at === 0 ? '' : this.textAt(at, most);
  }

  private textAt(at: number, most: number): string {
    const { start, count } = this.vectorAt(at, 1, most);
    let text: string;
    try {
      text = UTF8.decode(this.payload.subarray(start, start + count));
    } catch {
      throw new Malformed('text that is not UTF-8');
    }
    require(!CONTROL.test(text), 'control characters in a text');
    return text;
  }

  /** Unique names of 1 to 255 bytes. Empty if the field is absent. */
  names(slot: number, most: number): string[] {
    const found = this.vector(slot, 4, most);
    if (found === null) return [];
    const names: string[] = [];
    for (let i = 0; i < found.count; ++i) names.push(this.textAt(found.start + 4 * i, MAX_NAME_BYTES));
    require(names.every((name) => name !== ''), 'an empty name');
    require(new Set(names).size === names.length, 'a name that occurs twice');
    return names;
  }
}
