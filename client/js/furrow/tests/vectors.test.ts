// SPDX-License-Identifier: Apache-2.0
// Every committed vector (protocol/vectors) is read as its JSON says, refused where it should be, and survives damage.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { Datagrams, splitMessage } from '../src/wire/datagrams.js';
import { readMessage } from '../src/wire/envelope.js';
import { Malformed } from '../src/wire/flat_table.js';
import { readPose, readSkeleton } from '../src/wire/poses.js';
import { readDropped, readError, readGoodbye, readPicture, readPong, readReply, readWeights, readWelcome } from '../src/wire/replies.js';
import type { Timecode } from '../src/wire/timecode.js';

const FOLDER = join(process.env.FURROW_SOURCE!, 'protocol/vectors');
const hex = (value: bigint): string => `0x${value.toString(16).padStart(16, '0')}`;
const triples = (values: Float32Array, n: number): number[][] =>
  Array.from({ length: values.length / n }, (_, i) => [...values.subarray(n * i, n * i + n)]);

/** Undefined, as the member of the JSON, if there is none. */
const timecodeJson = (timecode: Timecode | null): unknown => timecode === null ? undefined : {
  text: timecode.text, frame: timecode.frame, rate_numerator: timecode.rateNumerator, rate_denominator: timecode.rateDenominator,
  subframe: timecode.subframe, drop_frame: timecode.dropFrame,
};

/** Readers that return the objects of the JSON files. Kinds that only a daemon receives are missing. */
const READERS: Record<string, (payload: Uint8Array) => unknown> = {
  FWEL: (p) => {
    const { server, token, others } = readWelcome(p);
    return { server, token: hex(token), ...(others.length > 0 && { others }) };
  },
  FPON: (p) => {
    const { timeUs, serverTimeUs } = readPong(p);
    return { time_us: timeUs, server_time_us: serverTimeUs };
  },
  FBYE: (p) => ({ reason: readGoodbye(p) }),
  FERR: (p) => {
    const { code, message, elsewhere } = readError(p);
    if (elsewhere === null) return { code, message };
    const { host, tcp, udp, web, isWebTls } = elsewhere;
    return { code, message, host, tcp, udp, ...(web !== 0 && { web, web_tls: isWebTls }) };
  },
  FWGT: (p) => {
    const { namesHash, ageUs, values, timecode } = readWeights(p);
    return { names_hash: hex(namesHash), age_us: ageUs, values: [...values], timecode: timecodeJson(timecode) };
  },
  FSUR: (p) => {
    const { subject, namesHash, names, publisherSession, epoch } = readReply(p);
    return { subject, names_hash: hex(namesHash), names, publisher_session: hex(publisherSession), ...(epoch !== 0n && { epoch: hex(epoch) }) };
  },
  FDRP: (p) => ({ frames: readDropped(p) }),
  FIMG: (p) => {
    const m = readPicture(p);
    return {
      width: m.width, height: m.height, format: m.mimeType === 'image/png' ? 1 : 0, age_us: m.ageUs, bytes: [...m.bytes],
      number: m.number, tier: m.tier, still: m.still, dropped: m.dropped, received_us: m.receivedUs, view_request: m.viewRequest,
      codec: m.codec, key: m.key, drawn_percent: m.drawnPercent,
    };
  },
  FSKO: (p) => {
    const s = readSkeleton(p);
    return {
      subject: s.subject, skeleton_hash: hex(s.hash), metres_per_unit: s.metresPerUnit, blend_shape_names: s.blendShapeNames,
      joints: s.names.map((name, i) => ({
        name, parent: s.parents[i], rest_translation: [...s.restTranslations.subarray(3 * i, 3 * i + 3)],
        rest_rotation: [...s.restRotations.subarray(4 * i, 4 * i + 4)], rest_scale: [...s.restScales.subarray(3 * i, 3 * i + 3)],
      })),
    };
  },
  FPOS: (p) => {
    const m = readPose(p);
    return {
      skeleton_hash: hex(m.skeletonHash), partial: m.partial, num_joints: m.numJoints, num_blend_shapes: m.numBlendShapes,
      rotation_joints: [...m.rotationJoints], rotations: triples(m.rotations, 4),
      translation_joints: [...m.translationJoints], translations: triples(m.translations, 3),
      scale_joints: [...m.scaleJoints], scales: triples(m.scales, 3),
      blend_shape_indices: [...m.blendShapeIndices], blend_shapes: [...m.blendShapes],
      timecode: timecodeJson(m.timecode),
    };
  },
};

/** Compares what the reader returns; the JSON may say more. Numbers are floats with nine digits. */
function expectEqual(actual: unknown, expected: unknown, where: string): void {
  if (typeof actual === 'number') {
    assert(Math.abs(actual - (expected as number)) <= 1e-6 * Math.max(1, Math.abs(actual)), `${where}: ${actual}, not ${expected}`);
  } else if (Array.isArray(actual)) {
    assert.equal(actual.length, (expected as unknown[]).length, where);
    actual.forEach((value, i) => expectEqual(value, (expected as unknown[])[i], `${where}[${i}]`));
  } else if (typeof actual === 'object' && actual !== null) {
    for (const [key, value] of Object.entries(actual)) {
      expectEqual(value, (expected as Record<string, unknown>)[key], `${where}.${key}`);
    }
  } else {
    assert.equal(actual, expected, where);
  }
}

