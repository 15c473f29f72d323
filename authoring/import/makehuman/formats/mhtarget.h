// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "base/status.h"

namespace furrow::authoring {

// The content of MakeHuman's .target file: how far vertices of the base mesh move where the target
// has its full weight. A file without vertices is valid; several of MakeHuman's are.
struct MhTarget {
  std::vector<std::uint32_t> vertices;  // of the base mesh
  std::vector<glm::vec3> offsets;       // one per vertex, decimetres
};

// Parses a .target file. `source`: the file name in errors. `num_base_vertices`: number of vertices
// of the base mesh, against which every index is checked.
//
// Errors name "source:line": kParse, kInvalidArgument (index out of range), kNonFinite, kLimit (an
// offset of 1,000 or more, more lines than base vertices), and kUnsupported for a Git LFS pointer.
[[nodiscard]] Result<MhTarget> ParseMhTarget(std::string_view text, std::string_view source,
                                             std::size_t num_base_vertices);

// Makes the target from the two arrays that MakeHuman's targets.npz holds for it: "NAME.index.npy"
// (uint16, one per vertex) and "NAME.vector.npy" (int16, three per vertex, thousandths of a
// decimetre).
//
// Errors name the source: those of ParseNpy(), kSchema (arrays of other types, or whose sizes
// differ), kInvalidArgument (index out of range), kLimit (more vertices than the base mesh has).
[[nodiscard]] Result<MhTarget> ParseMhTargetArrays(std::string_view index_npy,
                                                   std::string_view vector_npy,
                                                   std::string_view source,
                                                   std::size_t num_base_vertices);

// Moves `positions` (the base mesh in decimetres) by `weight` times the offsets. Precondition: the
// target was parsed for a mesh of as many vertices.
void ApplyMhTarget(const MhTarget& target, float weight, std::span<glm::vec3> positions);

}  // namespace furrow::authoring
