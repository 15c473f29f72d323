// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"

namespace furrow::authoring {

enum HeadPart { kFacePart = 0, kMouthInside, kEar, kEyeball, kHairCap, kLash, kTeeth };

// What skinning needs to know about a vertex besides its position. The sides tell apart vertices
// that share a position: closed lips touch each other, and so do closed lids.
struct HeadVertex {
  glm::vec3 place{0.0f};    // head space, centimetres
  float mouth_side = 0.0f;  // +1 above the line of the lips, -1 below, 0 elsewhere
  float eye_side = 0.0f;    // +1 above the middle of the eye, -1 below, 0 elsewhere
  int part = 0;             // HeadPart
};

// A mesh of the head in model space, with one HeadVertex per vertex. Skin weights are not set yet;
// see skinning.h.
struct HeadMesh {
  character::Mesh mesh;
  std::vector<HeadVertex> info;
};

// Appends a vertex and returns its index. Its model-space position follows from `info.place`.
std::uint32_t AddHeadVertex(HeadMesh* head, const HeadVertex& info, const glm::vec2& uv);

}  // namespace furrow::authoring
