// SPDX-License-Identifier: Apache-2.0
// Node's transports against servers that do what they like.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { createSocket } from 'node:dgram';
import { once } from 'node:events';
import { type AddressInfo, createServer, type Server, type Socket } from 'node:net';
import test from 'node:test';
import { tcpSocket } from '../src/transport/node/tcp.js';
import { udpSocket } from '../src/transport/node/udp.js';
import { nodeWebSocket } from '../src/transport/node/web_socket.js';
import type { Transport, TransportOpener } from '../src/transport/transport.js';
import { writeMessage } from '../src/wire/envelope.js';
import { frameAck } from '../src/wire/requests.js';

const MESSAGE = writeMessage({ stream: 1, session: 5n, sequence: 9 }, frameAck(3));

/** What happens to a transport, as lines; `ended` resolves with them when it closes. */
function run(opener: TransportOpener): { transport: Transport; log: string[]; ended: Promise<string[]>; seen: (line: string) => Promise<void> } {
  const log: string[] = [];
  const waiting: { line: string; resolve: () => void }[] = [];
  let end: (log: string[]) => void;
  const ended = new Promise<string[]>((resolve) => (end = resolve));
  const note = (line: string): void => {
    log.push(line);
    for (const each of waiting) if (each.line === line) each.resolve();
  };
  const transport = opener.open({
    onOpen: () => note('open'),
    onMessage: (message) => note(Buffer.compare(message, MESSAGE) === 0 ? 'message' : `${message.length} other bytes`),
    onMalformed: () => note('malformed'),
    onClose: () => {
      note('closed');
      end(log);
    },
  });
  return { transport, log, ended, seen: (line) => log.includes(line) ? Promise.resolve() : new Promise((resolve) => waiting.push({ line, resolve })) };
}

async function serve(onConnection: (socket: Socket) => void): Promise<{ port: number; server: Server }> {
  const server = createServer((socket) => {
    socket.on('error', () => {});
    onConnection(socket);
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return { port: (server.address() as AddressInfo).port, server };
}

function framed(message: Uint8Array, length = message.length): Buffer {
  const head = Buffer.alloc(4);
  head.writeUInt32LE(length);
  return Buffer.concat([head, message]);
}

test('TCP: messages arrive in any pieces', async () => {
  const all = Buffer.concat([framed(MESSAGE), framed(MESSAGE), framed(MESSAGE)]);
  for (const size of [1, 3, 5, 36, 100, all.length]) {
    const { port, server } = await serve((socket) => {
      for (let at = 0; at < all.length; at += size) socket.write(all.subarray(at, at + size));
      socket.end();
    });
    assert.deepEqual(await run(tcpSocket('127.0.0.1', port)).ended, ['open', 'message', 'message', 'message', 'closed']);
    server.close();
  }
});

test('TCP: a length that lies ends the connection', async () => {
  for (const length of [0, 31, 0x7fffffff, 0xffffffff]) {
    const { port, server } = await serve((socket) => socket.write(framed(MESSAGE, length)));
    assert.deepEqual(await run(tcpSocket('127.0.0.1', port)).ended, ['open', 'malformed', 'closed']);
    server.close();
  }
});

test('TCP: a closed port', async () => {
  const { port, server } = await serve(() => {});
  server.close();
  await once(server, 'close');
  assert.deepEqual(await run(tcpSocket('127.0.0.1', port)).ended, ['closed']);
});

/** A server that accepts the upgrade, unless told otherwise, and then sends `bytes`. */
function webServer(bytes: Buffer, accept: (key: string) => string = (key) =>
  createHash('sha1').update(`${key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64'),
onUpgrade: (socket: Socket) => void = () => {}): Promise<{ port: number; server: Server }> {
  return serve((socket) => {
    socket.once('data', (request) => {
      const key = /Sec-WebSocket-Key: (\S+)/.exec(String(request))![1]!;
      socket.write(`HTTP/1.1 101 Switching Protocols\r\nSec-WebSocket-Accept: ${accept(key)}\r\n\r\n`);
      socket.write(bytes);
      onUpgrade(socket);
    });
  });
}

/** A frame of a server: without a mask. */
function frame(opcode: number, payload: Uint8Array, isFinal = true): Buffer {
  return Buffer.concat([Buffer.from([(isFinal ? 0x80 : 0) | opcode, payload.length]), payload]);
}

test('WebSocket: whole, divided and interleaved messages', async () => {
  const bytes = Buffer.concat([
    frame(2, MESSAGE), frame(2, MESSAGE.subarray(0, 20), false), frame(9, Buffer.from('ping')), frame(0, MESSAGE.subarray(20)), frame(8, Buffer.alloc(0)),
  ]);
  const { port, server } = await webServer(bytes);
  assert.deepEqual(await run(nodeWebSocket('127.0.0.1', port)).ended, ['open', 'message', 'message', 'closed']);
  server.close();
});

test('WebSocket: invalid servers and frames end the connection', async () => {
  const huge = Buffer.from([0x82, 127, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]);
  for (const [bytes, expected] of [
    [Buffer.from([0x82, 0x80 | 4, 1, 2, 3, 4, 0, 0, 0, 0]), ['open', 'malformed', 'closed']], // masked
    [Buffer.from([0xc2, 4, 0, 0, 0, 0]), ['open', 'malformed', 'closed']], // compressed
    [huge, ['open', 'malformed', 'closed']],
    [Buffer.from([0x89, 126, 0, 200]), ['open', 'malformed', 'closed']], // a long ping
    [Buffer.concat(Array.from({ length: 5000 }, () => Buffer.from([0, 0]))), ['open', 'malformed', 'closed']], // empty parts without end
  ] as const) {
    const { port, server } = await webServer(bytes);
    assert.deepEqual(await run(nodeWebSocket('127.0.0.1', port)).ended, expected);
    server.close();
  }
  const { port, server } = await webServer(Buffer.alloc(0), () => 'nonsense');
  assert.deepEqual(await run(nodeWebSocket('127.0.0.1', port)).ended, ['closed']);
  server.close();
  const endless = await serve((socket) => socket.write('x'.repeat(100_000)));
  assert.deepEqual(await run(nodeWebSocket('127.0.0.1', endless.port)).ended, ['closed']);
  endless.server.close();
});

test('a server that does not read ends the connection', async () => {
  for (const [opener, { port, server }] of [
    [tcpSocket, await serve((socket) => socket.pause())],
    [nodeWebSocket, await webServer(Buffer.alloc(0), undefined, (socket) => socket.pause())],
  ] as const) {
    const { transport, seen, ended } = run(opener('127.0.0.1', port));
    await seen('open');
    for (let i = 0; i < 64; ++i) transport.send(new Uint8Array(1 << 20)); // more than the system's buffers hold
    assert.deepEqual(await ended, ['open', 'closed']);
    server.close();
  }
});

test('UDP: datagrams that are none are counted, and messages arrive', async () => {
  const daemon = createSocket('udp4');
  daemon.bind(0, '127.0.0.1');
  await once(daemon, 'listening');
  const { transport, seen, log } = run(udpSocket('127.0.0.1', daemon.address().port));
  await seen('open');
  transport.send(MESSAGE);
  const [received, from] = await once(daemon, 'message') as [Buffer, AddressInfo];
  assert.deepEqual(new Uint8Array(received), new Uint8Array(MESSAGE));
  daemon.send(MESSAGE.subarray(0, 30), from.port);
  await seen('malformed');
  daemon.send(MESSAGE, from.port);
  await seen('message');
  transport.close();
  assert.deepEqual(log, ['open', 'malformed', 'message']);
  daemon.close();
});
