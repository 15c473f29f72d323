// SPDX-License-Identifier: Apache-2.0
// The client against a daemon in memory, with a clock that the tests advance.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Client, type ClientState, openClient } from '../src/feed/client.js';
import { FurrowError } from '../src/link/errors.js';
import type { TransportKind } from '../src/transport/transport.js';
import { FakeDaemon, FakeMachine, settle } from './fake_daemon.js';

const KINDS: readonly TransportKind[] = ['ws', 'tcp', 'udp'];
const NAMES = ['brow_l.squash', 'brow_l.stretch'];

/** Floats as they arrive. */
const floats = (...values: number[]): number[] => [...Float32Array.from(values)];

function start(kind: TransportKind, subjects: string[] = ['ada']): { machine: FakeMachine; daemon: FakeDaemon; client: Client } {
  const machine = new FakeMachine();
  const daemon = new FakeDaemon(kind);
  for (const subject of subjects) daemon.subjects.set(subject, NAMES);
  const client = new Client(daemon, { environment: machine });
  for (const subject of subjects) client.subscribe({ subject });
  return { machine, daemon, client };
}

/** Advances until `holds`, in steps of 10 ms; returns the milliseconds that it took. */
async function until(machine: FakeMachine, holds: () => boolean): Promise<number> {
  for (let ms = 0; ms <= 20_000; ms += 10) {
    await settle();
    if (holds()) return ms;
    machine.advance(10);
  }
  assert.fail('not within 20 s');
}

for (const kind of KINDS) {
  test(`${kind}: weights of two subjects`, async () => {
    const { machine, daemon, client } = start(kind, ['ada', 'bob']);
    assert.equal(client.weights('ada'), null);
    assert.equal(client.problem('ada'), 'no-data');
    await until(machine, () => client.names('bob').length > 0);
    assert.equal(client.state, 'connected');
    daemon.weights('ada', 7, [0.25, 1]);
    daemon.weights('bob', 9, [0, 0.5], 0n, 17_982);
    await settle();
    const frame = client.weights('ada')!;
    assert.deepEqual([...frame.values], [0.25, 1]);
    assert.deepEqual([frame.subject, frame.names, frame.sequence, frame.number, frame.missed], ['ada', NAMES, 7, 1, 0]);
    assert.deepEqual([frame.captureTimeUs, frame.decaying, frame.gone, frame.ageMs], [7n * 16_667n, false, false, 0]);
    assert.deepEqual([...client.weights('bob')!.values], [0, 0.5]);
    assert.equal(client.weights('bob')!.layout, frame.layout);
    assert.deepEqual([frame.timecode, client.weights('bob')!.timecode?.text], [null, '00:10:00;00']);
    assert.deepEqual(client.subjects(), ['ada', 'bob']);
    machine.advance(30);
    assert.equal(client.weights()!.ageMs, 30);
    client.close();
    assert.equal(machine.numTimers, 0);
  });

  test(`${kind}: weights return within a second of the daemon, whenever that is`, async () => {
    for (let phase = 0; phase < 6000; phase += 170) {
      const { machine, daemon, client } = start(kind);
      const states: ClientState[] = [];
      client.on('state', (state) => states.push(state));
      await until(machine, () => client.names().length > 0);
      daemon.weights('ada', 0, [1, 1]);
      await settle();
      daemon.kill();
      for (let ms = 0; ms < phase; ms += 10) {
        machine.advance(10);
        await settle();
      }
      daemon.isUp = true;
      let sequence = 1;
      const ms = await until(machine, () => {
        daemon.weights('ada', sequence++, [0.5, 0.5]);
        return client.weights('ada')!.values[0] === 0.5;
      });
      // A daemon that was away longer than a UDP client waits for an answer is asked once per second.
      assert(ms <= 1010, `${ms} ms after an absence of ${phase} ms`);
      assert(client.connects >= 2);
      if (kind !== 'udp') assert.deepEqual(states, ['connected', 'disconnected', 'connected']);
      client.close();
    }
  });
}

