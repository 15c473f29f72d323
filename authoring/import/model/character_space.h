// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <glm/mat3x3.hpp>

#include "authoring/import/model/joint_finder.h"
#include "character/character.h"

namespace furrow::authoring {

// What a model is of a person, which tells the height that is expected.
enum class ModelKind {
  kBody,     // has legs: about 1.7 m
  kHead,     // has joints of a head but no hips and arms, or only a few joints: about 0.3 m
  kUnknown,  // a head or a body
};

// The orientation and size of a character in its file, and the conversion to metres, +Y up, facing
// +Z.
struct CharacterSpace {
  glm::mat3 rotation{1.0f};  // quarter turns about axes; identity: the orientation is right
  float scale = 1.0f;   // factor of a common unit (0.01, 0.0254, 10, ...); 1: the size is plausible
  float height = 0.0f;  // of the mesh along its own up direction, in the file's unit
  ModelKind kind = ModelKind::kUnknown;
  std::string axes;  // "up +Z, facing -Y", as in the file; empty: unknown
};

// Determines the space from the joints (head above hips, left beside right) and the extent of the
// meshes.
[[nodiscard]] CharacterSpace FindCharacterSpace(const character::Character& character,
                                                const FoundJoints& joints);

// Rotates a character, then multiplies all lengths by `scale`: skeleton, meshes with their morph
// targets, and inverse bind matrices. Errors: those of Skeleton::Create().
[[nodiscard]] Status MoveToSpace(const glm::mat3& rotation, float scale,
                                 character::Character* character);

// Moves vertices to the skeleton's rest pose and removes scales from the joints, so that inverse
// bind matrices are the inverses of the rest pose. A character with this property stays unchanged.
// Errors: those of Skeleton::Create().
[[nodiscard]] Status BringToRestPose(character::Character* character);

}  // namespace furrow::authoring
