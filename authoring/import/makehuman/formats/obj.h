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

// The mesh of a Wavefront .obj file, from the statements that MakeHuman uses: v, vt, f and g (or
// o). Lengths keep the unit of the file.
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

  // The index of the group `name`, or -1 if there is none.
  [[nodiscard]] int FindGroup(std::string_view name) const;
};

// Parses a .obj file. `source`: the file name in errors. Other statements (vn, s, usemtl, ...) are
// skipped; SmoothNormals() computes normals. Negative indices count back from the latest element.
//
// Errors name "source:line": kParse (an invalid number or face, fewer than 3 or more than 64
// corners), kInvalidArgument (index out of range), kNonFinite, kLimit (a number
// outside [-1e6, 1e6], more than 4 million positions, UVs or corners, more than 65,535 groups).
[[nodiscard]] Result<ObjMesh> ParseObj(std::string_view text, std::string_view source);

}  // namespace furrow::authoring
