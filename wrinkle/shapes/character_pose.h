// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/shapes/head_turn.h"
#include "wrinkle/shapes/shape_program.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// A stream's pose on the drawn character, in model space: the joints are retargeted, then the blend
// shapes' motion is added, by joints and by the weights of the character's shapes. Owns the memory;
// use one per thread.
class CharacterPose {
 public:
  // `skeleton`: the character's; outlives this object.
  explicit CharacterPose(const Skeleton* skeleton)
      : skeleton_(skeleton), local_(skeleton->num_joints()), model_(skeleton->num_joints()) {}

  // How a stream moves the character. The objects must outlive the call of Run().
  struct Maps {
    const Retarget& retarget;                     // from the stream's skeleton to this skeleton
    const BlendShapePose& joints;                 // the blend shapes' motion of this skeleton
    const ShapeProgram* shape_program = nullptr;  // null: the character has no shapes
    const HeadTurn* head_turn = nullptr;          // null: the stream does not turn the head
  };
  // `joints` and `blend_shapes` are in the stream's order. Allocates only for more shapes than ever
  // before. After a failure model() and shapes() are undefined.
  [[nodiscard]] JobStatus Run(const Maps& maps, std::span<const Transform> joints,
                              std::span<const float> blend_shapes);

  // The result of the last Run(): num_joints matrices.
  [[nodiscard]] std::span<const glm::mat4> model() const { return model_; }
  // One weight per shape of the character; empty without a ShapeProgram.
  [[nodiscard]] std::span<const float> shapes() const { return shapes_; }

 private:
  const Skeleton* skeleton_;
  std::vector<Transform> local_;
  std::vector<glm::mat4> model_;
  std::vector<float> shapes_;
};

}  // namespace furrow::wrinkle
