// SPDX-License-Identifier: Apache-2.0
// The newest pose of one subject.
import type { Connection, Subscriber, Subscription } from '../link/connection.js';
import type { Envelope } from '../wire/envelope.js';
import { type PoseMessage, readPose, readSkeleton, type Skeleton } from '../wire/poses.js';
import { type PosesRequest, subscribePoses } from '../wire/requests.js';
import type { Timecode } from '../wire/timecode.js';
import { type FrameOrder, isLate } from './reordering.js';

/** A complete pose. Joint `i` has 4 numbers at 4 i of rotations, 3 at 3 i of the others. The arrays never change. */
export interface PoseFrame {
  subject: string;
  skeleton: Skeleton;
  /** Local, relative to the parent: x, y, z, w. */
  rotations: Float32Array;
  /** Local, in units of the stream. */
  translations: Float32Array;
  scales: Float32Array;
  /** In the order of skeleton.blendShapeNames. */
  blendShapes: Float32Array;
  sequence: number;
  /** Poses received so far; differs if this is a new pose. */
  number: number;
  captureTimeUs: bigint;
  /** SMPTE timecode; null: the source sends none. */
  timecode: Timecode | null;
  /** Time since the pose arrived, milliseconds. */
  ageMs: number;
}

interface Newest extends FrameOrder {
  pose: Pick<PoseFrame, 'rotations' | 'translations' | 'scales' | 'blendShapes'>;
  receivedMs: number;
  timecode: Timecode | null;
}

const RETRY_MS = 2000;

export class PoseFeed implements Subscriber {
  private readonly subscription: Subscription;
  private offered: Skeleton | null = null;
  private newest: Newest | null = null;
  private number = 0;
  private cancelRetry: () => void = () => {};

  constructor(
    private readonly connection: Connection,
    readonly wanted: PosesRequest,
    private readonly events: { onPose(): void; onProblem(message: string): void },
  ) {
    this.subscription = connection.subscribe(this);
  }

  /** Null before it has arrived. */
  get skeleton(): Skeleton | null {
    return this.offered;
  }

  pose(): PoseFrame | null {
    const { newest, offered } = this;
    if (newest === null || offered === null) return null;
    return {
      subject: offered.subject,
      skeleton: offered,
      ...newest.pose,
      sequence: newest.sequence,
      number: this.number,
      captureTimeUs: newest.captureTimeUs,
      timecode: newest.timecode,
      ageMs: Math.max(0, this.connection.nowMs() - newest.receivedMs),
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
    return subscribePoses(this.wanted);
  }

  onReply(): void {
    this.cancelRetry();
  }

  onMessage(message: Envelope): void {
    if (message.identifier === 'FSKO') this.onSkeleton(readSkeleton(message.payload));
    if (message.identifier === 'FPOS') this.onPose(message, readPose(message.payload));
  }

  private onSkeleton(skeleton: Skeleton): void {
    if (skeleton.hash !== this.offered?.hash) this.newest = null;
    this.offered = skeleton;
  }

  private onPose(message: Envelope, pose: PoseMessage): void {
    const skeleton = this.offered;
    if (skeleton === null || pose.skeletonHash !== skeleton.hash || pose.numJoints !== skeleton.names.length ||
        pose.numBlendShapes !== skeleton.blendShapeNames.length) {
      this.subscription.repeat(); // the skeleton was lost
      return;
    }
    const nowMs = this.connection.nowMs();
    if (this.newest !== null && isLate(message, this.newest, nowMs - this.newest.receivedMs)) return;
    this.newest = {
      pose: complete(skeleton, pose),
      sequence: message.sequence,
      captureTimeUs: message.captureTimeUs,
      receivedMs: nowMs,
      timecode: pose.timecode,
    };
    ++this.number;
    this.events.onPose();
  }

  onGone(): void {}

  onRefused(_code: number, message: string): void {
    this.cancelRetry();
    this.cancelRetry = this.connection.after(RETRY_MS, () => this.subscription.askAgain());
    this.events.onProblem(message);
  }
}

/** Joints that are not listed are at rest. The reader has checked that indices and counts fit. */
function complete(skeleton: Skeleton, pose: PoseMessage): Newest['pose'] {
  const rotations = skeleton.restRotations.slice();
  const translations = skeleton.restTranslations.slice();
  const scales = skeleton.restScales.slice();
  const blendShapes = new Float32Array(skeleton.blendShapeNames.length);
  pose.rotationJoints.forEach((joint, i) => rotations.set(pose.rotations.subarray(4 * i, 4 * i + 4), 4 * joint));
  pose.translationJoints.forEach((joint, i) => {
    // The wire carries offsets from the rest pose.
    for (let axis = 0; axis < 3; ++axis) translations[3 * joint + axis]! += pose.translations[3 * i + axis]!;
  });
  pose.scaleJoints.forEach((joint, i) => scales.set(pose.scales.subarray(3 * i, 3 * i + 3), 3 * joint));
  pose.blendShapeIndices.forEach((shape, i) => {
    blendShapes[shape] = pose.blendShapes[i]!;
  });
  return { rotations, translations, scales, blendShapes };
}
