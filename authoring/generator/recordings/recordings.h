// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The frames of a performance on one skeleton, 30 per second.
struct Recording {
  std::string name;
  std::vector<std::vector<wrinkle::Transform>> frames;  // local transforms, num_joints per frame
};

inline constexpr int kFramesPerSecond = 30;

// The names of all recordings: "happiness", "anger", "sadness", "disgust", "performance",
// "conversation", "walk", "squat".
[[nodiscard]] std::vector<std::string> RecordingNames();

// Makes the recording `name` from the rig's reference poses (FACS action units): expressions appear
// within 0.3 to 0.6 s, the eyes blink every 3 to 5 s, and the head moves slightly. Errors:
// kNotFound (no recording of this name; a missing reference pose or joint).
[[nodiscard]] Result<Recording> MakeRecording(std::string_view name, const wrinkle::Rig& rig,
                                              const wrinkle::Skeleton& skeleton);

}  // namespace furrow::authoring
