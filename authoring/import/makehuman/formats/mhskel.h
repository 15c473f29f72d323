// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The content of MakeHuman's .mhskel file. Both ends of a joint, head and tail, are means of
// vertices of the base mesh, so the skeleton fits every shape of the mesh.
struct MhSkeleton {
  struct Joint {
    std::string name;
    std::string parent;               // empty: a root
    std::vector<std::uint32_t> head;  // base vertices; the joint's origin is their mean
    std::vector<std::uint32_t> tail;  // base vertices; the far end of the joint is their mean
  };
  std::vector<Joint> joints;
};

// Parses a .mhskel file (JSON). `source`: the file name in errors. Errors name `source` and the
// line of invalid JSON or the field: kParse, kSchema (field missing or of the wrong type),
// kNotFound (a head or tail missing from "joints"), kLimit.
[[nodiscard]] Result<MhSkeleton> ParseMhskel(std::string_view text, std::string_view source);

// The content of MakeHuman's .mhw file: the skin weights of the base mesh.
struct MhWeights {
  struct Joint {
    std::string name;
    std::vector<std::pair<std::uint32_t, float>> vertices;  // (base vertex, weight in [0, 1])
  };
  std::vector<Joint> joints;
};

// Parses a .mhw file (JSON). Errors: kParse, kSchema, kLimit, kInvalidArgument (a weight outside
// [0, 1]).
[[nodiscard]] Result<MhWeights> ParseMhw(std::string_view text, std::string_view source);

// Builds the skeleton on the base mesh with `positions` (model space, any unit). Joints have their
// origins at the heads and keep their tails. The axes of every joint are parallel to the model's,
// so rotations in MakeHuman's BVH files apply unchanged.
//
// Errors name `source` and the joint: kInvalidArgument (a vertex missing from the mesh), kNotFound
// (unknown parent), kCyclic, kLimit.
[[nodiscard]] Result<wrinkle::Skeleton> BuildSkeleton(const MhSkeleton& skeleton,
                                                      std::span<const glm::vec3> positions,
                                                      std::string_view source);

}  // namespace furrow::authoring
