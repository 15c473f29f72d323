// SPDX-License-Identifier: Apache-2.0
// Writes MCAP files (mcap.dev/spec) in memory: messages without chunks, and no summary. The specification makes both optional.

const MAGIC = Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a);
/** Opcode and length. */
const RECORD_HEAD_BYTES = 9;
/** Channel, sequence and both times. */
const MESSAGE_HEAD_BYTES = 22;
const OPCODE = { header: 1, footer: 2, schema: 3, channel: 4, message: 5, dataEnd: 15 } as const;

export interface McapMessage {
  sequence: number;
  /** Nanoseconds since 1970. */
  logTimeNs: bigint;
  /** Nanoseconds on the sender's clock, as two's complement. */
  publishTimeNs: bigint;
  data: Uint8Array;
}

/** Little-endian fields of one record. */
class Fields {
  private readonly parts: Uint8Array[] = [];
  private numBytes = 0;

  bytes(data: Uint8Array): this {
    this.parts.push(data);
    this.numBytes += data.length;
    return this;
  }
  u16(value: number): this {
    return this.number(2, (view) => view.setUint16(0, value, true));
  }
  u32(value: number): this {
    return this.number(4, (view) => view.setUint32(0, value, true));
  }
  u64(value: bigint): this {
    return this.number(8, (view) => view.setBigUint64(0, BigInt.asUintN(64, value), true));
  }
  /** With its length in front. */
  block(data: Uint8Array): this {
    return this.u32(data.length).bytes(data);
  }
  text(words: string): this {
    return this.block(new TextEncoder().encode(words));
  }
  map(values: Record<string, string>): this {
    const pairs = new Fields();
    for (const [name, value] of Object.entries(values)) pairs.text(name).text(value);
    this.u32(pairs.numBytes);
    for (const part of pairs.parts) this.bytes(part);
    return this;
  }
  record(opcode: number): Uint8Array[] {
    const head = new DataView(new ArrayBuffer(RECORD_HEAD_BYTES));
    head.setUint8(0, opcode);
    head.setBigUint64(1, BigInt(this.numBytes), true);
    return [new Uint8Array(head.buffer), ...this.parts];
  }
  private number(numBytes: number, write: (view: DataView) => void): this {
    const view = new DataView(new ArrayBuffer(numBytes));
    write(view);
    return this.bytes(new Uint8Array(view.buffer));
  }
}

export class McapWriter {
  private readonly parts: Uint8Array[] = [MAGIC];
  private numSchemas = 0;
  private numChannels = 0;

  constructor(profile: string, library: string) {
    this.add(OPCODE.header, new Fields().text(profile).text(library));
  }

  /** `data`: the binary schema of FlatBuffers (.bfbs). Returns the id, from 1. */
  addSchema(name: string, data: Uint8Array): number {
    this.add(OPCODE.schema, new Fields().u16(++this.numSchemas).text(name).text('flatbuffer').block(data));
    return this.numSchemas;
  }

  /** Returns the id, from 1. */
  addChannel(topic: string, schema: number, metadata: Record<string, string>): number {
    this.add(OPCODE.channel, new Fields().u16(++this.numChannels).u16(schema).text(topic).text('flatbuffer').map(metadata));
    return this.numChannels;
  }

  /** Keeps a reference to the data. */
  addMessage(channel: number, message: McapMessage): void {
    // One buffer per message, because a take has tens of thousands.
    const head = new DataView(new ArrayBuffer(RECORD_HEAD_BYTES + MESSAGE_HEAD_BYTES));
    head.setUint8(0, OPCODE.message);
    head.setBigUint64(1, BigInt(MESSAGE_HEAD_BYTES + message.data.length), true);
    head.setUint16(9, channel, true);
    head.setUint32(11, message.sequence, true);
    head.setBigUint64(15, message.logTimeNs, true);
    head.setBigInt64(23, message.publishTimeNs, true);
    this.parts.push(new Uint8Array(head.buffer), message.data);
  }

  /** The parts of the whole file. Nothing can be added afterwards. */
  finish(): Uint8Array[] {
    this.add(OPCODE.dataEnd, new Fields().u32(0)); // 0: no checksum
    this.add(OPCODE.footer, new Fields().u64(0n).u64(0n).u32(0)); // 0: no summary
    this.parts.push(MAGIC);
    return this.parts;
  }

  private add(opcode: number, fields: Fields): void {
    this.parts.push(...fields.record(opcode));
  }
}
