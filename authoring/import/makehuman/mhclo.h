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

// MakeHuman's .mhclo file: how a garment is attached to the base mesh.
struct Mhclo {
  // A garment vertex: `weights` of three base vertices, plus an offset along the model's axes in
  // units of the scales below.
  struct GarmentVertex {
    std::array<std::uint32_t, 3> base{};
    std::array<float, 3> weights{};
    glm::vec3 offset{0.0f};
  };
  // The scale of one axis: the distance of two base vertices along the axis, divided by their
  // distance on the author's mesh.
  struct Scale {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    float extent = 1.0f;
  };

  std::string name;
  std::string obj_file;                        // file beside the .mhclo, without folders
  std::array<std::optional<Scale>, 3> scales;  // x, y, z; empty: 1
  std::vector<GarmentVertex> vertices;         // in the order of the .obj
  std::vector<bool> deleted;                   // by base vertex: hidden by this garment
};

// Parses a .mhclo file. `num_base_vertices`: size of the base mesh; every index is checked.
//
// Errors name "source:line": kParse, kInvalidArgument (index out of range, a range that ends before
// it starts), kNonFinite, kSchema (missing obj_file or verts, a scale of length zero, a file name
// with a folder).
[[nodiscard]] Result<Mhclo> ParseMhclo(std::string_view text, std::string_view source,
                                       std::size_t num_base_vertices);

// The positions of the garment's vertices on `base`, in its units.
[[nodiscard]] std::vector<glm::vec3> FitGarment(const Mhclo& garment,
                                                std::span<const glm::vec3> base);

}  // namespace furrow::authoring
