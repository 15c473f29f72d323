// SPDX-License-Identifier: Apache-2.0
// A client that is sent from one server of a cluster to another one, with a clock that the tests advance.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Client } from '../src/feed/client.js';
import { Connection } from '../src/link/connection.js';
import { parseServer } from '../src/link/servers.js';
import { tcpSocket } from '../src/transport/node/tcp.js';
import { nodeWebSocket } from '../src/transport/node/web_socket.js';
import type { Server, TransportKind, TransportOpener } from '../src/transport/transport.js';
import { browserSocket } from '../src/transport/web_socket.js';
import { subscribeWeights } from '../src/wire/requests.js';
import { FakeDaemon, FakeMachine, settle } from './fake_daemon.js';

const NAMES = ['brow_l.squash'];
const A: Server = { host: 'host-a', tcp: 1, udp: 2, web: 7, isWebTls: false };
const B: Server = { host: 'host-b', tcp: 3, udp: 4, web: 8, isWebTls: true };

interface Pair {
  machine: FakeMachine;
  a: FakeDaemon;
  b: FakeDaemon;
  client: Client;
}

/** A client of server `a`, and `b`, which has the subject. */
function start(kind: TransportKind, subjects = ['ada'], follows = true, reaches = (): boolean => true): Pair {
  const machine = new FakeMachine();
  const [a, b] = [new FakeDaemon(kind), new FakeDaemon(kind)];
  b.session = 0x4444n;
  a.moved = B;
  b.subjects.set('ada', NAMES);
  const opener = (daemon: FakeDaemon): TransportOpener => ({
    kind, open: (events) => daemon.open(events),
    ...(follows && { elsewhere: (server: Server) => reaches() ? opener(server.host === 'host-b' ? b : a) : null }),
  });
  const client = new Client(opener(a), { environment: machine });
  for (const subject of subjects) client.subscribe({ subject });
  return { machine, a, b, client };
}

/** Advances until `holds`, in steps of 10 ms. */
async function until(machine: FakeMachine, holds: () => boolean): Promise<void> {
  for (let ms = 0; ms <= 20_000; ms += 10) {
    await settle();
    if (holds()) return;
    machine.advance(10);
  }
  assert.fail('not within 20 s');
}

async function pass(machine: FakeMachine, ms: number): Promise<void> {
  for (let passed = 0; passed < ms; passed += 10) {
    machine.advance(10);
    await settle();
  }
}

for (const kind of ['tcp', 'udp', 'ws'] as const) {
  test(`${kind}: it goes where the daemon sends it`, async () => {
    const { machine, a, b, client } = start(kind);
    let problems = 0;
    client.on('problem', () => ++problems);
    await until(machine, () => client.names('ada').length > 0);
    b.weights('ada', 7, [0.25]);
    await settle();
    assert.deepEqual([...client.weights('ada')!.values], [0.25]);
    assert.deepEqual([a.numOpened, b.numOpened, problems], [1, 1, 0]);
    client.close();
  });
}

test('a subject that moves takes its client along', async () => {
  const { machine, a, b, client } = start('tcp');
  a.subjects.set('ada', NAMES);
  [a.epoch, b.epoch] = [10n, 11n];
  await until(machine, () => client.names('ada').length > 0);
  assert.equal(b.numOpened, 0);
  a.subjects.delete('ada');
  a.refuse(2, 4, 'elsewhere', B); // of no request
  await settle();
  assert.equal(b.numOpened, 0);
  /** The daemon refuses the requests until one of them was the client's, which then leaves. */
  const sendAway = async (from: FakeDaemon, most: number, server: Server, hasLeft: () => boolean): Promise<void> => {
    for (let sequence = 0; sequence < most && !hasLeft(); ++sequence) {
      from.refuse(sequence, 4, 'elsewhere', server);
      await settle();
    }
    await until(machine, hasLeft);
    await settle();
  };
  await sendAway(a, 8, B, () => b.numOpened === 1);
  // There, weights count.
  b.weights('ada', 98, [0.5]);
  await settle();
  assert.deepEqual([...client.weights('ada')!.values], [0.5]);
  // Back at a server with a lower epoch, nothing counts.
  b.subjects.delete('ada');
  b.moved = A;
  a.subjects.set('ada', NAMES);
  await sendAway(b, 16, A, () => a.numOpened === 2);
  a.weights('ada', 99, [1]);
  await settle();
  assert.deepEqual([...client.weights('ada')!.values], [0.5]);
  client.close();
});

test('servers that send it to and fro keep it for a while', async () => {
  const { machine, a, b, client } = start('tcp');
  b.subjects.clear();
  b.moved = A;
  await pass(machine, 5000);
  assert.equal(a.numOpened + b.numOpened, 5);
  a.subjects.set('ada', NAMES);
  b.subjects.set('ada', NAMES);
  await until(machine, () => client.names('ada').length > 0);
  client.close();
});

