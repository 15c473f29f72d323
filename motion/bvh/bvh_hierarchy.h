// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/status.h"
#include "base/text_cursor.h"
#include "wrinkle/skeleton/skeleton.h"

// The HIERARCHY part of a BVH file; private to motion/'s BVH reader.
namespace furrow::motion {

struct ClipReport;

// What one number of a frame's line does to its joint.
enum class BvhChannel { kXPosition, kYPosition, kZPosition, kXRotation, kYRotation, kZRotation };

struct BvhJointChannels {
  std::array<BvhChannel, 6> channels{};
  int count = 0;
};

struct BvhHierarchy {
  std::vector<wrinkle::JointDesc> joints;  // parents first, depth first, in the file's order
  std::vector<BvhJointChannels> channels;  // one a joint
  std::size_t num_channels = 0;            // numbers a frame
};

// Reads from the start up to and including the word MOTION. Lengths are left in the file's unit.
[[nodiscard]] Result<BvhHierarchy> ParseBvhHierarchy(TextCursor* cursor, ClipReport* report);

}  // namespace furrow::motion
