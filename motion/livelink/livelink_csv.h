// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "motion/clip/clip.h"

// The CSV take of Live Link Face (ARKit): a header of names, then one row of coefficients a frame.
//   Timecode,BlendShapeCount,EyeBlinkLeft,EyeLookDownLeft,...,RightEyeRoll
//   14:03:22:07.123,61,0.0312,...
namespace furrow::motion {

// Reads a take: a clip of blend shapes (those of the head and eyes, HeadYaw and its like, included,
// as they stand) without joints. Times count from the first row.
//
// - Columns are found by the header's names, in any order; only Timecode must be there. The order
//   of shapes differs between versions and is never assumed.
// - Timecode is HH:MM:SS:FF.mmm (";FF" likewise): FF frames and mmm thousandths of one. The file
//   does not say its rate: `timecode_rate`, else the smallest usual rate above the highest FF seen;
//   where no second ended within the take, 60 (with a warning). Midnight may pass.
// - Rows without a face (BlendShapeCount 0) and repeated timecodes are left out (a warning).
//
// Errors: kParse, kNonFinite, kLimit; `where` is "source_name:line".
[[nodiscard]] Result<Clip> ParseLiveLinkCsv(std::string_view text, std::string_view source_name,
                                            const LoadOptions& options = {},
                                            ClipReport* report = nullptr);

// The clip's blend shapes as a take that starts at 00:00:00:00, at the usual rate that fits its
// frames; times keep to a thousandth of a frame, values exactly. Joints are left out (a warning).
//
// Errors: kUnsupported (no blend shapes), kInvalidArgument (no frames, or a comma in a name),
// kLimit (a day).
[[nodiscard]] Result<std::string> LiveLinkCsvToText(const Clip& clip, ClipReport* report = nullptr);

}  // namespace furrow::motion
