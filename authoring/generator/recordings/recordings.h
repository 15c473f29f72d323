// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Frames of a performance on one skeleton, 30 a second.
struct Recording {
  std::string name;
  std::vector<std::vector<wrinkle::Transform>> frames;  // local, num_joints each
};

inline constexpr int kFramesPerSecond = 30;

// "happiness", "anger", "sadness", "disgust", "performance", "conversation", "walk", "squat".
[[nodiscard]] std::vector<std::string> RecordingNames();

// Plays a recording's script: weights over time of the rig's reference poses (FACS' action units),
// eased with onsets of 0.3 to 0.6 s, with blinks every 3 to 5 s and a head that never quite rests.
// Error: kNotFound for a name, or a reference pose or joint that is not there.
[[nodiscard]] Result<Recording> MakeRecording(std::string_view name, const wrinkle::Rig& rig,
                                              const wrinkle::Skeleton& skeleton);

}  // namespace furrow::authoring
