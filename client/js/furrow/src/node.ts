// SPDX-License-Identifier: Apache-2.0
// The package in Node.
import { DEFAULT_HTTP_PORT } from './api.js';
import { type Client, openClient, type OpenOptions } from './feed/client.js';
import { securityOf } from './transport/node/stream.js';
import { tcpSocket } from './transport/node/tcp.js';
import { udpSocket } from './transport/node/udp.js';
import { tokenText } from './transport/node/secure/token.js';
import { nodeWebSocket } from './transport/node/web_socket.js';

export * from './api.js';

const DEFAULT_TCP_PORT = 7400;
const DEFAULT_UDP_PORT = 7401;

/**
 * As in browsers (index.ts), over UDP, or TCP if the address says so. `token=` also names a file. With a token, UDP is
 * encrypted. Over TCP, `tls=1` encrypts; without it, a token travels to this computer only, or with `token-in-clear=1`.
 */
export function open(address: string, options: OpenOptions = {}): Client {
  return openClient(address, options, (parsed) => {
    const { host, port, transport, token } = parsed;
    return transport === 'tcp'
      ? tcpSocket(host, port === 0 ? DEFAULT_TCP_PORT : port, securityOf(parsed, tokenText(token)))
      : udpSocket(host, port === 0 ? DEFAULT_UDP_PORT : port, tokenText(token));
  });
}

/** The same over a WebSocket to the daemon's web server, as a browser does it. */
export function openWebSocket(address: string, options: OpenOptions = {}): Client {
  return openClient(address, options, (parsed) => nodeWebSocket(
    parsed.host, parsed.port === 0 ? DEFAULT_HTTP_PORT : parsed.port, securityOf(parsed, tokenText(parsed.token))));
}
