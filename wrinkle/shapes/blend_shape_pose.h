// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// Lets a stream of blend shapes move joints: a reference pose with the name of a blend shape
// (matched without case) is the face at coefficient 1. Created once per stream for the skeleton to
// move, then run once per pose.
class BlendShapePose {
 public:
  BlendShapePose() = default;  // moves nothing

  // `blend_shapes`: the stream's names, in its order. Names without a pose, and joints that
  // `skeleton` lacks, are ignored. `shapes`: the shapes of the skeleton's meshes. A blend shape of
  // their name moves them alone: an eyeball that both its joint and a shape turn would turn twice.
  // mouthClose counts at most as jawOpen, if the stream has both: it brings the lips together on an
  // open jaw, and alone it would push each lip through the other.
  [[nodiscard]] static BlendShapePose Create(const Rig& rig, const Skeleton& skeleton,
                                             std::span<const std::string> blend_shapes,
                                             std::span<const std::string> shapes = {});

  // True if no blend shape of the stream moves a joint.
  [[nodiscard]] bool empty() const { return moves_.empty(); }

  // Adds the blend shapes' motion to `local`, which has num_joints of the skeleton. Translations
  // add up; rotations are scaled as rotation vectors and applied one after another. Missing
  // coefficients count as 0. Does not allocate, and changes nothing on failure.
  [[nodiscard]] JobStatus Run(std::span<const float> coefficients,
                              std::span<Transform> local) const;

 private:
  struct Move {
    int blend_shape;
    int at_most;  // a blend shape that limits the coefficient, or -1
    int joint;
    glm::vec3 translation;  // in the parent's axes
    glm::vec3 axis;         // unit, in the joint's own axes; arbitrary if `angle` is 0
    float angle;            // radians
  };
  std::vector<Move> moves_;
  std::size_t num_joints_ = 0;
};

}  // namespace furrow::wrinkle
