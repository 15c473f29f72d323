// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/solid.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The parameters of a generated body. Factors are relative to a slim man; 1 leaves a measure as it
// is. Every body is 1.75 m tall, because the head has a fixed position.
struct BodyParameters {
  float shoulder_width = 1.0f;
  float chest = 1.0f;  // chest to limbs: factors of the girth
  float waist = 1.0f;
  float hips = 1.0f;
  float limbs = 1.0f;
  float bust = 0.0f;                          // how far the bust stands out, metres
  float belly = 0.0f;                         // how far the belly stands out, metres
  glm::vec3 shirt{0.47f, 0.56f, 0.66f};       // sRGB
  glm::vec3 trousers{0.27f, 0.265f, 0.275f};  // sRGB
  // Level of detail, >= 0. Level 0 gives about 8,000 triangles; each level quadruples the number.
  int level = 1;
};

// The shape of a clothed body, as signed distances to its clothes.
//
// Clothes are modelled in the "modelling pose": the arms hang 30 degrees away from the sides, as
// they mostly do in recordings, so the shirt fits best there. The rest pose is a T-pose.
class BodyShape {
 public:
  // `head` must outlive this object; the collar surrounds the head's neck.
  BodyShape(const BodyParameters& parameters, const wrinkle::Skeleton& skeleton,
            const HeadShape& head);

  [[nodiscard]] const BodyParameters& parameters() const { return parameters_; }
  [[nodiscard]] const wrinkle::Skeleton& skeleton() const { return skeleton_; }
  // One per joint: moves points from the rest pose to the modelling pose, model space.
  [[nodiscard]] const std::vector<glm::mat4>& skin_matrices() const { return skin_matrices_; }
  // The left arm in the modelling pose: the position of the shoulder joint (model space, metres)
  // and the unit vector from it along the arm.
  [[nodiscard]] glm::vec3 shoulder() const { return shoulder_; }
  [[nodiscard]] glm::vec3 arm() const { return arm_; }
  // Unit vectors perpendicular to the arm, outward and forward.
  [[nodiscard]] glm::vec3 arm_outward() const { return outward_; }
  [[nodiscard]] glm::vec3 arm_forward() const { return forward_; }

  // Signed distances from `p` to a surface, metres, negative inside. `p`: model space, modelling
  // pose, metres. Both sides of the body, unless stated otherwise.
  [[nodiscard]] float Shirt(const glm::vec3& p) const;
  [[nodiscard]] float Sleeve(const glm::vec3& p) const;  // left sleeve only
  [[nodiscard]] float Trousers(const glm::vec3& p) const;
  [[nodiscard]] float TrouserLeg(const glm::vec3& p) const;  // left leg only
  // The surface 7 mm outside the skin of the neck, which leaves room for the collar.
  [[nodiscard]] float Neck(const glm::vec3& p) const;

 private:
  BodyParameters parameters_;
  wrinkle::Skeleton skeleton_;
  const HeadShape* head_;
  std::vector<glm::mat4> skin_matrices_;
  glm::vec3 shoulder_, arm_, outward_, forward_;
  std::vector<Section> torso_, pelvis_, leg_;
};

}  // namespace furrow::authoring
