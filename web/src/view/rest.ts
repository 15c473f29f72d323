// SPDX-License-Identifier: Apache-2.0
import type { SubjectInfo } from '../api';
import type { ShownPicture } from './picture_stats';

/** Clocks of the daemon and the page, and the time of a request. */
const TOLERANCE_MS = 300;

/** True if the subject has not moved since the pose of the picture. `answerMs`: the age of what the daemon said of the subject. */
export function isAtRest(picture: Pick<ShownPicture, 'isStill' | 'ageMs'> | null,
                         subject: Pick<SubjectInfo, 'rate_hz' | 'moved_ms'> | undefined, answerMs: number): boolean {
  const movedMs = subject?.moved_ms ?? null;
  if (picture === null || picture.ageMs === null || movedMs === null) return false;
  const isSlow = picture.isStill || (subject?.rate_hz ?? 0) < 1; // else the answer is too old to tell
  return isSlow && picture.ageMs <= movedMs + answerMs + TOLERANCE_MS;
}
