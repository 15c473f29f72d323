// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_shape.h"
#include "character/character.h"

namespace furrow::character::generator {

// What skinning must know of a vertex beyond its place: which lip and which lid it belongs to,
// since closed lips lie upon each other.
struct HeadVertex {
  glm::vec3 place{0.0f};    // head space, centimetres
  float mouth_side = 0.0f;  // +1 above the line of the lips, -1 below
  float eye_side = 0.0f;    // +1 above the middle of the eye, -1 below
  int part = 0;             // HeadPart
};

enum HeadPart { kFacePart = 0, kMouthInside, kEar, kEyeball, kHairCap, kLash, kTeeth };

// A mesh of the head in model space, its vertices without influences yet, and what is known of
// them.
struct HeadMesh {
  Mesh mesh;
  std::vector<HeadVertex> info;  // one a vertex
};

// Face, neck, lids, inside of the mouth and ears: one atlas. Island of the grid above, ears below.
[[nodiscard]] HeadMesh MakeHeadSkin(const HeadShape& shape = DefaultHead(),
                                    int level = kDefaultLevel);
// Both balls with their corneas, side by side in one atlas, looking along +Z.
[[nodiscard]] HeadMesh MakeEyes();
// Short hair over the scalp, brushed up in front.
[[nodiscard]] HeadMesh MakeHair(const HeadShape& shape = DefaultHead());
// Lashes of the four lids.
[[nodiscard]] HeadMesh MakeLashes(const HeadShape& shape = DefaultHead());
// Both rows of teeth.
[[nodiscard]] HeadMesh MakeTeeth();
// Lies between the lower teeth, and goes with the jaw.
[[nodiscard]] HeadMesh MakeTongue();

// The centre of an eyeball, head space; `side` +1 is the subject's left.
[[nodiscard]] glm::vec3 EyeCentre(float side);
// How far a point of the scalp lies inside the hairline, centimetres (negative: bare skin).
[[nodiscard]] float InsideHairline(const glm::vec3& p);

}  // namespace furrow::character::generator
