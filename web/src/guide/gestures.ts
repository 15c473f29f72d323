// SPDX-License-Identifier: Apache-2.0
// What the performer is asked for: poses of the rig that one expression shows, together. Pure.
import type { RigInfo } from '../api';
import { text } from '../text';

export const NEUTRAL = 'neutral';

export interface Gesture {
  id: string;
  /** What the performer does. */
  words: string;
  /** The poses that are captured while it is held. */
  poses: string[];
}

/** Both sides of a face, and both ends of a brow, move together: "brow_raise" for "brow_raise_inner_l". */
function expressionOf(pose: string): string {
  return pose.replace(/_(l|r|left|right|inner|outer)(?=_|$)/g, '');
}

/** The neutral pose, then the reference poses that drivers of the rig use, in the order of the rig. */
export function gesturesOf(rig: Pick<RigInfo, 'drivers' | 'reference_poses'>): Gesture[] {
  const words: Record<string, string> = text.guide.gestures;
  const used = new Set(rig.drivers.flatMap(({ values }) => values.map(({ reference_pose }) => reference_pose)));
  const found = new Map<string, Gesture>();
  for (const pose of [NEUTRAL, ...rig.reference_poses.filter((name) => used.has(name))]) {
    const id = expressionOf(pose);
    const gesture = found.get(id) ?? { id, words: words[id] ?? text.guide.otherGesture(id), poses: [] };
    gesture.poses.push(pose);
    found.set(id, gesture);
  }
  return [...found.values()];
}
