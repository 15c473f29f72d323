// SPDX-License-Identifier: Apache-2.0
// One picture subscription: requests, updates, decoding and acknowledgements.
import { type Envelope, frameAck, type PictureMessage, type PictureRequest, readPicture, type ReplyMessage,
  type Subscriber, subscribePictures, type Subscription, updatePictures } from 'furrow/protocol';
import { Signal } from '../ui/signal';
import type { Connection } from '../wire/connection';

/** A decoded picture. The receiver must close the bitmap. */
export interface Picture extends Omit<PictureMessage, 'bytes'> {
  bitmap: ImageBitmap;
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
}

function sameView(a: PictureRequest | null, b: PictureRequest): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** Minimum time between two updates of the view. A drag makes about 100 changes per second. */
const UPDATE_MS = 33;

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

  request(): Uint8Array {
    this.answered = false;
    this.newestShown = 0;
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
    void this.decode(message.sequence, readPicture(message.payload));
  }

  private async decode(sequence: number, picture: PictureMessage): Promise<void> {
    const { bytes, ...rest } = picture;
    const { subscription } = this;
    let bitmap: ImageBitmap | null = null;
    const beganMs = performance.now();
    try {
      bitmap = await createImageBitmap(new Blob([bytes], { type: picture.mimeType }));
    } catch {
      // Undecodable pictures are acknowledged too, because the next picture may be valid.
    }
    subscription?.send(frameAck(picture.number));
    if (bitmap === null) return;
    // A newer picture was shown while this one was decoded, or the subscription has ended; another one counts from 1.
    if (subscription === null || this.subscription !== subscription || picture.number <= this.newestShown) {
      bitmap.close();
      return;
    }
    this.newestShown = picture.number;
    const behind = (this.wanted - picture.viewRequest) | 0;
    if (this.answered && behind <= 0 && this.timer === null) this.pending.set(false);
    this.events.onPicture({ ...rest, bitmap, sequence, numBytes: bytes.length, decodeMs: performance.now() - beganMs });
  }
}
