// SPDX-License-Identifier: Apache-2.0
// The address of a daemon, and what to ask of it. The grammar and the messages are those of every Furrow client:
// tests/unit/client/addresses.json checks them here and in C++.
import { FurrowError } from './errors.js';

export type AddressTransport = 'udp' | 'tcp';

/**
 * `furrow://host[:port][?subject=ada&rate=60&pattern=brow_*&transport=udp]`, or HOST, HOST:PORT or [IPV6]:PORT, which
 * state no more than the daemon. Keys occur at most once, except `subject`. `%2A` in values stands for the byte with
 * this hexadecimal number.
 */
export interface Address {
  /** A name or a numeric address, without brackets. */
  host: string;
  /** 0: not stated. */
  port: number;
  transport: AddressTransport | null;
  /** Empty: the oldest live subject. */
  subjects: string[];
  /** Comma-separated globs; empty: not stated. */
  pattern: string;
  /** 0: not stated. */
  maxRateHz: number;
  /** The text of a connect token (docs/TOKENS.md), or in Node a file that holds one; empty: not stated. */
  token: string;
  /** TLS over TCP or WebSocket. */
  tls: boolean;
  /** Files of TLS in PEM form, in Node; empty: not stated. The daemon's certificate is checked with the first one. */
  tlsAuthority: string;
  tlsCertificate: string;
  tlsKey: string;
  /** Permits the token without encryption to other computers, where everybody on the way can read it. */
  tokenInClear: boolean;
}

/** The text of a connect token begins with it. */
export const TOKEN_PREFIX = 'frw1_';

const SCHEME = 'furrow://';
const MAX_ADDRESS_BYTES = 64 * 1024;
const MAX_HOST_BYTES = 255;
const MAX_SUBJECTS = 256;
const MAX_NAME_BYTES = 255;
const MAX_PATTERN_BYTES = 4096;
const MAX_RATE_HZ = 1000;
const MAX_PATH_BYTES = 4096;
const KEYS = ['subject', 'pattern', 'rate', 'transport', 'token', 'tls', 'tls-authority', 'tls-certificate', 'tls-key',
  'token-in-clear'];
/** A later version will use it. Ignoring it would pretend to protect. */
const RESERVED_KEY = 'key';
const FORMS = 'use HOST, HOST:PORT or [IPV6]:PORT, alone or after furrow://';
const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/;

const ENCODER = new TextEncoder();
const numBytes = (text: string): number => ENCODER.encode(text).length;

/** Bytes, one per character: a value may hold any bytes until it is checked. */
type ByteText = string;

/** A piece of a text in a message: at most 40 bytes, with '?' for every byte that is not printable ASCII. */
function quotedBytes(bytes: ByteText): string {
  return `'${bytes.slice(0, 40).replace(/[^ -~]/g, '?')}${bytes.length > 40 ? '...' : ''}'`;
}

const quoted = (text: string): string => quotedBytes(String.fromCharCode(...ENCODER.encode(text.slice(0, 41))));

function invalid(what: string, todo = ''): FurrowError {
  return new FurrowError('invalid-address', `address: ${what}${todo === '' ? '' : ` (${todo})`}`);
}

function unsupported(what: string, todo: string): FurrowError {
  return new FurrowError('unsupported', `address: ${what} (${todo})`);
}

/** The bytes of a value; null if a '%' is not followed by two digits. */
function decodePercent(text: string): ByteText | null {
  if (/%(?![0-9a-fA-F]{2})/.test(text)) return null;
  const bytes: number[] = [];
  for (let i = 0; i < text.length; ++i) {
    if (text[i] === '%') {
      bytes.push(parseInt(text.slice(i + 1, i + 3), 16));
      i += 2;
    } else {
      const character = String.fromCodePoint(text.codePointAt(i)!);
      bytes.push(...ENCODER.encode(character));
      i += character.length - 1;
    }
  }
  return bytes.map((b) => String.fromCharCode(b)).join('');
}

