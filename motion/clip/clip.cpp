// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/clip.h"

#include <cstddef>

namespace furrow::motion {

std::optional<BvhPositions> ParseBvhPositions(std::string_view word) {
  if (word == "auto") return BvhPositions::kAuto;
  if (word == "channels" || word == "replace") return BvhPositions::kReplace;
  if (word == "add") return BvhPositions::kAdd;
  if (word == "offsets") return BvhPositions::kOffsets;
  return std::nullopt;
}

std::optional<UpAxis> ParseUpAxis(std::string_view word) {
  if (word == "auto") return UpAxis::kAuto;
  if (word == "y") return UpAxis::kY;
  if (word == "z") return UpAxis::kZ;
  return std::nullopt;
}

void Clip::GetPose(int frame, wrinkle::LocalPose* pose) const {
  const auto f = static_cast<std::size_t>(frame);
  const auto joints = static_cast<std::size_t>(skeleton.num_joints());
  const std::size_t shapes = blend_shape_names.size();
  const auto first_joint = locals.begin() + static_cast<std::ptrdiff_t>(f * joints);
  const auto first_shape = blend_shapes.begin() + static_cast<std::ptrdiff_t>(f * shapes);
  pose->joints.assign(first_joint, first_joint + static_cast<std::ptrdiff_t>(joints));
  pose->blend_shapes.assign(first_shape, first_shape + static_cast<std::ptrdiff_t>(shapes));
}

}  // namespace furrow::motion