test('with several subjects, and where it must not, it stays', async () => {
  for (const [subjects, follows] of [[['ada', 'bob'], true], [['ada'], false]] as const) {
    const { machine, b, client } = start('tcp', [...subjects], follows);
    let problems = 0;
    client.on('problem', () => ++problems);
    await pass(machine, 1000);
    assert.equal(b.numOpened, 0);
    assert(problems > 0);
    client.close();
  }
});

test('it goes on at another server if its own is gone', async () => {
  const { machine, a, b, client } = start('tcp');
  a.subjects.set('ada', NAMES);
  a.others = ['host-b:3:4', 'no address'];
  await until(machine, () => client.names('ada').length > 0);
  await settle();
  a.kill();
  await until(machine, () => b.numOpened > 0);
  client.close();
});

test('over TCP, a token is shown only to servers whose authority the user has named', () => {
  const follows = (security: Parameters<typeof tcpSocket>[2]): boolean => tcpSocket('host', 1, security).elsewhere !== undefined;
  assert(follows({ token: '', tls: null, tokenInClear: false }));
  assert(!follows({ token: 'frw1_x', tls: null, tokenInClear: false }));
  assert(!follows({ token: 'frw1_x', tls: {}, tokenInClear: false }));
  assert(!follows({ token: 'frw1_x', tls: { ca: 'PEM' }, tokenInClear: true }));
  assert(follows({ token: 'frw1_x', tls: { ca: 'PEM' }, tokenInClear: false }));
});

test('addresses of other servers are checked', () => {
  assert.deepEqual(parseServer('10.0.0.2:7400:7401'), { host: '10.0.0.2', tcp: 7400, udp: 7401, web: 0, isWebTls: false });
  assert.deepEqual(parseServer('::1:7400:7401'), { host: '::1', tcp: 7400, udp: 7401, web: 0, isWebTls: false });
  for (const text of ['', 'host', 'host:1', 'host:0:1', 'host:1:65536', ':1:2', 'host:1:2:']) assert.equal(parseServer(text), null, text);
});

test('a WebSocket needs a web server there, never goes from HTTPS to HTTP, and shows a token to nobody else', () => {
  const plain = { ...B, isWebTls: false };
  const reaches = (opener: TransportOpener, server: Server): boolean => (opener.elsewhere?.(server) ?? null) !== null;
  const token = (): string => 'frw1_x';
  for (const [url, server, expected] of [
    ['ws://host-a:7/ws', B, true], ['wss://host-a:7/ws', B, true], ['ws://host-a:7/ws', plain, true],
    ['wss://host-a:7/ws', plain, false], ['ws://host-a:7/ws', { ...B, web: 0 }, false],
  ] as const) {
    assert.equal(reaches(browserSocket(url), server), expected, url);
    assert(!reaches(browserSocket(url, token), server));
  }
  const tls = { token: '', tls: { ca: 'PEM' }, tokenInClear: false };
  assert(reaches(nodeWebSocket('host-a', 7), plain));
  assert(!reaches(nodeWebSocket('host-a', 7), { ...plain, web: 0 }));
  assert(!reaches(nodeWebSocket('host-a', 7), B));
  assert(reaches(nodeWebSocket('host-a', 7, tls), B));
  assert(!reaches(nodeWebSocket('host-a', 7, tls), plain));
  assert(reaches(nodeWebSocket('host-a', 7, { ...tls, token: 'frw1_x' }), B));
  assert(!reaches(nodeWebSocket('host-a', 7, { ...tls, token: 'frw1_x', tls: {} }), B));
});

test('a server that the client does not reach keeps it', async () => {
  const { machine, a, b, client } = start('ws', ['ada'], true, () => false);
  a.others = ['host-b:3:4'];
  let problems = 0;
  client.on('problem', () => ++problems);
  await pass(machine, 1000);
  assert.equal(b.numOpened, 0);
  assert(problems > 0);
  a.kill();
  await pass(machine, 3000);
  assert.equal(b.numOpened, 0);
  client.close();
});

test('a subscription of a connection that stays learns the address of the other web server', async () => {
  const machine = new FakeMachine();
  const daemon = new FakeDaemon('ws');
  const connection = new Connection(daemon, { environment: machine });
  const told: string[] = [];
  const refused: string[] = [];
  const subscribe = (onElsewhere?: (web: string) => void): void => void connection.subscribe({
    request: () => subscribeWeights({ subject: 'ada' }),
    onReply: () => {},
    onMessage: () => {},
    onGone: () => {},
    onRefused: (_code, message) => refused.push(message),
    ...(onElsewhere && { onElsewhere }),
  });
  subscribe((web) => told.push(web));
  subscribe();
  for (const [server, expected] of [[B, ['https://host-b:8']], [{ ...A, host: '::1' }, ['http://[::1]:7']],
    [{ ...B, web: 0 }, []], [{ ...B, host: 'evil/x' }, []]] as const) {
    told.length = refused.length = 0;
    daemon.moved = server;
    daemon.kill();
    daemon.isUp = true;
    await until(machine, () => told.length + refused.length === 2);
    assert.deepEqual(told, expected);
    assert.equal(refused.length, 2 - expected.length);
  }
  connection.close();
});
