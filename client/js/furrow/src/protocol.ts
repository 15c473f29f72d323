// SPDX-License-Identifier: Apache-2.0
// The layer below Client: any subscription, pictures included. For programs that draw a preview themselves.
export {
  Connection, type ConnectionOptions, ERROR, type LinkState, type Subscriber, type Subscription,
} from './link/connection.js';
export { ServerClock } from './link/clock.js';
export { PoseFeed, type PoseFrame } from './feed/pose_feed.js';
export { WeightFeed, type WeightFeedEvents, type WeightFrame } from './feed/weight_feed.js';
export { browserSocket } from './transport/web_socket.js';
export type { Transport, TransportEvents, TransportKind, TransportOpener } from './transport/transport.js';
export type { Envelope } from './wire/envelope.js';
export type { Skeleton } from './wire/poses.js';
export * from './wire/replies.js';
export * from './wire/requests.js';
export type { Timecode } from './wire/timecode.js';
