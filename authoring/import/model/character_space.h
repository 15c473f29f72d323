// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <glm/mat3x3.hpp>

#include "authoring/import/model/joint_finder.h"
#include "character/character.h"

namespace furrow::authoring {

// How a character stands in the space of its file, and what brings it to ours: metres, +Y up,
// facing +Z.
struct CharacterSpace {
  glm::mat3 rotation{1.0f};  // a quarter turn about an axis, or several; identity: it stands right
  float scale = 1.0f;        // a usual unit (0.01, 0.0254, 10, ...); 1: the size is that of people
  float height = 0.0f;       // of the mesh along its own up, in the file's unit
  bool is_body = false;      // it has legs: some 1.7 m are due, else some 0.3 m
  std::string axes;          // "up +Z, facing -Y" as it stands; empty: the joints do not tell
};

// From the joints (head over hips, left beside right) and the extent of the meshes.
[[nodiscard]] CharacterSpace FindCharacterSpace(const character::Character& character,
                                                const FoundJoints& joints);

// Turns and scales a character: skeleton, meshes and inverse bind matrices.
[[nodiscard]] Status MoveToSpace(const glm::mat3& rotation, float scale,
                                 character::Character* character);

// Brings vertices to where the skeleton's rest pose puts them and takes scales out of the joints,
// so that inverse bind matrices are the inverses of the rest pose. A character that is so already
// stays as it is, to the bit.
[[nodiscard]] Status BringToRestPose(character::Character* character);

}  // namespace furrow::authoring
