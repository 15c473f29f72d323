// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"

namespace furrow::bench {

// A rig with all drivers and regions `copies` times over, under names of their own; saved as a
// file. Errors: LoadRig()'s and SaveRig()'s.
[[nodiscard]] Status SaveMultipliedRig(const std::filesystem::path& rig, int copies,
                                       const std::filesystem::path& out);

// A recording with as many joints as asked for: further ones that turn, and that no rig reads. The
// recording has at most so many. Errors: those of the motion readers and writers.
[[nodiscard]] Status SavePaddedRecording(const std::filesystem::path& recording, int joints,
                                         const std::filesystem::path& out);

// How many wrinkle weights a rig makes of a recording.
[[nodiscard]] Result<int> CountWeights(const std::filesystem::path& recording,
                                       const std::filesystem::path& rig);

}  // namespace furrow::bench