test('challenges are answered', async () => {
  const { machine, daemon, client } = start('udp');
  await until(machine, () => client.names('ada').length > 0);
  const numbers = [5n, (1n << 61n) + 1n];
  for (const number of numbers) daemon.challenge(number);
  await settle();
  assert.deepEqual(daemon.answers, numbers);
  client.close();
});

test('frames in another order are dropped, and missing ones counted', async () => {
  const { machine, daemon, client } = start('udp');
  await until(machine, () => client.names().length > 0);
  const order = [10, 12, 11, 12, 15];
  for (const sequence of order) {
    daemon.weights('ada', sequence, floats(sequence / 100, 0));
    await settle();
  }
  const frame = client.weights()!;
  assert.deepEqual([frame.sequence, frame.number, frame.missed], [15, 3, 3]);
  machine.advance(1000);
  daemon.weights('ada', 0, [1, 1]); // the publisher has restarted
  await settle();
  assert.equal(client.weights()!.sequence, 0);
  daemon.weights('ada', 0, [0.5, 0.5], 250_000n); // and is silent
  await settle();
  assert.deepEqual([client.weights()!.decaying, client.weights()!.ageMs], [true, 250]);
});

test('lost datagrams are sent again', async () => {
  const { machine, daemon, client } = start('udp');
  daemon.isMute = true;
  for (let step = 0; step < 5; ++step) {
    await settle();
    machine.advance(210);
  }
  const hellos = daemon.received.filter((kind) => kind === 'FHEL').length;
  assert(hellos >= 4 && hellos <= 7, `${hellos} hellos in a second`);
  assert.equal(client.state, 'connecting');
  daemon.isMute = false;
  await until(machine, () => client.state === 'connected');
  daemon.isMute = true;
  machine.advance(1000);
  daemon.isMute = false;
  await until(machine, () => client.names().length > 0);
});

test('a changed rig changes the layout', async () => {
  const { machine, daemon, client } = start('ws');
  const layouts: (readonly string[])[] = [];
  client.on('layout', (_subject, names) => layouts.push(names));
  await until(machine, () => client.names().length > 0);
  daemon.weights('ada', 1, [1, 1]);
  await settle();
  const before = client.weights()!.layout;
  daemon.subjects.set('ada', ['nose.squash']);
  daemon.kill();
  daemon.isUp = true;
  await until(machine, () => client.names().length === 1);
  assert.equal(client.weights(), null);
  daemon.weights('ada', 2, [0.75]);
  await settle();
  assert.notEqual(client.weights()!.layout, before);
  assert.deepEqual(layouts, [NAMES, ['nose.squash']]);
});

test('a rejection is reported and asked again', async () => {
  const machine = new FakeMachine();
  const daemon = new FakeDaemon('ws');
  const client = new Client(daemon, { environment: machine });
  const problems: string[] = [];
  client.on('problem', (...words) => problems.push(words.join(' ')));
  await until(machine, () => client.state === 'connected');
  client.subscribe({ subject: 'ada', pattern: 'nothing' });
  await settle(); // the fake daemon replies; its rejection comes behind
  const sequence = daemon.received.length; // every message counts up by one
  daemon.refuse(sequence, 5, 'no name matches');
  await settle();
  assert.deepEqual(problems, ['ada no-match no name matches']);
  assert.equal(client.problem('ada'), 'no-match');
  daemon.subjects.set('ada', NAMES);
  await until(machine, () => client.names('ada').length > 0);
  assert.equal(client.problem('ada'), 'no-data');
});

test('a subject that leaves keeps its last weights and is awaited', async () => {
  const { machine, daemon, client } = start('tcp');
  const gone: string[] = [];
  client.on('gone', (subject) => gone.push(subject));
  await until(machine, () => client.names().length > 0);
  daemon.weights('ada', 1, [1, 0]);
  daemon.goodbye(1, 1);
  await settle();
  assert.deepEqual(gone, ['ada']);
  assert(client.weights()!.gone);
  daemon.weights('ada', 2, [0.5, 0]);
  await settle();
  assert.equal(client.weights()!.gone, false);
});

