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

// Lets a stream of blend shapes move joints: a reference pose of the rig that has a blend shape's
// name (whatever the case) is what that blend shape does to the face at 1. Made once a stream, for
// the skeleton that is moved; then one pass a pose.
class BlendShapePose {
 public:
  BlendShapePose() = default;  // moves nothing

  // `blend_shapes`: the stream's names, in its order. Names without a pose, and joints that
  // `skeleton` lacks, are passed over.
  [[nodiscard]] static BlendShapePose Create(const Rig& rig, const Skeleton& skeleton,
                                             std::span<const std::string> blend_shapes);

  // True where no blend shape of the stream moves anything.
  [[nodiscard]] bool empty() const { return moves_.empty(); }

  // Adds to `local`, num_joints of the skeleton, what `coefficients` (the stream's order; those
  // past its end count as 0) say: translations add up, rotations are scaled as rotation vectors and
  // follow one another. Does not allocate; changes nothing where it fails.
  [[nodiscard]] JobStatus Run(std::span<const float> coefficients,
                              std::span<Transform> local) const;

 private:
  struct Move {
    int blend_shape;
    int joint;
    glm::vec3 translation;  // in the parent's axes
    glm::vec3 axis;         // unit, in the joint's own axes; any where `angle` is 0
    float angle;            // radians
  };
  std::vector<Move> moves_;
  std::size_t num_joints_ = 0;
};

}  // namespace furrow::wrinkle
