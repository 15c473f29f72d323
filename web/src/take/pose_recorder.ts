// SPDX-License-Identifier: Apache-2.0
// Puts the poses of one subject on a tape, as the daemon sends them.
import { type Envelope, readDropped, type ReplyMessage, type Subscriber, subscribePoses, type Subscription } from 'furrow/protocol';
import type { Connection } from '../wire/connection';
import type { PoseTape } from './pose_tape';

export class PoseRecorder implements Subscriber {
  private readonly subscription: Subscription;
  private publisherSession = 0n;
  /** What the daemon said last. It counts from 0 in each connection. */
  private reported = 0;

  /** `onEnd`: the tape is full, or the daemon refuses; `refusal` is empty for a full tape. Called at most once. */
  constructor(connection: Connection, private readonly tape: PoseTape, private onEnd: (refusal: string) => void) {
    this.subscription = connection.subscribe(this);
  }

  close(): void {
    this.onEnd = () => {};
    this.subscription.close();
  }

  request(): Uint8Array {
    this.reported = 0;
    return subscribePoses({ subject: this.tape.subject, every: true });
  }

  onReply(reply: ReplyMessage): void {
    this.publisherSession = reply.publisherSession;
  }

  onMessage({ identifier, payload, sequence, captureTimeUs }: Envelope): void {
    if (identifier === 'FDRP') return this.onDropped(readDropped(payload));
    const isKept = identifier === 'FSKO' ? this.tape.addSkeleton(this.publisherSession, payload)
      : identifier !== 'FPOS' || this.tape.addPose({ atS: performance.now() / 1000, sequence, captureTimeUs, payload });
    if (!isKept) this.end('');
  }

  private onDropped(total: number): void {
    this.tape.numDropped += total - this.reported;
    this.reported = total;
  }

  onGone(): void {}

  onRefused(_code: number, message: string): void {
    this.end(message);
  }

  private end(refusal: string): void {
    const { onEnd } = this;
    this.onEnd = () => {};
    onEnd(refusal);
  }
}
