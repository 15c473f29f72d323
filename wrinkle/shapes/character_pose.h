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

// A stream's pose on the drawn character, in model space: the joints are retargeted, then the blend
// shapes' motion is added. Owns the memory; use one per thread.
class CharacterPose {
 public:
  // `skeleton`: the character's; outlives this object.
  explicit CharacterPose(const Skeleton* skeleton)
      : skeleton_(skeleton), local_(skeleton->num_joints()), model_(skeleton->num_joints()) {}

  // `retarget` and `shapes` map the stream to this skeleton. `joints` and `blend_shapes` are in the
  // stream's order. Does not allocate. After a failure model() is undefined.
  [[nodiscard]] JobStatus Run(const Retarget& retarget, const BlendShapePose& shapes,
                              std::span<const Transform> joints,
                              std::span<const float> blend_shapes);

  // The result of the last Run(): num_joints matrices.
  [[nodiscard]] std::span<const glm::mat4> model() const { return model_; }

 private:
  const Skeleton* skeleton_;
  std::vector<Transform> local_;
  std::vector<glm::mat4> model_;
};

}  // namespace furrow::wrinkle
