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
 * (docs/TOKENS.md), which a browser sends unencrypted to its own computer only, unless the address has
 * `token-in-clear=1`; `tls=1` encrypts. Throws FurrowError if the address is invalid.
 */
export function open(address: string, options: OpenOptions = {}): Client {
  return openClient(address, options, ({ host, port, transport, token, tls, tlsAuthority, tlsCertificate, tokenInClear }) => {
    if (tlsAuthority !== '' || tlsCertificate !== '') {
      throw new FurrowError('unsupported', 'address: browsers read no files (use tls=1, and let the browser trust the authority)');
    }
    if (transport !== null && !tls) {
      throw new FurrowError('unsupported', `address: transport=${transport} needs Node (leave it out in browsers)`);
    }
    // A page from https may open secure sockets only.
    const scheme = tls || (typeof location !== 'undefined' && location.protocol === 'https:') ? 'wss' : 'ws';
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
    const isLoopback = /^(localhost|127\.[0-9.]+|::1)$/i.test(host);
    if (token !== '' && scheme === 'ws' && !isLoopback && !tokenInClear) {
      throw new FurrowError('invalid-argument',
        `the token would travel to ${host} unencrypted (use tls=1; token-in-clear=1 sends it anyway)`);
    }
    return browserSocket(url, () => token);
  });
}