test('malformed messages are counted and change nothing', async () => {
  const { machine, daemon, client } = start('ws');
  await until(machine, () => client.names().length > 0);
  daemon.events!.onMessage(new Uint8Array(40));
  daemon.weights('ada', 1, [2, 0]); // outside the range
  daemon.weights('ada', 2, [NaN, 0]);
  await settle();
  assert.equal(client.malformed, 3);
  assert.equal(client.weights(), null);
  assert.equal(client.state, 'connected');
});

test('a dead connection is given up', async () => {
  const { machine, daemon, client } = start('tcp');
  await until(machine, () => client.names().length > 0);
  const opened = daemon.numOpened;
  daemon.isMute = true;
  for (let ms = 0; ms < 7000; ms += 100) {
    machine.advance(100);
    await settle();
  }
  assert(daemon.numOpened > opened);
  daemon.isMute = false;
  await until(machine, () => client.state === 'connected');
});

test('a daemon that refuses every connection is tried less often', async () => {
  const { machine, daemon } = start('tcp');
  for (let ms = 0; ms < 10_000; ms += 10) {
    machine.advance(10);
    await settle();
    daemon.refuse(0, 6, 'no room');
    await settle();
    daemon.events?.onClose('closed');
  }
  // The pauses grow to 0.8 s, of which the test's random numbers take three quarters.
  assert(daemon.numOpened >= 10 && daemon.numOpened <= 25, `${daemon.numOpened} connections in 10 s`);
});

test('a daemon that is silent after a restart is not reported as connected', async () => {
  const { machine, daemon, client } = start('udp');
  await until(machine, () => client.names().length > 0);
  daemon.goodbye(0, 3); // timed out: the client says hello again
  daemon.isMute = true; // and nobody answers
  for (let ms = 0; ms < 7000; ms += 100) {
    machine.advance(100);
    await settle();
  }
  assert.equal(client.state, 'disconnected');
  daemon.isMute = false;
  await until(machine, () => client.state === 'connected');
});

test('a listener may close the client when the connection is lost', async () => {
  const { machine, daemon, client } = start('tcp');
  await until(machine, () => client.names().length > 0);
  client.on('state', () => client.close());
  daemon.kill();
  assert.equal(machine.numTimers, 0);
});

test('a daemon that was never reached leaves the state at connecting', async () => {
  const machine = new FakeMachine();
  const daemon = new FakeDaemon('ws');
  daemon.isUp = false;
  const client = new Client(daemon, { environment: machine });
  const states: ClientState[] = [];
  client.on('state', (state) => states.push(state));
  await until(machine, () => daemon.numOpened > 3);
  assert.deepEqual([client.state, states, client.lastFailure], ['connecting', [], 'refused']);
  daemon.isUp = true;
  await until(machine, () => client.state === 'connected');
  assert.deepEqual(states, ['connected']);
});

test('an address that names a subject twice leaves no connection behind', () => {
  const machine = new FakeMachine();
  assert.throws(() => openClient('furrow://host?subject=ada&subject=ada', { environment: machine }, () => new FakeDaemon('ws')), FurrowError);
  assert.equal(machine.numTimers, 0);
});

test('wrong requests throw', () => {
  const { client } = start('ws');
  for (const request of [{ subject: 'ada' }, { subject: 'a'.repeat(256) }, { subject: 'a\n' }, { subject: 'b', rate: -1 },
    { subject: 'b', rate: NaN }, { subject: 'b', rate: 1001 }, { subject: 'b', pattern: '*'.repeat(4097) }]) {
    assert.throws(() => client.subscribe(request), FurrowError);
  }
  client.subscribe({ subject: 'b', rate: 1000 });
  assert.equal(client.unsubscribe('b'), true);
  assert.equal(client.unsubscribe('b'), false);
  client.close();
});
