// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "client/load/schedule/workload.h"
#include "motion/clip/clip.h"

namespace furrow::cli {

// How the poses of a load test are packed. kToFit: those that do not fit one datagram.
enum class Packing { kToFit, kAlways, kNever };

// The recording that a load test sends and the rig that checks the weights.
struct LoadInput {
  std::string file;  // the recording
  // File or name of a shipped rig, or a character package; empty: the default character's rig.
  std::string rig;
  std::string skeleton_map;  // file or name of a shipped map; empty: the best match
  std::string shape_map;     // the same for the names of blend shapes
  Packing packing = Packing::kToFit;
  float scale = 1.0f;        // metres per unit of the recording
  motion::LoadOptions read;  // how the recording, and the recordings of reference poses, are read
};

// Loads the recording, binds the rig to it and encodes all poses. Prints warnings about joints and
// blend shapes that the recording lacks.
//
// Errors: those of the recording, the rig and the skeleton map; kInvalidArgument (no frames);
// kNotFound (the recording has nothing that the rig reads).
[[nodiscard]] Result<load::Workload> LoadWorkload(const LoadInput& input);

// Replaces the values of the frames that are sent packed by their quantised wire values, so that
// the local solver and the daemon solve the same numbers.
void QuantiseClip(Packing packing, motion::Clip* clip);

}  // namespace furrow::cli
