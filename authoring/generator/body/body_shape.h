// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/solid.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// What tells one body from another. Factors are of a slim man of 1.75 m; the height is that of the
// default character, whose head sits on top.
struct BodyParameters {
  float shoulder_width = 1.0f;
  float chest = 1.0f;  // girth, as are waist, hips and limbs
  float waist = 1.0f;
  float hips = 1.0f;
  float limbs = 1.0f;
  float bust = 0.0f;                          // how far it stands out, metres
  float belly = 0.0f;                         // likewise
  glm::vec3 shirt{0.47f, 0.56f, 0.66f};       // sRGB
  glm::vec3 trousers{0.27f, 0.265f, 0.275f};  // sRGB
  int level = 1;  // of detail: 0 is about 8,000 triangles, each further one four times as many
};

// The form of the clothed body.
//
// Arms are formed as they mostly are, hanging away from the sides by a third of a right angle, and
// carried from there to the T pose of rest: so the shirt sits best where it is seen most.
// "Modelling pose" below means that pose.
class BodyShape {
 public:
  // `head` outlives it: the collar goes round its neck.
  BodyShape(const BodyParameters& parameters, const wrinkle::Skeleton& skeleton,
            const HeadShape& head);

  [[nodiscard]] const BodyParameters& parameters() const { return parameters_; }
  [[nodiscard]] const wrinkle::Skeleton& skeleton() const { return skeleton_; }
  // From rest to the modelling pose, one a joint.
  [[nodiscard]] const std::vector<glm::mat4>& skin_matrices() const { return skin_matrices_; }
  // The left arm's line in the modelling pose: the shoulder's joint and the unit direction.
  [[nodiscard]] glm::vec3 shoulder() const { return shoulder_; }
  [[nodiscard]] glm::vec3 arm() const { return arm_; }
  // Across the arm, outward and forward.
  [[nodiscard]] glm::vec3 arm_outward() const { return outward_; }
  [[nodiscard]] glm::vec3 arm_forward() const { return forward_; }

  // In the modelling pose; both sides alike.
  [[nodiscard]] float Shirt(const glm::vec3& p) const;
  [[nodiscard]] float Sleeve(const glm::vec3& p) const;  // of the left arm alone
  [[nodiscard]] float Trousers(const glm::vec3& p) const;
  [[nodiscard]] float TrouserLeg(const glm::vec3& p) const;  // the left one alone
  // The neck as the collar sees it, a finger's width around the skin.
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
