// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/c/include/furrow/furrow.h"
#include "protocol/messages/messages.h"

// Skeletons and poses of the C interface, checked and converted to messages.
namespace furrow::capi {

// Reads a skeleton. `skeleton`: as CopyIn() returned it. Reads the program's joints with the stride
// `joint_size`.
//
// Errors: kInvalidArgument, which names the joint or the blend shape; kLimit; kUnsupported (a newer
// program has set a field of a joint that this library does not know).
[[nodiscard]] Result<protocol::SkeletonOffer> ReadSkeleton(const furrow_skeleton& skeleton);

// Reads poses for one skeleton.
class PoseReader {
 public:
  explicit PoseReader(const protocol::SkeletonOffer& offer);

  // Fills `pose`, which may be used again for the next pose. `input`: as CopyIn() returned it.
  // Errors: kInvalidArgument (a number that is not finite or too large, or a rotation of length 0).
  [[nodiscard]] Status Read(const furrow_pose& input, protocol::PoseFrame* pose) const;

 private:
  [[nodiscard]] Status ReadRotations(const float* values, protocol::PoseFrame* pose) const;
  [[nodiscard]] Status ReadTranslations(const float* values, protocol::PoseFrame* pose) const;

  std::vector<protocol::Vec3> rest_translations_;  // one per joint
  std::size_t num_blend_shapes_;
};

}  // namespace furrow::capi