/** The text of bytes in UTF-8 without control characters; null if it is none. */
function plainText(bytes: ByteText): string | null {
  try {
    const text = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true })
      .decode(Uint8Array.from(bytes, (b) => b.charCodeAt(0)));
    return /[\u0000-\u001f\u007f]/.test(text) ? null : text;
  } catch {
    return null;
  }
}

/** Splits HOST, HOST:PORT or [IPV6]:PORT. `port` is null if there is none. */
function splitHost(text: string): { host: string; port: string | null } | null {
  if (text.startsWith('[')) {
    const close = text.indexOf(']');
    if (close < 0) return null;
    const rest = text.slice(close + 1);
    if (rest !== '' && rest[0] !== ':') return null;
    return { host: text.slice(1, close), port: rest === '' ? null : rest.slice(1) };
  }
  const colon = text.indexOf(':');
  // Several colons without brackets are an IPv6 address without a port.
  if (colon < 0 || text.indexOf(':', colon + 1) >= 0) return { host: text, port: null };
  return { host: text.slice(0, colon), port: text.slice(colon + 1) };
}

function parseHost(text: string, address: Address): void {
  const split = splitHost(text);
  if (split === null || split.host === '' || numBytes(split.host) > MAX_HOST_BYTES) {
    throw invalid(`${quoted(text)} names no host`, FORMS);
  }
  if (!/^[!-~]*$/.test(split.host) || /[/?#@[\]\\"']/.test(split.host)) {
    throw invalid(`${quoted(split.host)} is not a host name`, FORMS);
  }
  address.host = split.host;
  if (split.port === null) return;
  const port = /^\d+$/.test(split.port) ? Number(split.port) : 0;
  if (port < 1 || port > 65535) throw invalid(`${quoted(split.port)} is not a port`, 'use a number from 1 to 65535');
  address.port = port;
}

function setTransport(value: ByteText, address: Address): void {
  if (value === 'shm') {
    throw unsupported('transport=shm is reserved for a later version', 'use transport=udp or transport=tcp');
  }
  if (value !== 'udp' && value !== 'tcp') {
    throw invalid(`transport=${quotedBytes(value)} is unknown`, 'use transport=udp or transport=tcp');
  }
  if (address.transport !== null) throw invalid('transport is stated twice');
  address.transport = value;
}

function setRate(value: ByteText, address: Address): void {
  const rate = NUMBER.test(value) ? Number(value) : NaN;
  if (!(rate > 0 && rate <= MAX_RATE_HZ)) {
    throw invalid(`rate=${quotedBytes(value)} is not a rate`, 'use a number of frames per second above 0, at most 1000');
  }
  if (address.maxRateHz !== 0) throw invalid('rate is stated twice');
  address.maxRateHz = rate;
}

function setToken(value: ByteText, address: Address): void {
  const text = value.length > MAX_PATH_BYTES ? null : plainText(value);
  if (value === '' || text === null) {
    throw invalid('the token is not a file name and not a token', "write token=FILE, with a file that 'furrow token new' made");
  }
  if (address.token !== '') throw invalid('token is stated twice');
  address.token = text;
}

function setFlag(key: string, value: ByteText): true {
  if (value !== '1') throw invalid(`${key}=${quotedBytes(value)} is unknown`, `use ${key}=1, or leave it out`);
  return true;
}

function fileName(key: string, value: ByteText, former: string): string {
  const text = value.length > MAX_PATH_BYTES ? null : plainText(value);
  if (value === '' || text === null) {
    throw invalid(`${key}=${quotedBytes(value)} is not a file name`, `write ${key}=FILE, with a file in PEM form`);
  }
  if (former !== '') throw invalid(`${key} is stated twice`);
  return text;
}

function setText(key: 'subject' | 'pattern', value: ByteText, address: Address): void {
  const most = key === 'subject' ? MAX_NAME_BYTES : MAX_PATTERN_BYTES;
  const text = value.length > most ? null : plainText(value);
  if (value === '' || text === null) {
    throw invalid(`${key}=${quotedBytes(value)} is invalid`,
      `use 1 to ${most} bytes of UTF-8 without control characters`);
  }
  if (key === 'subject') {
    if (address.subjects.length === MAX_SUBJECTS) throw invalid('too many subjects', `name at most ${MAX_SUBJECTS}`);
    address.subjects.push(text);
    return;
  }
  if (address.pattern !== '') throw invalid('pattern is stated twice', 'separate several globs by commas');
  address.pattern = text;
}

function setValue(item: string, address: Address): void {
  const equals = item.indexOf('=');
  const key = equals < 0 ? item : item.slice(0, equals);
  if (key === RESERVED_KEY) throw unsupported(`${key} is reserved for a later version`, 'leave it out');
  if (!KEYS.includes(key)) {
    throw invalid(`unknown key ${quoted(key)}`, 'use subject, pattern, rate, transport, token or tls');
  }
  const value = equals < 0 ? null : decodePercent(item.slice(equals + 1));
  if (value === null) {
    // A token must not end up in a log.
    throw invalid(`${quoted(key === 'token' ? key : item)} is not a value`, `write ${key}=VALUE, and a percent sign as %25`);
  }
  if (key === 'token') setToken(value, address);
  else if (key === 'transport') setTransport(value, address);
  else if (key === 'rate') setRate(value, address);
  else if (key === 'tls') address.tls = setFlag(key, value);
  else if (key === 'token-in-clear') address.tokenInClear = setFlag(key, value);
  else if (key === 'tls-authority') address.tlsAuthority = fileName(key, value, address.tlsAuthority);
  else if (key === 'tls-certificate') address.tlsCertificate = fileName(key, value, address.tlsCertificate);
  else if (key === 'tls-key') address.tlsKey = fileName(key, value, address.tlsKey);
  else setText(key as 'subject' | 'pattern', value, address);
}

/** What the values imply: tls=1 by the files of TLS, and TCP by tls=1. */
function complete(address: Address): void {
  if (address.tlsAuthority !== '' || address.tlsCertificate !== '' || address.tlsKey !== '') address.tls = true;
  if (!address.tls) return;
  if (address.transport === 'udp') throw invalid('TLS needs TCP', 'use transport=tcp, or a token, which encrypts UDP');
  if (address.tlsCertificate === '' && address.tlsKey !== '') throw invalid('tls-key needs tls-certificate', 'state both');
  address.transport = 'tcp';
}

/** Parses an address. Throws FurrowError: 'invalid-address', or 'unsupported' for what later versions reserve. */
export function parseAddress(text: string): Address {
  if (numBytes(text) > MAX_ADDRESS_BYTES) throw invalid('longer than 65536 bytes');
  const address: Address = { host: '', port: 0, transport: null, subjects: [], pattern: '', maxRateHz: 0, token: '',
    tls: false, tlsAuthority: '', tlsCertificate: '', tlsKey: '', tokenInClear: false };
  if (!text.startsWith(SCHEME)) {
    const end = text.indexOf('://');
    if (end >= 0) throw invalid(`unknown scheme ${quoted(text.slice(0, end))}`, 'use furrow://HOST');
    parseHost(text, address);
    return address;
  }
  const rest = text.slice(SCHEME.length);
  const question = rest.indexOf('?');
  const authority = question < 0 ? rest : rest.slice(0, question);
  parseHost(authority.endsWith('/') ? authority.slice(0, -1) : authority, address);
  const query = question < 0 ? '' : rest.slice(question + 1).replace(/(.)&$/, '$1');
  if (query !== '') for (const item of query.split('&')) setValue(item, address);
  complete(address);
  return address;
}
