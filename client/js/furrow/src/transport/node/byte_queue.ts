// SPDX-License-Identifier: Apache-2.0

/** Bytes of a stream that wait until a whole message has arrived. */
export class ByteQueue {
  private chunks: Uint8Array[] = [];
  private size = 0;

  push(chunk: Uint8Array): void {
    this.chunks.push(chunk);
    this.size += chunk.length;
  }

  /** The next `count` bytes, or null if there are fewer. They stay in the queue. */
  peek(count: number): Uint8Array | null {
    if (this.size < count) return null;
    // Joined once per message, not once per chunk: a large message comes in many chunks.
    if (this.chunks[0]!.length < count) this.chunks = [this.joined()];
    return this.chunks[0]!.subarray(0, count);
  }

  /** Takes the next `count` bytes as a copy, or null if there are fewer. */
  take(count: number): Uint8Array | null {
    const bytes = this.peek(count)?.slice() ?? null;
    if (bytes === null) return null;
    this.chunks[0] = this.chunks[0]!.subarray(count);
    this.size -= count;
    if (this.chunks[0].length === 0) this.chunks.shift();
    return bytes;
  }

  private joined(): Uint8Array {
    const all = new Uint8Array(this.size);
    let at = 0;
    for (const chunk of this.chunks) {
      all.set(chunk, at);
      at += chunk.length;
    }
    return all;
  }
}
