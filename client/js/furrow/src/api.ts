// SPDX-License-Identifier: Apache-2.0
// What browsers and Node share.
export { type ClientEvents, type ClientState, Client, type OpenOptions, type SubscriptionRequest } from './feed/client.js';
export type { PoseFrame } from './feed/pose_feed.js';
export type { FeedProblem, WeightFrame } from './feed/weight_feed.js';
export { type Address, parseAddress } from './link/address.js';
export { FurrowError, type FurrowErrorCode } from './link/errors.js';
export type { Skeleton } from './wire/poses.js';
export type { Timecode } from './wire/timecode.js';

/** Of the daemon's web server. */
export const DEFAULT_HTTP_PORT = 7480;
