// SPDX-License-Identifier: Apache-2.0
// The binary schemas of poses and skeletons, which every take contains. A chunk of its own: few visitors save a take.
import pose from '@take-schemas/pose.bfbs?inline';
import skeleton from '@take-schemas/skeleton_offer.bfbs?inline';
import type { TakeSchemas } from './take_file';

/** The bytes of a data URL in base64. */
function bytesOf(url: string): Uint8Array {
  return Uint8Array.from(atob(url.slice(url.indexOf(',') + 1)), (letter) => letter.charCodeAt(0));
}

export const takeSchemas: TakeSchemas = { skeleton: bytesOf(skeleton), pose: bytesOf(pose) };
