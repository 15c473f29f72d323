// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// What a stream's pose comes to on the character that is drawn: its joints carried over, what its
// blend shapes move put upon that, all in model space. Keeps the memory; one a thread.
class CharacterPose {
 public:
  // The character's skeleton; outlives it.
  explicit CharacterPose(const Skeleton* skeleton)
      : skeleton_(skeleton), local_(skeleton->num_joints()), model_(skeleton->num_joints()) {}

  // `retarget` and `shapes` are from the stream to this skeleton; `joints` and `blend_shapes` in
  // the stream's order. Does not allocate. Where it fails model() is no pose.
  [[nodiscard]] JobStatus Run(const Retarget& retarget, const BlendShapePose& shapes,
                              std::span<const Transform> joints,
                              std::span<const float> blend_shapes);

  // Of the last Run(): num_joints, model space.
  [[nodiscard]] std::span<const glm::mat4> model() const { return model_; }

 private:
  const Skeleton* skeleton_;
  std::vector<Transform> local_;
  std::vector<glm::mat4> model_;
};

}  // namespace furrow::wrinkle
