// SPDX-License-Identifier: Apache-2.0
// The initiator of Noise_NNpsk0_25519_ChaChaPoly_SHA256 (Noise, revision 34) over Node's primitives.
import {
  createCipheriv, createDecipheriv, createHash, createHmac, createPublicKey, diffieHellman, generateKeyPairSync, type KeyObject,
} from 'node:crypto';

const NAME = 'Noise_NNpsk0_25519_ChaChaPoly_SHA256';
export const KEY_BYTES = 32;
export const TAG_BYTES = 16;
/** What precedes the 32 bytes of a public key of X25519 in a SubjectPublicKeyInfo (RFC 8410). */
const SPKI_HEAD = Buffer.from('302a300506032b656e032100', 'hex');
const CIPHER = 'chacha20-poly1305';
const NO_BYTES: Buffer = Buffer.alloc(0);

export type Bytes = Uint8Array;

/** 4 zero bytes and the counter, little-endian. */
function nonceOf(counter: bigint): Buffer {
  const nonce = Buffer.alloc(12);
  nonce.writeBigUInt64LE(counter, 4);
  return nonce;
}

/** The sealed text, followed by its tag. */
export function seal(key: Bytes, counter: bigint, associated: Bytes, text: Bytes): Buffer {
  const cipher = createCipheriv(CIPHER, key, nonceOf(counter), { authTagLength: TAG_BYTES });
  cipher.setAAD(associated, { plaintextLength: text.length });
  return Buffer.concat([cipher.update(text), cipher.final(), cipher.getAuthTag()]);
}

/** The text of `sealed`, or null if its tag is wrong. */
export function open(key: Bytes, counter: bigint, associated: Bytes, sealed: Bytes): Buffer | null {
  const size = sealed.length - TAG_BYTES;
  if (size < 0) return null;
  const decipher = createDecipheriv(CIPHER, key, nonceOf(counter), { authTagLength: TAG_BYTES });
  decipher.setAAD(associated, { plaintextLength: size });
  decipher.setAuthTag(sealed.subarray(size));
  const text = decipher.update(sealed.subarray(0, size));
  try {
    decipher.final();
  } catch {
    return null;
  }
  return text;
}

const hash = (...parts: Bytes[]): Buffer => {
  const sha = createHash('sha256');
  for (const part of parts) sha.update(part);
  return sha.digest();
};

/** The outputs of Noise's HKDF (section 4.3). */
function hkdf(chainingKey: Bytes, material: Bytes, count: 2 | 3): Buffer[] {
  const hmac = (key: Bytes, ...parts: Bytes[]): Buffer => {
    const mac = createHmac('sha256', key);
    for (const part of parts) mac.update(part);
    return mac.digest();
  };
  const temporary = hmac(chainingKey, material);
  const outputs: Buffer[] = [];
  let last: Buffer = NO_BYTES;
  for (let i = 1; i <= count; ++i) outputs.push(last = hmac(temporary, last, Buffer.of(i)));
  return outputs;
}

/** Makes the first message, reads the second one, and gives the keys of both directions. */
export class Initiator {
  private h = hash(Buffer.from(NAME));
  private chainingKey = this.h;
  private key: Buffer = NO_BYTES;
  private nonce = 0n;

  /** `pair`: of tests; a message must have a key pair of its own. */
  constructor(psk: Bytes, prologue: Bytes, private readonly pair = generateKeyPairSync('x25519')) {
    this.mixHash(prologue);
    const [next, hashed, key] = hkdf(this.chainingKey, psk, 3) as [Buffer, Buffer, Buffer];
    this.chainingKey = next;
    this.mixHash(hashed);
    this.setKey(key);
  }

  write(payload: Bytes): Buffer {
    const own = this.pair.publicKey.export({ type: 'spki', format: 'der' }).subarray(-KEY_BYTES);
    this.mixHash(own);
    this.mixKey(own);
    const sealed = seal(this.key, this.nonce++, this.h, payload);
    this.mixHash(sealed);
    return Buffer.concat([own, sealed]);
  }

  /** The payload, or null if the message is not valid. Nothing changes then, so that a later one may be. */
  read(message: Bytes): Buffer | null {
    if (message.length < KEY_BYTES + TAG_BYTES) return null;
    const before = [this.h, this.chainingKey, this.key, this.nonce] as const;
    const payload = this.tryRead(message);
    if (payload === null) [this.h, this.chainingKey, this.key, this.nonce] = before;
    return payload;
  }

  private tryRead(message: Bytes): Buffer | null {
    const other = message.subarray(0, KEY_BYTES);
    const sealed = message.subarray(KEY_BYTES);
    this.mixHash(other);
    this.mixKey(other);
    const shared = agree(this.pair.privateKey, other);
    if (shared === null) return null;
    this.mixKey(shared);
    const payload = open(this.key, this.nonce, this.h, sealed);
    if (payload !== null) this.mixHash(sealed);
    return payload;
  }

  split(): { send: Buffer; receive: Buffer } {
    const [send, receive] = hkdf(this.chainingKey, NO_BYTES, 2) as [Buffer, Buffer];
    return { send, receive };
  }

  private mixHash(data: Bytes): void {
    this.h = hash(this.h, data);
  }

  private mixKey(material: Bytes): void {
    const [next, key] = hkdf(this.chainingKey, material, 2) as [Buffer, Buffer];
    this.chainingKey = next;
    this.setKey(key);
  }

  private setKey(key: Buffer): void {
    this.key = key;
    this.nonce = 0n;
  }
}

/** X25519; null for a public key of low order, which would give a result that anybody knows. */
function agree(privateKey: KeyObject, other: Bytes): Buffer | null {
  try {
    const publicKey = createPublicKey({ key: Buffer.concat([SPKI_HEAD, other]), format: 'der', type: 'spki' });
    const shared = diffieHellman({ privateKey, publicKey });
    return shared.every((byte) => byte === 0) ? null : shared;
  } catch {
    return null;
  }
}
