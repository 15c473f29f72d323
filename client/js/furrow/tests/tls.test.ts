// SPDX-License-Identifier: Apache-2.0
// TLS in Node, against servers with certificates that the test makes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, readFileSync } from 'node:fs';
import { type AddressInfo, createServer as createPlainServer } from 'node:net';
import { networkInterfaces, tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { createServer, type TLSSocket } from 'node:tls';
import { parseAddress } from '../src/link/address.js';
import { securityOf } from '../src/transport/node/stream.js';
import { tcpSocket } from '../src/transport/node/tcp.js';
import { nodeWebSocket } from '../src/transport/node/web_socket.js';
import type { TransportOpener } from '../src/transport/transport.js';
import { writeMessage } from '../src/wire/envelope.js';
import { frameAck } from '../src/wire/requests.js';

const MESSAGE = writeMessage({ stream: 1, session: 5n, sequence: 9 }, frameAck(3));
const FOLDER = mkdtempSync(join(tmpdir(), 'furrow-tls-'));

/** A certificate that signs itself, with its key, in one file. */
function makeCertificate(name: string, names: string): string {
  const file = join(FOLDER, `${name}.pem`);
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256', '-nodes', '-days', '2',
    '-subj', `/CN=${name}`, '-addext', `subjectAltName=${names}`, '-keyout', file, '-out', join(FOLDER, `${name}.crt`)],
  { stdio: 'ignore' });
  return file;
}
makeCertificate('daemon', 'DNS:localhost,IP:127.0.0.1');
makeCertificate('other', 'DNS:stage.example');
const pem = (name: string): Buffer => readFileSync(join(FOLDER, name));

/** A daemon that echoes one message, or accepts WebSockets. Returns its port and the protocols that clients chose. */
async function serve(name: string, onData: (socket: TLSSocket, bytes: Buffer) => void) {
  const protocols: (string | false | null)[] = [];
  const server = createServer({
    cert: pem(`${name}.crt`), key: pem(`${name}.pem`), minVersion: 'TLSv1.3', ALPNProtocols: ['furrow/1', 'http/1.1'],
  }, (socket) => {
    protocols.push(socket.alpnProtocol);
    socket.on('error', () => {});
    socket.on('data', (bytes) => onData(socket, bytes));
  });
  server.on('tlsClientError', () => {});
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return { port: (server.address() as AddressInfo).port, server, protocols };
}

/** The first message, or why the connection closed. */
function outcome(opener: TransportOpener): Promise<string> {
  return new Promise((resolve) => {
    const transport = opener.open({
      onOpen: () => transport.send(MESSAGE),
      onMessage: (message) => {
        resolve(Buffer.compare(message, MESSAGE) === 0 ? 'message' : 'other bytes');
        transport.close();
      },
      onMalformed: () => resolve('malformed'),
      onClose: resolve,
    });
  });
}

const security = (query: string, token = '') => securityOf(parseAddress(`furrow://a?${query}`), token);
const TRUSTS = `tls-authority=${join(FOLDER, 'daemon.crt')}`;

test('TCP over TLS: messages arrive, and the protocol is named', async () => {
  const { port, server, protocols } = await serve('daemon', (socket, bytes) => socket.write(bytes));
  for (const host of ['127.0.0.1', 'localhost']) {
    assert.equal(await outcome(tcpSocket(host, port, security(TRUSTS, 'frw1_x'))), 'message');
  }
  assert.deepEqual(protocols, ['furrow/1', 'furrow/1']);
  server.close();
});

test('certificates are checked', async () => {
  const { port, server } = await serve('daemon', (socket, bytes) => socket.write(bytes));
  assert.match(await outcome(tcpSocket('127.0.0.1', port, security('tls=1'))), /no known authority has signed/);
  server.close();
  const other = await serve('other', (socket, bytes) => socket.write(bytes));
  const trusts = `tls-authority=${join(FOLDER, 'other.crt')}`;
  for (const opener of [tcpSocket, nodeWebSocket]) {
    assert.match(await outcome(opener('127.0.0.1', other.port, security(trusts))), /certificate is for another host/);
  }
  other.server.close();
  assert.throws(() => security('tls-authority=/nowhere.crt'), /tls-authority: .*nowhere/);
});

test('a WebSocket over TLS names HTTP, and a server without WebSockets is refused', async () => {
  const { port, server, protocols } = await serve('daemon', (socket) => socket.end('HTTP/1.1 404 Not Found\r\n\r\n'));
  assert.match(await outcome(nodeWebSocket('127.0.0.1', port, security(TRUSTS))), /404/);
  assert.deepEqual(protocols, ['http/1.1']);
  server.close();
});

test('a daemon that speaks no TLS', async () => {
  const server = createPlainServer((socket) => {
    socket.on('error', () => {});
    socket.end('HTTP/1.1 400 Bad Request\r\n\r\n');
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address() as AddressInfo;
  assert.match(await outcome(tcpSocket('127.0.0.1', port, security('tls=1'))), /does not speak TLS/);
  server.close();
});

test('a daemon that closes during the handshake may be busy', async () => {
  const server = createPlainServer((socket) => {
    socket.on('error', () => {});
    socket.once('data', () => (isReset ? socket.resetAndDestroy() : socket.destroy()));
  });
  let isReset = false;
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address() as AddressInfo;
  for (isReset of [false, true]) {
    for (const opener of [tcpSocket, nodeWebSocket]) {
      const why = await outcome(opener('127.0.0.1', port, security('tls=1')));
      assert.match(why, /closed the connection during the TLS handshake: it is busy/);
    }
  }
  server.close();
});

test('an attempt with TLS has the time of a daemon that is busy', () => {
  for (const opener of [tcpSocket, nodeWebSocket]) {
    assert.ok(opener('a', 1, security('tls=1')).connectMs! > 5000);
    assert.equal(opener('a', 1).connectMs, undefined);
  }
});

const own = Object.values(networkInterfaces()).flat().find((each) => each?.family === 'IPv4' && !each.internal)?.address;

test('a token does not travel unencrypted to another address', { skip: own === undefined && 'no such address' }, async () => {
  let heard = '';
  const server = createPlainServer((socket) => {
    socket.on('error', () => {});
    socket.on('data', (bytes) => {
      heard += bytes.toString('latin1');
      socket.destroy();
    });
  });
  server.listen(0);
  await once(server, 'listening');
  const { port } = server.address() as AddressInfo;
  for (const opener of [tcpSocket, nodeWebSocket]) {
    assert.match(await outcome(opener(own!, port, security('', 'frw1_secret'))), /unencrypted/);
  }
  assert.equal(heard, '');
  await outcome(nodeWebSocket(own!, port, security('token-in-clear=1', 'frw1_secret')));
  assert.match(heard, /frw1_secret/);
  server.close();
});
