// SPDX-License-Identifier: Apache-2.0
// The recorder of poses with a fake connection.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Builder, ByteBuffer } from 'flatbuffers';
import { Dropped } from '@wire/dropped';
import { SubscribePoses } from '@wire/subscribe-poses';
import type { Envelope } from 'furrow/protocol';
import { PoseRecorder } from '../src/take/pose_recorder';
import { numMissed, PoseTape } from '../src/take/pose_tape';
import type { Connection } from '../src/wire/connection';

const CONNECTION = { subscribe: () => ({ close: () => {} }) } as unknown as Connection;
const ALL = [-Infinity, Infinity] as const;

function dropped(frames: bigint): Uint8Array {
  const builder = new Builder(32);
  Dropped.finishDroppedBuffer(builder, Dropped.createDropped(builder, frames));
  return builder.asUint8Array();
}

/** A recorder, and what its daemon sends. */
function recording(mostBytes = 1e6) {
  const tape = new PoseTape('ada', 0, mostBytes);
  const ends: string[] = [];
  const recorder = new PoseRecorder(CONNECTION, tape, (refusal) => ends.push(refusal));
  const send = (identifier: string, payload: Uint8Array, sequence = 0): void =>
    recorder.onMessage({ identifier, payload, sequence, captureTimeUs: 0n } as Envelope);
  return {
    tape, ends, recorder, send,
    /** The reply and the skeleton, with which every subscription begins. */
    begin(publisherSession: bigint): SubscribePoses {
      const request = SubscribePoses.getRootAsSubscribePoses(new ByteBuffer(recorder.request()));
      recorder.onReply({ subject: 'ada', namesHash: 0n, names: [], publisherSession, epoch: 0n });
      send('FSKO', Uint8Array.of(1, 2));
      return request;
    },
    poses(...sequences: number[]): void {
      for (const sequence of sequences) send('FPOS', Uint8Array.of(9), sequence);
    },
  };
}

test('a recorder asks for every pose, and a reconnect goes on with the same reel', () => {
  const { tape, begin, poses, ends } = recording();
  const request = begin(5n);
  assert.deepEqual([request.subject(), request.every(), request.wait()], ['ada', true, true]);
  poses(1, 2);
  begin(5n);
  poses(2, 6);
  assert.deepEqual(tape.between(...ALL).map((reel) => reel.poses.map(({ sequence }) => sequence)), [[1, 2, 6]]);
  assert.equal(numMissed(tape.between(...ALL)), 3);
  begin(6n);
  poses(1);
  assert.deepEqual(tape.between(...ALL).map(({ session }) => session), [5n, 6n]);
  assert.deepEqual(ends, []);
});

test('dropped poses are counted over all connections', () => {
  const { tape, begin, send } = recording();
  begin(5n);
  send('FDRP', dropped(3n));
  send('FDRP', dropped(4n));
  begin(5n);
  send('FDRP', dropped(6n)); // of the second connection
  assert.equal(tape.numDropped, 10);
});

test('a recorder ends once: when the tape is full or the daemon refuses', () => {
  const full = recording(1000);
  full.begin(5n);
  full.poses(1, 2, 3);
  assert.deepEqual(full.ends, ['']);
  const refused = recording();
  refused.recorder.onRefused(15, 'the token has ended');
  refused.recorder.onRefused(15, 'again');
  assert.deepEqual(refused.ends, ['the token has ended']);
  const closed = recording();
  closed.recorder.close();
  closed.recorder.onRefused(15, 'late');
  assert.deepEqual(closed.ends, []);
});
