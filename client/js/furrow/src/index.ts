// SPDX-License-Identifier: Apache-2.0
// The package in a browser.
import { DEFAULT_HTTP_PORT } from './api.js';
import { type Client, openClient, type OpenOptions } from './feed/client.js';
import { TOKEN_PREFIX } from './link/address.js';
import { FurrowError } from './link/errors.js';
import { browserSocket } from './transport/web_socket.js';

export * from './api.js';

/**
 * Opens a connection to a daemon and returns at once. In a browser it is a WebSocket to the daemon's web server
 * (default port: 7480); in Node it is UDP (default port: 7401) or what the address states with `transport=tcp`.
 *
 * `address`: `furrow://host[:port][?subject=ada&rate=60&pattern=brow_*]`. With `token=`, it shows a connect token
 * (docs/TOKENS.md). Throws FurrowError if it is invalid.
 */
export function open(address: string, options: OpenOptions = {}): Client {
  return openClient(address, options, ({ host, port, transport, token }) => {
    if (transport !== null) {
      throw new FurrowError('unsupported', `address: transport=${transport} needs Node (leave it out in browsers)`);
    }
    // A page from https may open secure sockets only.
    const scheme = typeof location !== 'undefined' && location.protocol === 'https:' ? 'wss' : 'ws';
    const name = host.includes(':') ? `[${host}]` : host;
    const url = `${scheme}://${name}:${port === 0 ? DEFAULT_HTTP_PORT : port}/ws`;
    try {
      new URL(url);
    } catch {
      throw new FurrowError('invalid-address', 'address: browsers do not accept this host name (use a DNS name or an IP address)');
    }
    if (token !== '' && !token.startsWith(TOKEN_PREFIX)) {
      throw new FurrowError('invalid-address', `address: a token begins with '${TOKEN_PREFIX}' (browsers read no files)`);
    }
    return browserSocket(url, () => token);
  });
}
