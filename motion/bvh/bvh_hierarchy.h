// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/status.h"
#include "base/text_cursor.h"
#include "wrinkle/skeleton/skeleton.h"

// The HIERARCHY part of a BVH file; private to motion/bvh/.
namespace furrow::motion {

struct ClipReport;

// What one number of a frame's line means for its joint.
enum class BvhChannel { kXPosition, kYPosition, kZPosition, kXRotation, kYRotation, kZRotation };

// The first `count` entries are the channels of one joint, in the file's order.
struct BvhJointChannels {
  std::array<BvhChannel, 6> channels{};
  int count = 0;
};

struct BvhHierarchy {
  std::vector<wrinkle::JointDesc> joints;  // in the file's order, which has parents first
  std::vector<BvhJointChannels> channels;  // one entry per joint
  std::size_t num_channels = 0;            // numbers per frame
};

// Reads from `cursor`, at the start of the text, through the word MOTION. Lengths keep the file's
// unit. `report` receives warnings and may be null. Errors: those of ParseBvh().
[[nodiscard]] Result<BvhHierarchy> ParseBvhHierarchy(TextCursor* cursor, ClipReport* report);

}  // namespace furrow::motion
