// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "motion/clip/clip.h"

// Biovision Hierarchy, the text format of body mocap: a tree of OFFSETs and CHANNELS, then one line
// of numbers per frame. The format has no standard. The reader accepts the files of Blender,
// MotionBuilder, 3ds Max, MakeHuman and the CMU conversions.
namespace furrow::motion {

// Reads a BVH text. `source_name`: the file name in errors. `report` receives warnings and may be
// null, as in all functions of motion/.
//
// - Accepted: several ROOTs, keywords in any case, names with blanks, LF, CRLF or CR, tabs, lines
//   of any length, a UTF-8 byte order mark. The locale has no effect.
// - CHANNELS: 0 to 6 per joint, in the joint's own order. Rotations are in degrees and multiply in
//   that order, R = R1 * R2 * R3 (column vectors). The rest pose is OFFSET without rotation.
//   LoadOptions::bvh_positions says what position channels mean.
// - `End Site` becomes the joint's tail. If a joint has several, the first counts.
// - Consecutive rotations have quaternions of consistent sign.
// - If `Frames:` differs from the number of lines, the lines count and `report` gets a warning.
//   A short last line, or a last line without newline before the stated number, is kParse: the file
//   was cut off.
// - Only `scale` and `bvh_positions` of the options are used.
//
// Errors: kParse, kNonFinite, kLimit, kUnsupported (scale channels). `where` is
// "source_name:line".
[[nodiscard]] Result<Clip> ParseBvh(std::string_view text, std::string_view source_name,
                                    const LoadOptions& options = {}, ClipReport* report = nullptr);

// Writes the clip as BVH text with rotation channels Z Y X and six decimals.
//
// - BVH's rest pose has no rotations, so each joint's local axes are turned until its rest rotation
//   vanishes. Joints keep their model-space positions in the rest pose and in every frame, and
//   deviations from the rest pose (wrinkle::JointDelta) stay the same.
// - Roots, and joints with translations that differ from their offset, get position channels.
// - BVH frames are evenly spaced. Other clips are resampled at their mean rate, with a warning.
// - Constant uniform scales are multiplied into the offsets.
// - Blend shapes are dropped with a warning.
//
// Errors: kUnsupported (no joints; a scale that changes or is not uniform), kInvalidArgument (no
// frames, or a name that BVH cannot hold).
[[nodiscard]] Result<std::string> BvhToText(const Clip& clip, ClipReport* report = nullptr);

}  // namespace furrow::motion
