// SPDX-License-Identifier: Apache-2.0
// A client of furrowd: the weights and poses of several subjects over one connection.
import { parseAddress } from '../link/address.js';
import { Connection, type ConnectionOptions } from '../link/connection.js';
import { FurrowError } from '../link/errors.js';
import type { TransportOpener } from '../transport/transport.js';
import { PoseFeed, type PoseFrame } from './pose_feed.js';
import { type FeedProblem, WeightFeed, type WeightFrame } from './weight_feed.js';

const MAX_SUBJECTS = 256;
const MAX_NAME_BYTES = 255;
const MAX_PATTERN_BYTES = 4096;
const MAX_RATE_HZ = 1000;

/** What to follow. */
export interface SubscriptionRequest {
  /** Absent or empty: the oldest subject that is connected. It need not be connected yet. */
  subject?: string;
  /** Names of weights, as comma-separated globs (default: all). */
  pattern?: string;
  /** Most frames per second, at most 1000 (default: every pose). */
  rate?: number;
  /** Also the subject's poses (default: false). */
  poses?: boolean;
  /** A quarter of the bytes; the error is at most 1/510 (default: false). */
  eightBit?: boolean;
  /** Driver values, before modulation and filter, instead of wrinkle weights (default: false). */
  drivers?: boolean;
}

export interface OpenOptions extends ConnectionOptions, Omit<SubscriptionRequest, 'subject' | 'pattern' | 'rate'> {
  /** Do not subscribe to what the address names; call subscribe() (default: true). */
  subscribe?: boolean;
}

/** Connected: the daemon has answered. Disconnected: the connection was lost; the client tries again. */
export type ClientState = 'connecting' | 'connected' | 'disconnected';

/** Events and the arguments of their listeners. */
export interface ClientEvents {
  /** Every new set of weights. */
  weights: [frame: WeightFrame];
  /** Every new pose of a subscription with `poses`. */
  pose: [pose: PoseFrame];
  /** The weights of a subject have other names, or another order. Arrives before the first frame, too. */
  layout: [subject: string, names: readonly string[]];
  /** The subject has left. Its subscription waits for it. */
  gone: [subject: string];
  state: [state: ClientState];
  /** The daemon rejected a request. The client asks again every 2 s. */
  problem: [subject: string, problem: FeedProblem, message: string];
}

interface Followed {
  weights: WeightFeed;
  poses: PoseFeed | null;
}

export class Client {
  private readonly connection: Connection;
  private readonly followed: Followed[] = [];
  private readonly listeners: { [K in keyof ClientEvents]: Set<(...args: ClientEvents[K]) => void> } = {
    weights: new Set(), pose: new Set(), layout: new Set(), gone: new Set(), state: new Set(), problem: new Set(),
  };

  /** Programs call open() instead. */
  constructor(opener: TransportOpener, options: ConnectionOptions = {}) {
    this.connection = new Connection(opener, options);
    let former = this.state;
    this.connection.onState(() => {
      if (this.state === former) return; // such as a second attempt that fails
      former = this.state;
      this.emit('state', former);
    });
  }

  get state(): ClientState {
    switch (this.connection.state) {
      case 'connecting':
        return 'connecting';
      case 'lost':
        return this.connects > 0 ? 'disconnected' : 'connecting';
      default:
        return 'connected';
    }
  }

  /** How often the daemon was reached; above 1: after losses. */
  get connects(): number {
    return this.connection.connects;
  }

  /** Messages that were dropped because they were malformed. */
  get malformed(): number {
    return this.connection.malformed;
  }

  /** Why there is no connection; empty if nobody said. */
  get lastFailure(): string {
    return this.connection.lastFailure;
  }

  /** Calls `listener` on every event. Returns a function that removes it. Listeners should not throw. */
  on<K extends keyof ClientEvents>(event: K, listener: (...args: ClientEvents[K]) => void): () => void {
    this.listeners[event].add(listener);
    return () => this.listeners[event].delete(listener);
  }

  private emit<K extends keyof ClientEvents>(event: K, ...args: ClientEvents[K]): void {
    for (const listener of [...this.listeners[event]]) listener(...args);
  }

