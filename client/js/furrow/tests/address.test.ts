// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { type Address, parseAddress } from '../src/link/address.js';
import { FurrowError } from '../src/link/errors.js';

interface Case {
  text: string;
  error?: string;
  code?: string;
  host: string;
  port: number;
  transport: string;
  subjects: string[];
  pattern: string;
  rate: number;
  token?: string;
  tls?: boolean;
  'tls-authority'?: string;
  'tls-certificate'?: string;
  'tls-key'?: string;
  'token-in-clear'?: boolean;
}

test('addresses and messages are those of every Furrow client', () => {
  const path = join(process.env.FURROW_SOURCE!, 'tests/unit/client/addresses.json');
  const cases = JSON.parse(readFileSync(path, 'utf8')) as Case[];
  assert(cases.length > 50);
  for (const expected of cases) {
    if (expected.error !== undefined) {
      assert.throws(() => parseAddress(expected.text), (error: unknown) => error instanceof FurrowError &&
        error.message === expected.error && error.code === expected.code, expected.text);
      continue;
    }
    const { host, port, transport, subjects, pattern, maxRateHz, token }: Address = parseAddress(expected.text);
    assert.deepEqual([host, port, transport ?? '', subjects, pattern, maxRateHz, token],
      [expected.host, expected.port, expected.transport, expected.subjects, expected.pattern, expected.rate,
        expected.token ?? ''], expected.text);
    const { tls, tlsAuthority, tlsCertificate, tlsKey, tokenInClear } = parseAddress(expected.text);
    assert.deepEqual([tls, tlsAuthority, tlsCertificate, tlsKey, tokenInClear],
      [expected.tls ?? false, expected['tls-authority'] ?? '', expected['tls-certificate'] ?? '',
        expected['tls-key'] ?? '', expected['token-in-clear'] ?? false], expected.text);
  }
});

test('a token does not end up in a message', () => {
  for (const text of ['furrow://a?token=secret%', 'furrow://a?token=secret&token=secret', 'furrow://a?token=secret%0A']) {
    assert.throws(() => parseAddress(text), (error: Error) => !error.message.includes('secret'));
  }
});

test('sizes are bounded', () => {
  const longest = 'a'.repeat(255);
  assert.deepEqual(parseAddress(`furrow://h?subject=${longest}`).subjects, [longest]);
  assert.throws(() => parseAddress(`furrow://h?subject=a${longest}`), FurrowError);
  assert.throws(() => parseAddress(`${longest}h`), FurrowError);
  assert.throws(() => parseAddress(`furrow://h?pattern=${'*'.repeat(4097)}`), FurrowError);
  const many = `furrow://h?subject=a${'&subject=a'.repeat(255)}`;
  assert.equal(parseAddress(many).subjects.length, 256);
  assert.throws(() => parseAddress(`${many}&subject=a`), FurrowError);
  assert.throws(() => parseAddress('&'.repeat(1 << 20)), FurrowError);
});
