// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "recording/take_reader.h"

namespace furrow::cli {

// Writes a clip as a take of one subject, named as the clip: skeleton and poses, no weights. Log
// times count from 0, so that equal clips give equal files. Errors: kIo (also where the file
// exists), kInvalidArgument (what the wire cannot carry: too many joints, an overlong name).
[[nodiscard]] Status SaveTake(const motion::Clip& clip, const std::filesystem::path& path);

// The recorded weights of a subject (empty: the only one) as CSV: "frame,time,<names...>", %.6f, a
// row a pose; frame is the pose's number, time its capture time since the first row. Weights of a
// subject that had fallen silent are left out, and those of other names than the first, which
// `report` tells of. Errors: kNotFound, kInvalidArgument (several subjects), the reader's.
[[nodiscard]] Result<std::string> WeightsToCsv(recording::TakeReader& take,
                                               const std::string& subject,
                                               motion::ClipReport* report);

}  // namespace furrow::cli
