// SPDX-License-Identifier: Apache-2.0

/** What orders the frames of a subject. */
export interface FrameOrder {
  sequence: number;
  captureTimeUs: bigint;
}

const MOST_FRAMES = 64;
const MOST_MS = 200;

/**
 * True if a frame is older than the newest one, or a repetition of it: datagrams overtake each other, by 64 frames and
 * 200 ms at most. An older frame beyond that comes from a publisher that has restarted and counts from 0 again.
 */
export function isLate(frame: FrameOrder, newest: FrameOrder, elapsedMs: number): boolean {
  if (elapsedMs > MOST_MS || frame.captureTimeUs > newest.captureTimeUs) return false;
  return (newest.sequence - frame.sequence) >>> 0 <= MOST_FRAMES;
}
