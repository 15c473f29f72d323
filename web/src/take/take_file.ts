// SPDX-License-Identifier: Apache-2.0
// A take as a file, in the layout of docs/RECORDING.md. Loaded only when a take is recorded.
import { McapWriter } from './mcap';
import type { Reel } from './pose_tape';

/** The binary schemas of the messages in a take. */
export interface TakeSchemas {
  skeleton: Uint8Array;
  pose: Uint8Array;
}

interface Channels {
  skeleton: number;
  pose: number;
}

/** `originMs`: time since 1970 at which the clock of the tape began. */
export function takeFile(subject: string, reels: readonly Reel[], schemas: TakeSchemas, originMs: number): Uint8Array[] {
  const file = new McapWriter('furrow-take', 'furrow page');
  const skeletons = file.addSchema('furrow.protocol.wire.SkeletonOffer', schemas.skeleton);
  const poses = file.addSchema('furrow.protocol.wire.Pose', schemas.pose);
  const logTimeNs = (atS: number): bigint => BigInt(Math.round(1000 * (originMs + 1000 * atS))) * 1000n;
  const channels = new Map<bigint, Channels>();
  for (const { session, skeleton, poses: taped } of reels) {
    const metadata = { subject, session: String(session) };
    const channel = channels.get(session) ?? {
      skeleton: file.addChannel(`/${subject}/skeleton`, skeletons, metadata), pose: file.addChannel(`/${subject}/pose`, poses, metadata),
    };
    channels.set(session, channel);
    const first = taped[0]!;
    file.addMessage(channel.skeleton, {
      sequence: first.sequence, logTimeNs: logTimeNs(first.atS), publishTimeNs: nanoseconds(first.captureTimeUs), data: skeleton,
    });
    for (const { atS, sequence, captureTimeUs, payload } of taped) {
      file.addMessage(channel.pose, { sequence, logTimeNs: logTimeNs(atS), publishTimeNs: nanoseconds(captureTimeUs), data: payload });
    }
  }
  return file.finish();
}

/** Clamped to 64 bits, as the daemon does, because senders may choose any time. */
function nanoseconds(us: bigint): bigint {
  const furthest = (2n ** 63n - 1n) / 1000n;
  return 1000n * (us > furthest ? furthest : us < -furthest ? -furthest : us);
}
