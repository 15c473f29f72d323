// SPDX-License-Identifier: Apache-2.0
// The package in Node.
import { DEFAULT_HTTP_PORT } from './api.js';
import { type Client, openClient, type OpenOptions } from './feed/client.js';
import { tcpSocket } from './transport/node/tcp.js';
import { udpSocket } from './transport/node/udp.js';
import { nodeWebSocket } from './transport/node/web_socket.js';

export * from './api.js';

const DEFAULT_TCP_PORT = 7400;
const DEFAULT_UDP_PORT = 7401;

/** As in browsers (index.ts), over UDP, or TCP if the address says so. */
export function open(address: string, options: OpenOptions = {}): Client {
  return openClient(address, options, ({ host, port, transport }) => transport === 'tcp'
    ? tcpSocket(host, port === 0 ? DEFAULT_TCP_PORT : port)
    : udpSocket(host, port === 0 ? DEFAULT_UDP_PORT : port));
}

/** The same over a WebSocket to the daemon's web server, as a browser does it. */
export function openWebSocket(address: string, options: OpenOptions = {}): Client {
  return openClient(address, options, ({ host, port }) =>
    nodeWebSocket(host, port === 0 ? DEFAULT_HTTP_PORT : port));
}
