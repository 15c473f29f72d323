// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "motion/clip/clip.h"

// Biovision Hierarchy, the text format of body mocap: a tree of OFFSETs and CHANNELS, then one line
// of numbers a frame. Nobody owns the format; what is read here is what Blender, MotionBuilder, 3ds
// Max, MakeHuman and the CMU conversions write.
namespace furrow::motion {

// Reads a BVH text.
//
// - Several ROOTs; keywords in any case; names with blanks; LF, CRLF or CR; tabs; lines of any
//   length; a UTF-8 byte order mark.
// - CHANNELS: 0 to 6 a joint, in the joint's own order. Rotations multiply in that order as
//   R = R1 * R2 * R3 (column vectors), in degrees; the rest pose is OFFSET without rotation.
//   Position channels: see BvhPositions.
// - `End Site` becomes the joint's tail. Of several, the first counts.
// - Rotations are quaternions whose sign follows from frame to frame.
// - A wrong `Frames:` is a warning: what stands in the file counts. But a last line that is short,
//   or ends without a newline before the stated number is reached, is a file that was cut: kParse.
// - Only `scale`, `bvh_positions` of the options are read.
//
// Errors: kParse, kNonFinite, kLimit, kUnsupported (channels other than the six); `where` is
// "source_name:line". Nothing is read from the locale.
[[nodiscard]] Result<Clip> ParseBvh(std::string_view text, std::string_view source_name,
                                    const LoadOptions& options = {}, ClipReport* report = nullptr);

// The clip as BVH text, rotation channels Z Y X, six decimals.
//
// - BVH's rest pose has no rotations: joints are turned so that theirs vanish, which moves no joint
//   in model space, in the rest pose or in any frame, and no departure from rest (see
//   wrinkle::JointDelta).
// - Position channels stand where a joint's translation leaves its offset, and at roots.
// - Frames must be evenly spaced; a clip that is not is resampled at its mean rate (a warning).
// - Constant scales are carried into the offsets;
//   kUnsupported where a scale changes or is not uniform.
// - Blend shapes are left out (a warning). kUnsupported without joints, kInvalidArgument without
//   frames or where a name cannot be written.
[[nodiscard]] Result<std::string> BvhToText(const Clip& clip, ClipReport* report = nullptr);

}  // namespace furrow::motion
