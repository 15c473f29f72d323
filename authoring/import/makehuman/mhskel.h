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

// MakeHuman's .mhskel file. Heads and tails of joints are means of base vertices, so the skeleton
// fits every shape of the mesh.
struct MhSkeleton {
  struct Joint {
    std::string name;
    std::string parent;               // empty: a root
    std::vector<std::uint32_t> head;  // base vertices; the joint's origin is their mean
    std::vector<std::uint32_t> tail;
  };
  std::vector<Joint> joints;
};

// Parses a .mhskel file. Errors name `source` and the line of invalid JSON or the field: kParse,
// kSchema (field missing or of the wrong type), kNotFound (a head or tail missing from "joints"),
// kLimit.
[[nodiscard]] Result<MhSkeleton> ParseMhskel(std::string_view text, std::string_view source);

// MakeHuman's .mhw file: a list of (vertex, weight) per joint.
struct MhWeights {
  struct Joint {
    std::string name;
    std::vector<std::pair<std::uint32_t, float>> vertices;
  };
  std::vector<Joint> joints;
};

// Parses a .mhw file. Errors: as above, and kNonFinite or kInvalidArgument (weight outside [0, 1]).
[[nodiscard]] Result<MhWeights> ParseMhw(std::string_view text, std::string_view source);

// Builds the skeleton on `positions` (model space, any unit). Origins are at the heads, tails are
// stored, and the axes of every joint are parallel to the model's, so that rotations in MakeHuman's
// BVH files apply unchanged.
//
// Errors name `source` and the joint: kInvalidArgument (a vertex missing from the mesh), kNotFound
// (unknown parent), kCyclic, kLimit.
[[nodiscard]] Result<wrinkle::Skeleton> BuildSkeleton(const MhSkeleton& skeleton,
                                                      std::span<const glm::vec3> positions,
                                                      std::string_view source);

}  // namespace furrow::authoring
