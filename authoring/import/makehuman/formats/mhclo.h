// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "base/status.h"

namespace furrow::authoring {

// The content of MakeHuman's .mhclo file, which attaches a garment to the base mesh.
struct Mhclo {
  // A garment vertex: `weights` of three base vertices, plus an offset along the model's axes in
  // units of the scales below.
  struct GarmentVertex {
    std::array<std::uint32_t, 3> base{};
    std::array<float, 3> weights{};
    glm::vec3 offset{0.0f};
  };
  // The scale of one axis: the distance of two base vertices along the axis, divided by `extent`.
  struct Scale {
    std::uint32_t first = 0;   // base vertex
    std::uint32_t second = 0;  // base vertex
    float extent = 1.0f;       // their distance on the mesh of the garment's author; not 0
  };

  std::string name;
  std::string obj_file;                        // file beside the .mhclo, without folders
  std::array<std::optional<Scale>, 3> scales;  // x, y, z; empty: 1
  std::string material;                        // .mhmat file, relative to the .mhclo; may be empty
  int z_depth = 50;                            // larger numbers are worn above smaller ones
  std::vector<GarmentVertex> vertices;         // in the order of the .obj
  std::vector<bool> deleted;                   // per base vertex: the garment hides it
};

// Parses a .mhclo file. `source`: the file name in errors. `num_base_vertices`: number of vertices
// of the base mesh, against which every index is checked.
//
// Errors name "source:line": kParse, kInvalidArgument (index out of range, a range that ends before
// it starts), kNonFinite, kSchema (missing obj_file or verts, a scale of length zero, a file name
// with a folder).
[[nodiscard]] Result<Mhclo> ParseMhclo(std::string_view text, std::string_view source,
                                       std::size_t num_base_vertices);

// Returns the positions of the garment's vertices, in the order of its .obj. `base`: the positions
// of the base mesh; the result has the same unit.
[[nodiscard]] std::vector<glm::vec3> FitGarment(const Mhclo& garment,
                                                std::span<const glm::vec3> base);

}  // namespace furrow::authoring