interface Vector {
  container: 'message' | 'refuse' | 'datagrams' | 'bundle';
  session: string;
  stream: number;
  sequence: number;
  capture_time_us: number;
  message: unknown;
  messages: Vector[];
}

function load(name: string): { bytes: Uint8Array; expected: Vector } {
  return {
    bytes: new Uint8Array(readFileSync(join(FOLDER, `${name}.bin`))),
    expected: JSON.parse(readFileSync(join(FOLDER, `${name}.json`), 'utf8')) as Vector,
  };
}

const NAMES = readdirSync(FOLDER).filter((file) => file.endsWith('.bin')).map((file) => file.slice(0, -4));

/** Returns false for a kind that a client never reads. */
function check(bytes: Uint8Array, expected: Vector, where: string): boolean {
  const message = readMessage(bytes);
  expectEqual({ session: hex(message.session), stream: message.stream, sequence: message.sequence, capture_time_us: Number(message.captureTimeUs) },
    expected, where);
  const read = READERS[message.identifier];
  if (read === undefined) return false;
  expectEqual(read(message.payload), expected.message, where);
  return true;
}

/** The datagrams of a vector: each follows its length (u32), as on TCP. */
function datagramsOf(bytes: Uint8Array): Uint8Array[] {
  const datagrams: Uint8Array[] = [];
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  for (let at = 0; at < bytes.length;) {
    const size = view.getUint32(at, true);
    datagrams.push(bytes.slice(at + 4, at + 4 + size));
    at += 4 + size;
  }
  return datagrams;
}

test('messages are read as their JSON says', () => {
  let read = 0;
  for (const name of NAMES) {
    const { bytes, expected } = load(name);
    if (expected.container === 'message' && check(bytes, expected, name)) ++read;
  }
  assert(read >= 20, `only ${read} vectors`);
});

test('fragments in any order become their message, and are those that we would send', () => {
  const { bytes, expected } = load('fragments');
  const datagrams = datagramsOf(bytes);
  assert(datagrams.length > 2);
  for (const order of [datagrams, [...datagrams].reverse()]) {
    const receiver = new Datagrams();
    const messages = order.flatMap((datagram) => receiver.accept(datagram, 0));
    assert.equal(messages.length, 1);
    assert(check(messages[0]!, expected, 'fragments'));
    const id = new DataView(datagrams[0]!.buffer).getUint32(32, true);
    const index = (datagram: Uint8Array): number => new DataView(datagram.buffer).getUint16(36, true);
    assert.deepEqual(splitMessage(messages[0]!, id), [...datagrams].sort((a, b) => index(a) - index(b)));
  }
  const receiver = new Datagrams();
  assert.deepEqual(datagrams.flatMap((datagram, i) => receiver.accept(datagram, 2000 * i)), [], 'late fragments');
});

test('a bundle becomes its messages', () => {
  const { bytes, expected } = load('bundle');
  const messages = new Datagrams().accept(bytes, 0);
  assert.equal(messages.length, expected.messages.length);
  messages.forEach((message, i) => assert(check(message, expected.messages[i]!, `bundle ${i}`)));
});

test('vectors that must be refused are malformed', () => {
  let refused = 0;
  for (const name of NAMES) {
    const { bytes, expected } = load(name);
    if (expected.container !== 'refuse') continue;
    ++refused;
    assert.throws(() => {
      for (const message of new Datagrams().accept(bytes, 0)) {
        const { identifier, payload } = readMessage(message);
        READERS[identifier]!(payload);
      }
    }, Malformed, name);
  }
  assert(refused >= 14);
});

/** Numbers from a seed, so that a failure repeats (xorshift, Marsaglia 2003). */
function random(seed: number): () => number {
  let x = seed;
  return () => {
    x ^= x << 13;
    x ^= x >>> 17;
    x ^= x << 5;
    return (x >>> 0) / 2 ** 32;
  };
}

test('damaged payloads are read or malformed, and nothing else', () => {
  const next = random(7);
  for (const name of NAMES) {
    const { bytes, expected } = load(name);
    if (expected.container !== 'message') continue;
    const read = READERS[readMessage(bytes).identifier];
    if (read === undefined) continue;
    const attempt = (payload: Uint8Array, what: string): void => {
      try {
        read(payload);
      } catch (error) {
        assert(error instanceof Malformed, `${name}, ${what}: ${String(error)}`);
      }
    };
    const payload = bytes.slice(32);
    for (let length = 8; length < payload.length; ++length) attempt(payload.slice(0, length), `${length} bytes`);
    for (let round = 0; round < 2000; ++round) {
      const damaged = payload.slice();
      for (let i = 0; i < 3; ++i) damaged[Math.floor(next() * damaged.length)] = Math.floor(next() * 256);
      attempt(damaged, `round ${round}`);
    }
  }
});
