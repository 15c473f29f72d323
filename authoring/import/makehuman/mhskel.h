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

// MakeHuman's .mhskel: joints whose heads and tails are means of base-mesh vertices, so that the
// skeleton fits whatever shape the mesh has.
struct MhSkeleton {
  struct Joint {
    std::string name;
    std::string parent;               // empty: a root
    std::vector<std::uint32_t> head;  // base-mesh vertices; their mean is the joint's origin
    std::vector<std::uint32_t> tail;
  };
  std::vector<Joint> joints;
};

// Errors name `source` and the line of broken JSON or the field: kParse, kSchema (a field that is
// missing or of the wrong type), kNotFound (a head or tail that "joints" does not list), kLimit.
[[nodiscard]] Result<MhSkeleton> ParseMhskel(std::string_view text, std::string_view source);

// MakeHuman's .mhw: (vertex, weight) lists by joint.
struct MhWeights {
  struct Joint {
    std::string name;
    std::vector<std::pair<std::uint32_t, float>> vertices;
  };
  std::vector<Joint> joints;
};

// Errors as above, and kNonFinite or kInvalidArgument for a weight that is not a number in [0, 1].
[[nodiscard]] Result<MhWeights> ParseMhw(std::string_view text, std::string_view source);

// The skeleton on `positions` (model space, any unit): origins at the heads, tails stored, and
// every joint's axes parallel to the model's, so that a BVH rotation of MakeHuman's applies as it
// stands.
//
// Errors name `source` and the joint: kInvalidArgument (a vertex the mesh lacks), kNotFound (a
// parent that is not there), kCyclic, kLimit.
[[nodiscard]] Result<wrinkle::Skeleton> BuildSkeleton(const MhSkeleton& skeleton,
                                                      std::span<const glm::vec3> positions,
                                                      std::string_view source);

}  // namespace furrow::authoring
