// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "recording/take_reader.h"

namespace furrow::cli {

// Writes a clip as a take with one subject, which has the name of the clip: skeleton and poses, no
// weights. Log times start at 0, so equal clips give equal files. Errors: kIo (also if the file
// exists), kInvalidArgument (the wire format cannot carry the clip: too many joints, or a name too
// long).
[[nodiscard]] Status SaveTake(const motion::Clip& clip, const std::filesystem::path& path);

// Returns the recorded weights of a subject (empty: the only one) as CSV: "frame,time,<names...>",
// one row per pose, %.6f. `frame` is the sequence number of the pose; `time` is its capture time in
// seconds since the first row. If the take has timecodes, a last column "timecode" has them, empty
// where a pose has none.
//
// Weights that the daemon held or decayed without a pose are skipped. Weights whose names differ
// from the first ones are skipped with a warning in `report`. Errors: kNotFound, kInvalidArgument
// (several subjects), those of the reader.
[[nodiscard]] Result<std::string> WeightsToCsv(recording::TakeReader& take,
                                               const std::string& subject,
                                               motion::ClipReport* report);

}  // namespace furrow::cli
