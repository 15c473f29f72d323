// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"

namespace furrow::authoring {

// A Wavefront .obj file with the statements that MakeHuman uses: v, vt, f and g (or o). Units as in
// the file.
struct ObjMesh {
  struct Corner {
    std::uint32_t position = 0;  // into positions
    std::int32_t uv = -1;        // into uvs; -1: none
  };
  struct Face {  // corners [first_corner, first_corner + num_corners), counter-clockwise from
                 // outside
    std::uint32_t first_corner = 0;
    std::uint16_t num_corners = 0;
    std::uint16_t group = 0;  // into groups
  };

  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> uvs;  // v up
  std::vector<Corner> corners;
  std::vector<Face> faces;
  std::vector<std::string> groups;  // groups[0] is "", for faces before the first g

  [[nodiscard]] int FindGroup(std::string_view name) const;  // -1 if there is none
};

// Parses a .obj file. Other statements (vn, s, usemtl, ...) are skipped; normals are computed
// later. Negative indices count back from the latest element.
//
// Errors name "source:line": kParse (an invalid number or face, fewer than 3 or more than 64
// corners), kInvalidArgument (index out of range), kNonFinite, kLimit (a number above one million,
// more than 4 million positions, UVs or corners, more than 65,535 groups).
[[nodiscard]] Result<ObjMesh> ParseObj(std::string_view text, std::string_view source);

}  // namespace furrow::authoring
