// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/solid.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Parameters of a body. Factors are relative to a slim man of 1.75 m. The height is fixed, since
// the head sits on top.
struct BodyParameters {
  float shoulder_width = 1.0f;
  float chest = 1.0f;  // girth, like waist, hips and limbs
  float waist = 1.0f;
  float hips = 1.0f;
  float limbs = 1.0f;
  float bust = 0.0f;                          // distance that it stands out, metres
  float belly = 0.0f;                         // as bust
  glm::vec3 shirt{0.47f, 0.56f, 0.66f};       // sRGB
  glm::vec3 trousers{0.27f, 0.265f, 0.275f};  // sRGB
  int level =
      1;  // level of detail: 0 gives about 8,000 triangles, each further level four times as many
};

// The shape of the clothed body.
//
// The arms are modelled hanging 30 degrees away from the sides, since that is close to how they
// mostly hang. They are then moved to the T-pose of rest. The shirt therefore fits best in the most
// frequent poses. "Modelling pose" means the pose with hanging arms.
class BodyShape {
 public:
  // `head` must outlive the shape; the collar surrounds its neck.
  BodyShape(const BodyParameters& parameters, const wrinkle::Skeleton& skeleton,
            const HeadShape& head);

  [[nodiscard]] const BodyParameters& parameters() const { return parameters_; }
  [[nodiscard]] const wrinkle::Skeleton& skeleton() const { return skeleton_; }
  // One per joint, from rest to the modelling pose.
  [[nodiscard]] const std::vector<glm::mat4>& skin_matrices() const { return skin_matrices_; }
  // The axis of the left arm in the modelling pose: the joint of the shoulder and the unit
  // direction.
  [[nodiscard]] glm::vec3 shoulder() const { return shoulder_; }
  [[nodiscard]] glm::vec3 arm() const { return arm_; }
  // Unit vectors perpendicular to the arm, outward and forward.
  [[nodiscard]] glm::vec3 arm_outward() const { return outward_; }
  [[nodiscard]] glm::vec3 arm_forward() const { return forward_; }

  // Signed distances in the modelling pose, metres. Both sides unless stated otherwise.
  [[nodiscard]] float Shirt(const glm::vec3& p) const;
  [[nodiscard]] float Sleeve(const glm::vec3& p) const;  // left sleeve only
  [[nodiscard]] float Trousers(const glm::vec3& p) const;
  [[nodiscard]] float TrouserLeg(const glm::vec3& p) const;  // left leg only
  // The neck with a finger's width of room for the collar.
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
