// SPDX-License-Identifier: Apache-2.0
// 64-bit FNV-1a (protocol/STANDARD.md section 6).

const ENCODER = new TextEncoder();
const ZERO = new Uint8Array(1);

/** Two halves of 32 bits, because bigints would be slow per byte. All products stay below 2^53. */
export class Fnv64 {
  private high = 0xcbf29ce4;
  private low = 0x84222325;

  add(bytes: Uint8Array): this {
    let { high, low } = this;
    for (const byte of bytes) {
      low = (low ^ byte) >>> 0;
      // Times the prime 2^40 + 0x1b3.
      const product = low * 0x1b3;
      high = (high * 0x1b3 + Math.floor(product / 2 ** 32) + low * 256) % 2 ** 32;
      low = product >>> 0;
    }
    this.high = high;
    this.low = low;
    return this;
  }

  /** A text and the zero byte behind it. */
  addName(name: string): this {
    return this.add(ENCODER.encode(name)).add(ZERO);
  }

  get value(): bigint {
    return (BigInt(this.high) << 32n) | BigInt(this.low);
  }
}

/** The hash of a list of names, which weights carry; 0 for an empty list. */
export function namesHash(names: readonly string[]): bigint {
  if (names.length === 0) return 0n;
  const hash = new Fnv64();
  for (const name of names) hash.addName(name);
  return hash.value;
}
