// SPDX-License-Identifier: Apache-2.0
// Decodes the video of one picture subscription: one picture in, one picture out.
import type { PictureMessage } from 'furrow/protocol';

/** A picture that takes longer is late. The daemon sends no more than two, so a decoder that keeps some would stop it. */
const LATE_MS = 1000;
const PATIENT_LATE_MS = 5000;
/** This many late pictures in a row are too many. */
const MOST_LATE = 2;

/** A decoder that has shown this many pictures works. If it fails then, the browser has taken it away. */
const WORKS = 30;
/** The name of the error of a browser that takes a decoder away, or has no more of them. */
const TAKEN_AWAY = 'QuotaExceededError';

/** 'lost': another decoder may go on. 'broken': this browser cannot decode the video. 'slow': it stays behind. */
export type VideoFailure = 'lost' | 'broken' | 'slow';

export interface VideoReaderEvents {
  /** Called once. */
  onFailed(failure: VideoFailure): void;
  /** Whether a decoder that is late is given up soon. */
  isImpatient(): boolean;
}

interface Waiting {
  resolve: (frame: VideoFrame | null) => void;
  timer: ReturnType<typeof setTimeout>;
}

export class VideoReader {
  private decoder: VideoDecoder | null = null;
  private codec = '';
  /** By the number of the picture. */
  private readonly waiting = new Map<number, Waiting>();
  private numLate = 0;
  private numShown = 0;
  private isOver = false;

  constructor(private readonly events: VideoReaderEvents) {}

  /** True once there was a key picture, so that others may follow. */
  get isReady(): boolean {
    return this.decoder !== null;
  }

  /**
   * Leave out the pictures that follow a lost one until there is a key picture. Null: the picture cannot be shown. The
   * receiver must close the frame.
   */
  decode(picture: PictureMessage): Promise<VideoFrame | null> {
    return new Promise((resolve) => {
      if (this.isOver) return resolve(null);
      try {
        if (picture.key) this.configure(picture.codec);
        this.waiting.set(picture.number, { resolve, timer: this.watch(picture.number) });
        this.decoder!.decode(new EncodedVideoChunk({
          type: picture.key ? 'key' : 'delta', timestamp: picture.number, data: picture.bytes,
        }));
      } catch (error) {
        resolve(null);
        this.fail(this.failureOf(error));
      }
    });
  }

  close(): void {
    this.isOver = true;
    const { decoder } = this;
    this.decoder = null;
    if (decoder !== null && decoder.state !== 'closed') decoder.close();
    for (const { resolve, timer } of this.waiting.values()) {
      clearTimeout(timer);
      resolve(null);
    }
    this.waiting.clear();
  }

  private configure(codec: string): void {
    if (this.decoder !== null && codec === this.codec) return; // another size needs no configuration
    this.decoder ??= new VideoDecoder({ output: (frame) => this.onFrame(frame), error: (error) => this.fail(this.failureOf(error)) });
    this.codec = codec;
    this.decoder.configure({
      codec,
      optimizeForLatency: true,
      // As in the parameter sets, which decoders in hardware do not always read.
      colorSpace: { primaries: 'bt709', transfer: 'iec61966-2-1', matrix: 'smpte170m', fullRange: false },
    });
  }

  private watch(number: number): ReturnType<typeof setTimeout> {
    const delayMs = this.events.isImpatient() ? LATE_MS : PATIENT_LATE_MS;
    const dueMs = performance.now() + delayMs;
    return setTimeout(() => {
      const found = this.waiting.get(number);
      if (found === undefined) return;
      // The page itself was busy, or is in the background, where browsers decode late or not at all.
      if (document.hidden || performance.now() > dueMs + delayMs / 2) found.timer = this.watch(number);
      else if (++this.numLate >= MOST_LATE) this.fail('slow');
    }, delayMs);
  }

  private onFrame(frame: VideoFrame): void {
    const found = this.waiting.get(frame.timestamp);
    if (found === undefined) {
      frame.close();
      return;
    }
    this.waiting.delete(frame.timestamp);
    clearTimeout(found.timer);
    this.numLate = 0;
    ++this.numShown;
    found.resolve(frame);
  }

  private failureOf(error: unknown): VideoFailure {
    return (error as Error | undefined)?.name === TAKEN_AWAY || this.numShown >= WORKS ? 'lost' : 'broken';
  }

  private fail(failure: VideoFailure): void {
    if (this.isOver) return;
    this.close();
    this.events.onFailed(failure);
  }
}
