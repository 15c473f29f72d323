// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "motion/clip/clip.h"

// The CSV recordings of Live Link Face (ARKit): a header of names, then one row of blend shape
// values per frame.
//   Timecode,BlendShapeCount,EyeBlinkLeft,EyeLookDownLeft,...,RightEyeRoll
//   14:03:22:07.123,61,0.0312,...
namespace furrow::motion {

// Reads a recording as a clip of blend shapes without joints. Columns for the head and the eyes
// (HeadYaw and so on) become blend shapes with unchanged values. Times count from the first row.
//
// - Columns are found by name, because their order differs between versions of the app. Only
//   Timecode is required.
// - Timecode is HH:MM:SS:FF.mmm or HH:MM:SS;FF.mmm: FF frames and mmm thousandths of a frame. The
//   file does not state its rate. The reader uses `timecode_rate`, else the smallest common rate
//   above the highest FF. If no second ends within the recording, it uses 60 with a warning.
// - Times of drop-frame timecodes (;FF at 30 or 60) count frames of 29.97 or 59.94 per second, if
//   all rows are valid drop-frame timecodes. All other times are those that the timecode shows, and
//   run 0.1% slow at 23.976 frames per second, and at 29.97 and 59.94 without drop-frame.
// - Clip::timecodes has the timecodes, without those that are invalid at this rate.
// - A recording may pass midnight.
// - Rows without a face (BlendShapeCount 0) and rows that repeat a timecode are skipped with a
//   warning.
//
// Errors: kParse, kNonFinite, kLimit. `where` is "source_name:line".
[[nodiscard]] Result<Clip> ParseLiveLinkCsv(std::string_view text, std::string_view source_name,
                                            const LoadOptions& options = {},
                                            ClipReport* report = nullptr);

// Writes the clip's blend shapes as a recording. Values are exact. Joints are dropped with a
// warning.
//
// - The recording has the clip's timecodes if the reader will get their rate and Clip::times from
//   them: each frame has one, they have one rate, they rise (midnight may pass), the reader infers
//   the rate, and no time differs by 1 s or more (0.2% of the clip, if that is longer). The file
//   has no other times, so these differences are lost.
// - Otherwise it starts at 00:00:00:00, with a warning if the clip has timecodes. The rate is the
//   smallest common one that fits its frames and that the reader infers, else 24, or 60 for clips
//   below 1 s. Times are rounded to a thousandth of a frame.
//
// Errors: kUnsupported (no blend shapes), kInvalidArgument (no frames, or a comma or line end in a
// name), kLimit (longer than a day).
[[nodiscard]] Result<std::string> LiveLinkCsvToText(const Clip& clip, ClipReport* report = nullptr);

}  // namespace furrow::motion
