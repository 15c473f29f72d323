// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { numMissed, PoseTape, type TapedPose } from '../src/take/pose_tape';
import { takeFile } from '../src/take/take_file';

const SESSION = 2n ** 64n - 1n;
const SKELETON = Uint8Array.of(1, 2, 3);
const SCHEMAS = { skeleton: Uint8Array.of(7), pose: Uint8Array.of(8, 8) };
const pose = (sequence: number, atS = sequence / 10): TapedPose =>
  ({ atS, sequence, captureTimeUs: BigInt(1000 * sequence - 5000), payload: Uint8Array.of(sequence & 255, 9) });

function tapeOf(sequences: readonly number[]): PoseTape {
  const tape = new PoseTape('ada', 0, 1e6);
  tape.addSkeleton(SESSION, SKELETON);
  for (const sequence of sequences) assert(tape.addPose(pose(sequence)));
  return tape;
}

interface Found {
  opcode: number;
  content: DataView;
}

/** The records of a file, read as mcap.dev/spec says. */
function recordsOf(parts: readonly Uint8Array[]): Found[] {
  const bytes = Uint8Array.from(parts.flatMap((part) => [...part]));
  const magic = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
  assert.deepEqual([...bytes.subarray(0, 8)], magic);
  assert.deepEqual([...bytes.subarray(-8)], magic);
  const view = new DataView(bytes.buffer);
  const found: Found[] = [];
  let at = 8;
  while (at < bytes.length - 8) {
    const length = Number(view.getBigUint64(at + 1, true));
    found.push({ opcode: view.getUint8(at), content: new DataView(bytes.buffer, at + 9, length) });
    at += 9 + length;
  }
  assert.equal(at, bytes.length - 8);
  return found;
}

function textAt(content: DataView, at: number): string {
  return new TextDecoder().decode(new Uint8Array(content.buffer, content.byteOffset + at + 4, content.getUint32(at, true)));
}

/** The session in the metadata of a channel, which ends with it. */
function sessionOf({ buffer, byteOffset, byteLength }: DataView): string {
  return /session[^\d]*(\d+)$/s.exec(new TextDecoder().decode(new Uint8Array(buffer as ArrayBuffer, byteOffset, byteLength)))![1]!;
}

test('a take has its skeleton before its poses, with the times and numbers of the wire', () => {
  const records = recordsOf(takeFile('ada', tapeOf([20, 21, 23]).between(-Infinity, Infinity), SCHEMAS, 1_000_000));
  assert.deepEqual(records.map(({ opcode }) => opcode), [1, 3, 3, 4, 4, 5, 5, 5, 5, 15, 2]);
  assert.equal(textAt(records[0]!.content, 0), 'furrow-take');
  assert.equal(textAt(records[1]!.content, 2), 'furrow.protocol.wire.SkeletonOffer');
  assert.equal(textAt(records[3]!.content, 4), '/ada/skeleton');
  assert.equal(textAt(records[4]!.content, 4), '/ada/pose');
  const messages = records.filter(({ opcode }) => opcode === 5).map(({ content }) => ({
    channel: content.getUint16(0, true), sequence: content.getUint32(2, true), logNs: content.getBigUint64(6, true),
    publishNs: content.getBigInt64(14, true), bytes: content.byteLength - 22,
  }));
  assert.deepEqual(messages.map(({ channel }) => channel), [1, 2, 2, 2]);
  assert.deepEqual(messages.map(({ sequence }) => sequence), [20, 20, 21, 23]);
  assert.deepEqual(messages.map(({ bytes }) => bytes), [SKELETON.length, 2, 2, 2]);
  assert.equal(messages[1]!.logNs, 1_002_000_000_000n); // 1000 s and 2 s
  assert.equal(messages[1]!.publishNs, 15_000_000n);
  assert.equal(recordsOf(takeFile('ada', tapeOf([1]).between(0, 1), SCHEMAS, 0))[6]!.content.getBigInt64(14, true), -4_000_000n);
});

