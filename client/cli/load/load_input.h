// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "client/load/schedule/performance.h"
#include "motion/clip/clip.h"

namespace furrow::cli {

// What a load test sends, and by which rig it is checked.
struct LoadInput {
  std::string file;
  std::string rig;  // as LoadRigArgument(); empty: the default character's
  std::string skeleton_map;
  bool quantise = false;
  float scale = 1.0f;
};

// What the recording lacks of the rig is warned of on standard error. Errors: those of the
// recording, the rig and the skeleton map; kInvalidArgument for a recording without frames;
// kNotFound for one that has nothing that the rig reads.
[[nodiscard]] Result<load::Performance> LoadPerformance(const LoadInput& input);

// Makes a clip's values those that its quantised poses have on the wire, so that both ends solve
// the same numbers.
void QuantiseClip(motion::Clip* clip);

}  // namespace furrow::cli
