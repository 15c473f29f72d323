// SPDX-License-Identifier: Apache-2.0
// Secure datagrams in Node against the vectors of protocol/vectors/secure, and against damage.
import assert from 'node:assert/strict';
import { createPrivateKey, createPublicKey } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { FurrowError } from '../src/link/errors.js';
import { Initiator } from '../src/transport/node/secure/noise.js';
import { Opener, PACKET, Sealer } from '../src/transport/node/secure/packets.js';
import { SecureSession } from '../src/transport/node/secure/session.js';
import { parseToken, tokenText } from '../src/transport/node/secure/token.js';

const FOLDER = join(process.env.FURROW_SOURCE!, 'protocol/vectors/secure');
const read = (name: string): Buffer => readFileSync(join(FOLDER, name));
const VECTORS = JSON.parse(read('secure.json').toString()) as {
  token: { text: string; client_key: string };
  session: Record<'client_ephemeral' | 'client_key' | 'server_key' | 'hello', string> & { client_index: number; server_index: number };
  packets: { file: string; from: string; kind: 'data' | 'control'; inner: string }[];
};
const bytes = (hex: string): Buffer => Buffer.from(hex, 'hex');

function pairOf(secret: Buffer): { privateKey: ReturnType<typeof createPrivateKey>; publicKey: ReturnType<typeof createPublicKey> } {
  const head = bytes('302e020100300506032b656e04220420');
  const privateKey = createPrivateKey({ key: Buffer.concat([head, secret]), format: 'der', type: 'pkcs8' });
  return { privateKey, publicKey: createPublicKey(privateKey) };
}

test('the public vector of the handshake', () => {
  const vector = JSON.parse(read('noise_nnpsk0.json').toString()) as {
    init_prologue: string; init_psks: string[]; init_ephemeral: string; messages: { payload: string; ciphertext: string }[];
  };
  const initiator = new Initiator(bytes(vector.init_psks[0]!), bytes(vector.init_prologue), pairOf(bytes(vector.init_ephemeral)));
  const [first, second] = vector.messages;
  assert.equal(initiator.write(bytes(first!.payload)).toString('hex'), first!.ciphertext);
  const answer = bytes(second!.ciphertext);
  for (let i = 0; i < answer.length; ++i) {
    const damaged = Buffer.from(answer);
    damaged[i]! ^= 1;
    assert.equal(initiator.read(damaged), null);
  }
  assert.equal(initiator.read(answer)!.toString('hex'), second!.payload, 'a forged answer does not spoil the handshake');
});

test('the handshake and the packets of the standard', () => {
  const { session, token } = VECTORS;
  const initiation = read('initiation.bin');
  const head = initiation.subarray(0, 284);
  const initiator = new Initiator(bytes(token.client_key), Buffer.concat([Buffer.from('furrow secure 1\n'), head]),
    pairOf(bytes(session.client_ephemeral)));
  const hello = bytes(session.hello);
  const payload = Buffer.alloc(868);
  payload.writeUInt16LE(hello.length);
  payload.set(hello, 2);
  assert.deepEqual(Buffer.concat([head, initiator.write(payload)]), initiation);
  assert.equal(initiator.read(read('response.bin').subarray(8))!.readUInt32LE(), session.server_index);
  const { send, receive } = initiator.split();
  assert.equal(send.toString('hex'), session.client_key);
  assert.equal(receive.toString('hex'), session.server_key);
  // The keys change after every two packets there, which a sender of this library does after 2^24.
  const sealer = new Sealer(send, session.server_index, 0);
  for (const { file, kind, inner } of VECTORS.packets.filter(({ from }) => from === 'client').slice(0, 2)) {
    assert.deepEqual(sealer.seal(PACKET[kind], bytes(inner), 0), read(file));
  }
  for (const from of ['client', 'server'] as const) {
    const opener = new Opener(from === 'client' ? send : receive, from === 'client' ? session.server_index : session.client_index);
    for (const packet of VECTORS.packets.filter((each) => each.from === from)) {
      const sealed = read(packet.file);
      for (let i = 0; i < sealed.length; i += 7) {
        const damaged = Buffer.from(sealed);
        damaged[i]! ^= 0x20;
        assert.equal(opener.open(damaged, 0), null, `${packet.file}, byte ${i}`);
      }
      assert.deepEqual(opener.open(sealed, 0), { kind: PACKET[packet.kind], inner: bytes(packet.inner) }, packet.file);
      assert.equal(opener.open(sealed, 0), null, 'a packet counts once');
    }
  }
});

test('counters count once, in any order, back to 1,023', () => {
  const key = Buffer.alloc(32, 7);
  const sealer = new Sealer(key, 3, 0);
  const opener = new Opener(key, 3);
  const packets = Array.from({ length: 3000 }, (_, i) => sealer.seal(PACKET.data, Buffer.of(i & 255), 0));
  const opens = (i: number): boolean => opener.open(packets[i]!, 0) !== null;
  assert(opens(5) && opens(2) && !opens(5) && !opens(2));
  assert(opens(1100));
  assert(opens(77) && !opens(76) && !opens(77));
  assert(opens(2999) && !opens(1100) && opens(2998) && opens(1976) && !opens(1975));
});

test('tokens are read, and damaged ones are not repeated in messages', () => {
  const { text, client_key: key } = VECTORS.token;
  const token = parseToken(tokenText(text));
  assert.deepEqual(token.bytes, read('token.bin'));
  assert.deepEqual(token.key, bytes(key));
  for (const damaged of [text.slice(1), text.slice(0, -1), `${text}A`, `${text.slice(0, -1)}!`]) {
    assert.throws(() => parseToken(damaged), (error: unknown) => error instanceof FurrowError && !error.message.includes('RlJU'));
  }
  assert.throws(() => tokenText('/nowhere/a.token'), FurrowError);
});

test('nothing that a stranger sends moves a session', () => {
  const sent: Uint8Array[] = [];
  const ends: string[] = [];
  const session = new SecureSession(parseToken(VECTORS.token.text), {
    send: (packet) => sent.push(packet), onBegin: () => assert.fail('no session'), onDatagram: () => assert.fail('no datagram'),
    onEnd: (why) => ends.push(why),
  });
  session.tick(0);
  assert.equal(sent.length, 1);
  for (const name of ['retry.bin', 'response.bin', 'refused.bin', 'server_0.bin', 'token.bin', 'initiation.bin']) {
    const packet = read(name);
    for (let size = 0; size <= packet.length; ++size) session.received(packet.subarray(0, size), 1);
  }
  assert.equal(sent.length, 1, 'another index');
  assert.deepEqual(ends, []);
  session.tick(100);
  assert.equal(sent.length, 1);
  session.tick(200);
  assert.equal(sent.length, 2, 'the same bytes again');
  assert.deepEqual(sent[0], sent[1]);
});
