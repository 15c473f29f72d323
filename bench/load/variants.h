// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"

namespace furrow::bench {

// Saves a rig with `copies` copies of all drivers and regions, each with its own name. Errors:
// those of LoadRig() and SaveRig().
[[nodiscard]] Status SaveMultipliedRig(const std::filesystem::path& rig, int copies,
                                       const std::filesystem::path& out);

// Saves a recording with extra moving joints, which no rig uses, up to `joints` in total.
// Precondition: the recording has at most `joints`. Errors: those of the motion readers and
// writers.
[[nodiscard]] Status SavePaddedRecording(const std::filesystem::path& recording, int joints,
                                         const std::filesystem::path& out);

// Number of wrinkle weights that the rig computes from the recording.
[[nodiscard]] Result<int> CountWeights(const std::filesystem::path& recording,
                                       const std::filesystem::path& rig);

}  // namespace furrow::bench
