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

// MakeHuman's .mhclo: how a garment hangs on the base mesh.
struct Mhclo {
  // A garment vertex: `weights` over three base-mesh vertices, plus an offset along the model's
  // axes in units of the scales below.
  struct GarmentVertex {
    std::array<std::uint32_t, 3> base{};
    std::array<float, 3> weights{};
    glm::vec3 offset{0.0f};
  };
  // One axis' scale: the distance along the axis of two base vertices, over what it was for the
  // author.
  struct Scale {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    float extent = 1.0f;
  };

  std::string name;
  std::string obj_file;                        // beside the .mhclo; no folders in it
  std::array<std::optional<Scale>, 3> scales;  // x, y, z; none: 1
  std::vector<GarmentVertex> vertices;         // as many as the .obj has, in its order
  std::vector<bool> deleted;                   // by base vertex: hidden under this garment
};

// `num_base_vertices`: of the mesh it was made for; every index is checked against it.
//
// Errors carry "source:line": kParse, kInvalidArgument (index out of range, a range that runs
// backwards), kNonFinite, kSchema (no obj_file or verts, a scale of zero, a file name with a
// folder).
[[nodiscard]] Result<Mhclo> ParseMhclo(std::string_view text, std::string_view source,
                                       std::size_t num_base_vertices);

// Positions of the garment's vertices on `base`, in its units.
[[nodiscard]] std::vector<glm::vec3> FitGarment(const Mhclo& garment,
                                                std::span<const glm::vec3> base);

}  // namespace furrow::authoring