  /** Follows one more subject. Throws FurrowError if it is followed already, or if the request is invalid. */
  subscribe(request: SubscriptionRequest = {}): void {
    const { subject = '', pattern = '', rate = 0 } = request;
    checkText('subject', subject, MAX_NAME_BYTES);
    checkText('pattern', pattern, MAX_PATTERN_BYTES);
    if (!(rate >= 0 && rate <= MAX_RATE_HZ)) {
      throw new FurrowError('invalid-argument', 'rate is outside 0 to 1000');
    }
    if (this.followed.length === MAX_SUBJECTS) {
      throw new FurrowError('invalid-argument', 'too many subscriptions (open another connection)');
    }
    if (this.followed.some(({ weights }) => weights.wanted.subject === subject)) {
      throw new FurrowError('invalid-argument', `the subject '${subject}' is subscribed already (unsubscribe it first)`);
    }
    const wanted = { subject, pattern, maxRateHz: rate, eightBit: request.eightBit ?? false, drivers: request.drivers ?? false };
    this.followed.push({
      weights: this.openWeights(wanted),
      poses: request.poses ? this.openPoses(subject, rate) : null,
    });
  }

  private openWeights(wanted: ConstructorParameters<typeof WeightFeed>[1]): WeightFeed {
    const feed: WeightFeed = new WeightFeed(this.connection, wanted, {
      onLayout: () => this.emit('layout', feed.subject, feed.names),
      onFrame: () => this.emit('weights', feed.frame()!),
      onGone: () => this.emit('gone', feed.subject),
      onProblem: (problem, message) => this.emit('problem', feed.subject, problem, message),
    });
    return feed;
  }

  private openPoses(subject: string, maxRateHz: number): PoseFeed {
    const feed: PoseFeed = new PoseFeed(this.connection, { subject, maxRateHz }, {
      onPose: () => this.emit('pose', feed.pose()!),
      onProblem: (message) => this.emit('problem', subject, 'rejected', message),
    });
    return feed;
  }

  /** Ends a subscription. False: there is none to this subject. */
  unsubscribe(subject: string): boolean {
    const found = this.find(subject);
    if (found === undefined) return false;
    found.weights.close();
    found.poses?.close();
    this.followed.splice(this.followed.indexOf(found), 1);
    return true;
  }

  /** The subjects of all subscriptions, in the order of subscribing; '' while the daemon has not chosen one. */
  subjects(): string[] {
    return this.followed.map(({ weights }) => weights.subject);
  }

  /** The newest weights of a subject (default: the first subscription); null before the first frame. */
  weights(subject?: string): WeightFrame | null {
    return this.find(subject)?.weights.frame() ?? null;
  }

  /** The newest pose of a subject; null before the first pose, and for subscriptions without `poses`. */
  pose(subject?: string): PoseFrame | null {
    return this.find(subject)?.poses?.pose() ?? null;
  }

  /** The names of a subject's weights, known before the first frame; empty until then. */
  names(subject?: string): readonly string[] {
    return this.find(subject)?.weights.names ?? [];
  }

  /** Why there are no weights; null if there are some. */
  problem(subject?: string): FeedProblem | null {
    const found = this.find(subject);
    return found === undefined ? 'no-data' : found.weights.problem;
  }

  /** Ends all subscriptions and the connection. The client cannot be used again. */
  close(): void {
    for (const { weights, poses } of this.followed.splice(0)) {
      weights.close();
      poses?.close();
    }
    this.connection.close();
    for (const listeners of Object.values(this.listeners)) listeners.clear();
  }

  private find(subject?: string): Followed | undefined {
    if (subject === undefined) return this.followed[0];
    return this.followed.find(({ weights }) => weights.wanted.subject === subject) ??
      this.followed.find(({ weights }) => weights.subject === subject);
  }
}

function checkText(what: string, text: string, most: number): void {
  if (new TextEncoder().encode(text).length <= most && !/[\u0000-\u001f\u007f]/.test(text)) return;
  throw new FurrowError('invalid-argument', `${what} has more than ${most} bytes or control characters`);
}

/** Makes the client of an address and subscribes to what the address names. */
export function openClient(
  address: string,
  options: OpenOptions,
  choose: (address: ReturnType<typeof parseAddress>) => TransportOpener,
): Client {
  const parsed = parseAddress(address);
  const { subscribe = true, poses, eightBit, drivers, ...connection } = options;
  const client = new Client(choose(parsed), connection);
  if (!subscribe) return client;
  try {
    for (const subject of parsed.subjects.length > 0 ? parsed.subjects : ['']) {
      client.subscribe({
        subject, pattern: parsed.pattern, rate: parsed.maxRateHz,
        poses: poses ?? false, eightBit: eightBit ?? false, drivers: drivers ?? false,
      });
    }
  } catch (error) {
    client.close(); // the caller never gets it, and it would connect for ever
    throw error;
  }
  return client;
}
