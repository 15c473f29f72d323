// SPDX-License-Identifier: Apache-2.0
// The newest weights of one subject.
import { ERROR, type Connection, type Subscriber, type Subscription } from '../link/connection.js';
import type { Envelope } from '../wire/envelope.js';
import { readWeights, type ReplyMessage } from '../wire/replies.js';
import { subscribeWeights, type WeightsRequest } from '../wire/requests.js';
import type { Timecode } from '../wire/timecode.js';
import { type FrameOrder, isLate } from './reordering.js';

/** The weights of one moment. The arrays belong to the library and never change. */
export interface WeightFrame {
  subject: string;
  /** `<region>.<map>`, "brow_l.squash". The same array while `layout` is the same. */
  names: readonly string[];
  /** Each in [0, 1], in the order of `names`. */
  values: Float32Array;
  /** Equal layouts mean equal names in equal order, also in other programs and after a restart. */
  layout: bigint;
  /** Number of the pose, as its publisher counts; wraps around after 2^32. */
  sequence: number;
  /** Frames received so far; differs if this is a new frame. */
  number: number;
  /** Poses without a frame so far: lost on the way, or skipped by the rate. */
  missed: number;
  /** When the pose was captured, microseconds on the publisher's clock. */
  captureTimeUs: bigint;
  /** SMPTE timecode of the pose; null: its source sends none. */
  timecode: Timecode | null;
  /** Time without a new pose, milliseconds: at the daemon and since then. */
  ageMs: number;
  /** No new pose arrives: the daemon holds the weights, then fades them to 0. */
  decaying: boolean;
  /** The subject has left; these are its last weights. */
  gone: boolean;
}

/** Why there are no weights: nothing has arrived yet, or the daemon rejected the request. */
export type FeedProblem = 'no-data' | 'no-match' | 'limit' | 'needs-token' | 'not-permitted' | 'rejected';

const PROBLEMS = new Map<number, FeedProblem>([
  [ERROR.noMatch, 'no-match'], [ERROR.limit, 'limit'], [ERROR.needsToken, 'needs-token'],
  [ERROR.notPermitted, 'not-permitted'],
]);

export interface WeightFeedEvents {
  /** The names have changed. */
  onLayout(): void;
  onFrame(): void;
  /** The subject has left. */
  onGone(): void;
  onProblem(problem: FeedProblem, message: string): void;
}

/** A rejected subscription is requested again, because the daemon's rig may change. */
const RETRY_MS = 2000;
/** A larger gap is a restart, not a loss. */
const MOST_MISSED = 100_000;

interface Newest extends FrameOrder {
  values: Float32Array;
  timecode: Timecode | null;
  ageMs: number;
  receivedMs: number;
}

export class WeightFeed implements Subscriber {
  private readonly subscription: Subscription;
  private subjectName: string;
  private layoutNames: readonly string[] = [];
  private layoutHash = 0n;
  private newest: Newest | null = null;
  private isGone = false;
  private number = 0;
  private missed = 0;
  private failed: FeedProblem | null = null;
  private cancelRetry: () => void = () => {};

  constructor(
    private readonly connection: Connection,
    readonly wanted: WeightsRequest,
    private readonly events: WeightFeedEvents,
  ) {
    this.subjectName = wanted.subject;
    this.subscription = connection.subscribe(this);
  }

  /** The name that was asked for, or the name that the daemon chose; empty until then. */
  get subject(): string {
    return this.subjectName;
  }

  /** Names and layout are known before the first frame. */
  get names(): readonly string[] {
    return this.layoutNames;
  }

  get layout(): bigint {
    return this.layoutHash;
  }

  get problem(): FeedProblem | null {
    return this.failed ?? (this.newest === null ? 'no-data' : null);
  }

  /** The newest weights; null before the first frame. */
  frame(): WeightFrame | null {
    const { newest } = this;
    if (newest === null) return null;
    return {
      subject: this.subjectName,
      names: this.layoutNames,
      values: newest.values,
      layout: this.layoutHash,
      sequence: newest.sequence,
      number: this.number,
      missed: this.missed,
      captureTimeUs: newest.captureTimeUs,
      timecode: newest.timecode,
      ageMs: newest.ageMs + Math.max(0, this.connection.nowMs() - newest.receivedMs),
      decaying: newest.ageMs > 0,
      gone: this.isGone,
    };
  }

  close(): void {
    this.cancelRetry();
    this.subscription.close();
  }

  asksFor(): string {
    return this.wanted.subject;
  }

  request(): Uint8Array {
    return subscribeWeights(this.wanted);
  }

  onReply(reply: ReplyMessage): void {
    this.failed = null;
    this.cancelRetry();
    if (reply.subject !== '') this.subjectName = reply.subject;
    if (reply.names.length === 0) return; // the subject is absent
    this.isGone = false;
    if (reply.namesHash === this.layoutHash) return;
    this.layoutHash = reply.namesHash;
    this.layoutNames = Object.freeze(reply.names);
    this.newest = null;
    this.events.onLayout();
  }

  onMessage(message: Envelope): void {
    if (message.identifier !== 'FWGT') return;
    const weights = readWeights(message.payload);
    if (weights.namesHash !== this.layoutHash || weights.values.length !== this.layoutNames.length) {
      this.subscription.repeat(); // the reply with the names was lost
      return;
    }
    const ageMs = weights.ageUs / 1000;
    if (this.isLate(message, ageMs)) return;
    const ahead = this.newest === null ? 0 : (message.sequence - this.newest.sequence) >>> 0;
    if (ahead > 1 && ahead <= MOST_MISSED) this.missed += ahead - 1;
    this.newest = {
      values: weights.values,
      timecode: weights.timecode,
      sequence: message.sequence,
      captureTimeUs: message.captureTimeUs,
      ageMs,
      receivedMs: this.connection.nowMs(),
    };
    this.isGone = false;
    ++this.number;
    this.events.onFrame();
  }

  private isLate(message: Envelope, ageMs: number): boolean {
    const { newest } = this;
    if (newest === null || !isLate(message, newest, this.connection.nowMs() - newest.receivedMs)) return false;
    // While no pose arrives, frames repeat the last one with a growing age.
    return message.sequence !== newest.sequence || ageMs <= newest.ageMs;
  }

  onGone(): void {
    this.isGone = true;
    this.events.onGone();
  }

  onRefused(code: number, message: string): void {
    this.failed = PROBLEMS.get(code) ?? 'rejected';
    this.cancelRetry();
    this.cancelRetry = this.connection.after(RETRY_MS, () => this.subscription.askAgain());
    this.events.onProblem(this.failed, message);
  }
}
