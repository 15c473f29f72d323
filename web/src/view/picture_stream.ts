// SPDX-License-Identifier: Apache-2.0
// One picture subscription: requests, updates, decoding and acknowledgements.
import { type Envelope, frameAck, type PictureMessage, type PictureRequest, readPicture, type ReplyMessage,
  type Subscriber, subscribePictures, type Subscription, updatePictures } from 'furrow/protocol';
import { Signal } from '../ui/signal';
import type { Connection } from '../wire/connection';
import { VideoReader, type VideoReaderEvents } from './video_reader';

/** A decoded picture. The receiver must close the bitmap, which may have a column or row more than the picture. */
export interface Picture extends Omit<PictureMessage, 'bytes'> {
  bitmap: ImageBitmap | VideoFrame;
  /** Of the pose. */
  sequence: number;
  numBytes: number;
  /** Time that decoding took. */
  decodeMs: number;
}

export interface PictureEvents {
  onPicture(picture: Picture): void;
  /** The daemon rejected the request. `error` is its sentence. */
  onRefused(code: number, error: string): void;
  /** For requests that list codecs. Lost decoders are replaced; after too many, onFailed() reports 'broken'. */
  video?: VideoReaderEvents;
}

function sameView(a: PictureRequest | null, b: PictureRequest): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** Minimum time between two updates of the view. A drag makes about 100 changes per second. */
const UPDATE_MS = 33;

/** A browser that loses this many decoders within a minute would lose the next one, too. */
const MOST_LOSSES = 3;
const LOSSES_MS = 60_000;

export class PictureStream implements Subscriber {
  /** True until a picture shows the last requested change. */
  readonly pending = new Signal(true);
  private subscription: Subscription | null = null;
  private answered = false;
  private newestShown = 0;
  private wanted = 0;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private lastUpdateMs = -Infinity;
  /** The last request sent to the daemon. */
  private asked: PictureRequest | null = null;
  /** The number of the last picture, to notice a lost one. */
  private last = 0;
  private reader: VideoReader | null = null;
  /** The pictures of the video cannot be decoded until there is a key picture. */
  private needsKey = false;
  /** When decoders were lost. */
  private lossesMs: number[] = [];

  constructor(
    private readonly connection: Connection,
    private wantedView: PictureRequest,
    private readonly events: PictureEvents,
  ) {}

  start(): void {
    this.pending.set(true);
    this.subscription ??= this.connection.subscribe(this);
  }

  stop(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    this.subscription?.close();
    this.subscription = null;
    this.answered = false;
    this.closeReader();
  }

  get view(): PictureRequest {
    return this.wantedView;
  }

  /** Changes the view. Another subject needs a new subscription. */
  update(view: PictureRequest): void {
    const former = this.wantedView;
    if (sameView(former, view)) return;
    this.wantedView = view;
    this.pending.set(true);
    if (this.subscription === null) return;
    if (former.subject !== view.subject) {
      this.stop();
      this.start();
      return;
    }
    if (this.timer !== null) return;
    const wait = Math.max(0, this.lastUpdateMs + UPDATE_MS - performance.now());
    this.timer = setTimeout(() => this.sendUpdate(), wait);
  }

  /** Subscribes again, for example after a rejection. */
  restart(view: PictureRequest): void {
    this.wantedView = view;
    this.stop();
    this.start();
  }

  private sendUpdate(): void {
    this.timer = null;
    this.lastUpdateMs = performance.now();
    // The daemon has not replied yet. Its reply triggers an update to the view that is current then.
    if (!this.answered) return;
    if (sameView(this.asked, this.wantedView)) {
      this.pending.set(false); // the view is back at the last request, so no new picture will follow
      return;
    }
    this.asked = this.wantedView;
    this.wanted = this.subscription?.send(updatePictures(this.wantedView)) ?? this.wanted;
  }

  private closeReader(): void {
    this.reader?.close();
    this.reader = null;
  }

  request(): Uint8Array {
    this.answered = false;
    this.newestShown = this.last = 0;
    this.needsKey = false;
    this.closeReader();
    this.asked = this.wantedView;
    return subscribePictures(this.wantedView);
  }

  onReply(_reply: ReplyMessage, requestSequence: number): void {
    if (this.answered) return;
    this.answered = true;
    this.wanted = requestSequence;
    if (!sameView(this.asked, this.wantedView)) this.sendUpdate();
  }

  onRefused(code: number, message: string, sequence: number): void {
    if (sequence === this.wanted) this.pending.set(false);
    this.events.onRefused(code, message);
  }

  onGone(): void {}

  onMessage(message: Envelope): void {
    if (message.identifier !== 'FIMG') return;
    void this.show(message.sequence, readPicture(message.payload));
  }

  private async show(sequence: number, picture: PictureMessage): Promise<void> {
    const { subscription } = this;
    const beganMs = performance.now();
    const bitmap = await this.decode(picture);
    const decodeMs = performance.now() - beganMs;
    // Undecodable pictures are acknowledged too, because the next picture may be valid.
    subscription?.send(frameAck(picture.number, { needsKey: this.needsKey, heldUs: 1000 * decodeMs }));
    if (bitmap === null) return;
    // A newer picture was shown while this one was decoded, or the subscription has ended; another one counts from 1.
    if (subscription === null || this.subscription !== subscription || picture.number <= this.newestShown) {
      bitmap.close();
      return;
    }
    this.newestShown = picture.number;
    const behind = (this.wanted - picture.viewRequest) | 0;
    if (this.answered && behind <= 0 && this.timer === null) this.pending.set(false);
    const { bytes, ...rest } = picture;
    this.events.onPicture({ ...rest, bitmap, sequence, numBytes: bytes.length, decodeMs });
  }

  /** Null: it cannot be shown. */
  private async decode(picture: PictureMessage): Promise<ImageBitmap | VideoFrame | null> {
    const follows = picture.number === (this.last + 1) >>> 0;
    this.last = picture.number;
    if (!follows) this.needsKey = true;
    if (picture.codec === '') {
      try {
        return await createImageBitmap(new Blob([picture.bytes], { type: picture.mimeType }));
      } catch {
        return null;
      }
    }
    const { video } = this.events;
    if (video === undefined) return null; // not asked for
    this.reader ??= this.makeReader(video);
    if (picture.key) this.needsKey = false;
    else if (!this.reader.isReady) this.needsKey = true;
    return this.needsKey ? null : this.reader.decode(picture);
  }

  /** Counts a lost decoder. */
  private losesTooMany(): boolean {
    const nowMs = performance.now();
    this.lossesMs = [...this.lossesMs.filter((atMs) => atMs > nowMs - LOSSES_MS), nowMs];
    if (this.lossesMs.length < MOST_LOSSES) return false;
    this.lossesMs = [];
    return true;
  }

  private makeReader(video: VideoReaderEvents): VideoReader {
    return new VideoReader({
      isImpatient: video.isImpatient,
      onFailed: (failure) => {
        this.reader = null;
        this.needsKey = true;
        if (failure !== 'lost') video.onFailed(failure);
        else if (this.losesTooMany()) video.onFailed('broken');
      },
    });
  }
}
