// SPDX-License-Identifier: Apache-2.0
// A TCP connection with or without TLS, and what keeps a token from travelling unencrypted.
import { readFileSync } from 'node:fs';
import { createConnection, isIP, type Socket } from 'node:net';
import { connect as connectTls } from 'node:tls';
import type { Address } from '../../link/address.js';
import { FurrowError } from '../../link/errors.js';

/** How a client proves who it is, and how it protects what it sends. */
export interface StreamSecurity {
  /** The text of a connect token, or empty. */
  token: string;
  /** Null: plain TCP. Texts in PEM form; absent: the authorities of Node, and no certificate of the client. */
  tls: { ca?: string; cert?: string; key?: string } | null;
  /** Permits the token over plain TCP to other computers. */
  tokenInClear: boolean;
}

export const NO_SECURITY: StreamSecurity = { token: '', tls: null, tokenInClear: false };

function readPem(key: string, file: string): string {
  try {
    return readFileSync(file, 'utf8');
  } catch (error) {
    throw new FurrowError('invalid-argument', `${key}: ${(error as Error).message}`);
  }
}

/** What an address asks for. `token`: the text of its token. Throws FurrowError if a file cannot be read. */
export function securityOf(address: Address, token: string): StreamSecurity {
  const { tls, tlsAuthority, tlsCertificate, tlsKey, tokenInClear } = address;
  if (!tls) return { token, tls: null, tokenInClear };
  const files: NonNullable<StreamSecurity['tls']> = {};
  if (tlsAuthority !== '') files.ca = readPem('tls-authority', tlsAuthority);
  if (tlsCertificate !== '') {
    files.cert = readPem('tls-certificate', tlsCertificate);
    files.key = tlsKey === '' ? files.cert : readPem('tls-key', tlsKey);
  }
  return { token, tls: files, tokenInClear };
}

/**
 * True if the client may go to a server that others have named. Any server has a certificate of a public authority, so
 * a token needs one that the user has named.
 */
export function mayShowTokenElsewhere({ token, tls, tokenInClear }: StreamSecurity): boolean {
  return token === '' || (tls?.ca !== undefined && !tokenInClear);
}

const isLoopback = (address = ''): boolean => /^(::ffff:)?127\.|^::1$/.test(address);

const UNKNOWN = 'no known authority has signed its certificate (give the authority, or the certificate itself, with ' +
  'tls-authority=FILE)';
const FAILURES: Record<string, string> = {
  CERT_HAS_EXPIRED: 'its certificate has expired (renew it, or compare the clocks)',
  CERT_NOT_YET_VALID: 'its certificate is not valid yet (compare the clocks)',
  ERR_TLS_CERT_ALTNAME_INVALID: 'its certificate is for another host (connect by a name or an address that the certificate states)',
  DEPTH_ZERO_SELF_SIGNED_CERT: UNKNOWN,
  SELF_SIGNED_CERT_IN_CHAIN: UNKNOWN,
  UNABLE_TO_GET_ISSUER_CERT: UNKNOWN,
  UNABLE_TO_GET_ISSUER_CERT_LOCALLY: UNKNOWN,
  UNABLE_TO_VERIFY_LEAF_SIGNATURE: UNKNOWN,
  ERR_SSL_WRONG_VERSION_NUMBER: 'it does not speak TLS (leave out tls=1, or start furrowd with --tls-certificate)',
  ERR_SSL_TLSV13_ALERT_CERTIFICATE_REQUIRED: 'it asks for a certificate of the client (give it with tls-certificate=FILE and tls-key=FILE)',
};

const HANDSHAKE_CUT = 'the daemon closed the connection during the TLS handshake: it is busy with other clients of this ' +
  'address, or does not speak TLS at this port';

/** Why a connection failed, as a sentence. `isInHandshake`: of TLS. */
function failureText(error: NodeJS.ErrnoException, isInHandshake: boolean): string {
  if (isInHandshake && (error.code === 'ECONNRESET' || error.code === 'EPIPE')) return HANDSHAKE_CUT;
  return FAILURES[error.code ?? ''] ?? error.message;
}

/**
 * Begins to connect. `protocol`: of TLS (ALPN). Calls `onOpen` when bytes can be sent. Calls `onFailed` with a sentence
 * if the connection fails, then or later, or if the token would travel unencrypted to another computer.
 */
export function connectStream(host: string, port: number, security: StreamSecurity, protocol: string,
  onOpen: () => void, onFailed: (why: string) => void): Socket {
  if (security.tls !== null) {
    // A server name is a name, never an address (RFC 6066 section 3).
    const name = isIP(host) === 0 ? { servername: host } : {};
    const socket = connectTls({ host, port, ...name, ...security.tls, minVersion: 'TLSv1.3', ALPNProtocols: [protocol] });
    let isInHandshake = true;
    socket.setNoDelay(true);
    socket.on('secureConnect', () => {
      isInHandshake = false;
      onOpen();
    });
    socket.on('error', (error) => onFailed(failureText(error, isInHandshake)));
    return socket;
  }
  const socket = createConnection({ host, port, noDelay: true });
  socket.on('error', (error) => onFailed(failureText(error, false)));
  socket.on('connect', () => {
    if (security.token === '' || security.tokenInClear || isLoopback(socket.remoteAddress)) onOpen();
    else onFailed(`the token would travel to ${host} unencrypted (use UDP or tls=1; token-in-clear=1 sends it anyway)`);
  });
  return socket;
}
