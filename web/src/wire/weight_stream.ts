// SPDX-License-Identifier: Apache-2.0
// The subscription of one subject's wrinkle weights.
import { type Envelope, readWeights, type ReplyMessage, type Subscriber, subscribeWeights, type Subscription } from 'furrow/protocol';
import type { WeightHistory } from '../state/weight_history';
import { Signal } from '../ui/signal';
import type { Connection } from './connection';

const MAX_RATE_HZ = 120;

export class WeightStream implements Subscriber {
  /** The watched subject; empty while there is none. */
  readonly subject = new Signal('');
  readonly error = new Signal('');
  private subscription: Subscription;
  private namesHash = 0n;

  constructor(
    private readonly connection: Connection,
    private wanted: string,
    readonly history: WeightHistory,
    private readonly onFrame: () => void,
    private readonly onMoved: (web: string) => void,
  ) {
    this.subscription = connection.subscribe(this);
  }

  /** Empty: the oldest live subject. */
  choose(subject: string): void {
    if (subject === this.wanted) return;
    this.wanted = subject;
    this.subscription.close();
    this.history.clear();
    this.subscription = this.connection.subscribe(this);
  }

  request(): Uint8Array {
    return subscribeWeights({ subject: this.wanted, maxRateHz: MAX_RATE_HZ });
  }

  onReply(reply: ReplyMessage): void {
    this.error.set('');
    if (reply.subject !== this.subject.value) this.history.clear();
    this.namesHash = reply.namesHash;
    this.history.setNames(reply.names);
    this.subject.set(reply.subject);
  }

  onMessage(message: Envelope): void {
    if (message.identifier !== 'FWGT') return;
    const weights = readWeights(message.payload);
    if (weights.namesHash !== this.namesHash) return; // the reply with the new names has not arrived yet
    this.history.add({
      sequence: message.sequence,
      atS: performance.now() / 1000,
      values: weights.values,
      timecode: weights.timecode,
    });
    this.onFrame();
  }

  onGone(): void {
    this.subject.set('');
  }

  /** The user chose this subject, so the page goes where it is. */
  onElsewhere(web: string): void {
    if (this.wanted !== '') this.onMoved(web);
  }

  onRefused(_code: number, message: string): void {
    this.error.set(message);
  }
}
