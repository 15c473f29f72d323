// SPDX-License-Identifier: Apache-2.0
// Connect tokens (protocol/STANDARD.md section 14).
import { readFileSync } from 'node:fs';
import { TOKEN_PREFIX } from '../../../link/address.js';
import { FurrowError } from '../../../link/errors.js';

export const TOKEN_BYTES = 252;
const KEY_BYTES = 32;
const TEXT_BYTES = TOKEN_BYTES + KEY_BYTES + 4;
const TEXT = new RegExp(`^${TOKEN_PREFIX}[A-Za-z0-9_-]{${TEXT_BYTES * 4 / 3}}$`);

export interface Token {
  /** What travels. */
  bytes: Uint8Array;
  /** What proves it, and never travels. */
  key: Uint8Array;
}

/** The text of a token: `value` itself, or what the file of this name holds. Throws FurrowError. */
export function tokenText(value: string): string {
  if (value === '' || value.startsWith(TOKEN_PREFIX)) return value;
  let lines: string[];
  try {
    lines = readFileSync(value, 'utf8').split('\n');
  } catch (error) {
    throw new FurrowError('invalid-argument', `token: ${(error as Error).message}`);
  }
  const text = lines.map((line) => line.trim()).find((line) => line !== '' && !line.startsWith('#')) ?? '';
  if (!text.startsWith(TOKEN_PREFIX)) {
    throw new FurrowError('invalid-argument', `token: ${value} holds no token (make one with 'furrow token new')`);
  }
  return text;
}

/** Throws FurrowError, without repeating the text. The daemon finds out whether a character was changed. */
export function parseToken(text: string): Token {
  if (!TEXT.test(text)) {
    throw new FurrowError('invalid-argument', 'the token is damaged (copy it again, in one piece)');
  }
  const all = Buffer.from(text.slice(TOKEN_PREFIX.length), 'base64url');
  return { bytes: all.subarray(0, TOKEN_BYTES), key: all.subarray(TOKEN_BYTES, TOKEN_BYTES + KEY_BYTES) };
}