test('a span has the poses that arrived in it, and their skeleton', () => {
  const tape = tapeOf([10, 11, 12, 13]);
  tape.addSkeleton(SESSION, Uint8Array.of(4));
  for (const sequence of [14, 15]) tape.addPose(pose(sequence));
  const sequences = (fromS: number, toS: number): number[][] => tape.between(fromS, toS).map(({ poses }) => poses.map((one) => one.sequence));
  assert.deepEqual(tape.range, [1, 1.5]);
  assert.deepEqual(sequences(1.1, 1.2), [[11, 12]]);
  assert.deepEqual(sequences(1.3, 9), [[13], [14, 15]]);
  assert.deepEqual(sequences(2, 3), []);
  assert.deepEqual(tape.between(1.4, 2).map(({ skeleton, session }) => [skeleton[0], session]), [[4, SESSION]]);
});

test('missing poses are counted in the part that is saved', () => {
  const missed = (sequences: readonly number[], fromS = -Infinity, toS = Infinity): number => numMissed(tapeOf(sequences).between(fromS, toS));
  assert.equal(missed([4_294_967_295, 0, 3]), 2); // numbers wrap around
  assert.equal(missed([10, 13, 14, 20]), 7);
  assert.equal(missed([10, 13, 14, 20], 1.3, 1.4), 0);
  assert.equal(missed([5, 900_000]), 0); // a sender that was restarted
});

test('a reel goes on after a reconnect, and another session begins a new one', () => {
  const tape = tapeOf([7, 8]);
  tape.addSkeleton(SESSION, SKELETON.slice());
  tape.addPose(pose(8)); // the newest pose begins every subscription
  tape.addPose(pose(12));
  assert.deepEqual(tape.between(-Infinity, Infinity).map(({ poses }) => poses.map(({ sequence }) => sequence)), [[7, 8, 12]]);
  assert.equal(numMissed(tape.between(-Infinity, Infinity)), 3);
  tape.addSkeleton(1n, SKELETON);
  tape.addPose(pose(40));
  const reels = tape.between(-Infinity, Infinity);
  assert.equal(numMissed(reels), 3);
  const records = recordsOf(takeFile('ada', reels, SCHEMAS, 0));
  assert.deepEqual(records.filter(({ opcode }) => opcode === 4).map(({ content }) => sessionOf(content)), [SESSION, SESSION, 1n, 1n].map(String));
});

test('sessions with several skeletons have one channel for each kind', () => {
  const tape = tapeOf([7]);
  tape.addSkeleton(SESSION, Uint8Array.of(4));
  tape.addPose(pose(8));
  const records = recordsOf(takeFile('ada', tape.between(-Infinity, Infinity), SCHEMAS, 0));
  assert.deepEqual(records.filter(({ opcode }) => opcode === 5).map(({ content }) => content.getUint16(0, true)), [1, 2, 1, 2]);
});

test('capture times beyond the range of nanoseconds are clamped', () => {
  for (const [us, ns] of [[2n ** 63n - 1n, 9_223_372_036_854_775_000n], [-(2n ** 63n), -9_223_372_036_854_775_000n]] as const) {
    const tape = tapeOf([]);
    tape.addPose({ ...pose(1), captureTimeUs: us });
    assert.equal(recordsOf(takeFile('ada', tape.between(0, 1), SCHEMAS, 0))[6]!.content.getBigInt64(14, true), ns);
  }
});

test('the memory of a tape is bounded', () => {
  const small = new PoseTape('ada', 0, 2000);
  assert.equal(small.addPose(pose(1)), true); // left out, because nobody could read it without a skeleton
  assert.equal(small.range, null);
  for (let i = 0; i < 100; ++i) assert(small.addSkeleton(BigInt(i), SKELETON)); // without poses, each replaces the last
  let kept = 0;
  while (small.addPose(pose(kept))) ++kept;
  assert(kept > 0 && small.numBytes <= 2000, `${kept} poses, ${small.numBytes} bytes`);
  assert.equal(small.addPose(pose(kept)), false);
  assert.equal(small.addSkeleton(100n, new Uint8Array(2000)), false);
  assert.equal(small.between(-Infinity, Infinity)[0]!.poses.length, kept);
});
