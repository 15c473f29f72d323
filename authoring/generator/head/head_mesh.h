// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"

namespace furrow::authoring {

// The part of the head that a vertex belongs to.
enum HeadPart { kFacePart = 0, kMouthInside, kEar, kEyeball, kHairCap, kLash, kTeeth };

// The data of a vertex from which SkinHead() derives its skin weights. `mouth_side` and `eye_side`
// distinguish vertices at the same position: closed lips touch each other, and so do closed lids.
struct HeadVertex {
  glm::vec3 place{0.0f};    // head space, centimetres
  float mouth_side = 0.0f;  // +1 above the line of the lips, -1 below, 0 elsewhere
  float eye_side = 0.0f;    // +1 above the middle of the eye, -1 below, 0 elsewhere
  int part = 0;             // HeadPart
  glm::vec3 root{0.0f};     // kLash: where the lash grows, which moves all of it
};

// A mesh of the head in model space, metres, without skin weights until SkinHead() sets them.
struct HeadMesh {
  character::Mesh mesh;
  std::vector<HeadVertex> info;  // one per vertex of `mesh`
};

// Appends a vertex and returns its index. `info.place` gives its position; `uv`: v down.
std::uint32_t AddHeadVertex(HeadMesh* head, const HeadVertex& info, const glm::vec2& uv);

}  // namespace furrow::authoring
