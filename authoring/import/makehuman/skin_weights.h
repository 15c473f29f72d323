// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "authoring/import/makehuman/mhclo.h"
#include "authoring/import/makehuman/mhskel.h"
#include "authoring/skinning/influences.h"
#include "base/status.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

struct SkinWeights {
  std::vector<Influences> vertices;
  int unweighted = 0;  // vertices without weights; they follow the root
  int truncated = 0;   // vertices with more than four joints; the weakest were dropped
};

// The weights of `num_vertices` base vertices. A vertex without weights follows joint 0, the root.
//
// Errors name `source` and the joint: kNotFound (a joint missing from the skeleton),
// kInvalidArgument (a vertex missing from the mesh).
[[nodiscard]] Result<SkinWeights> BindBaseMesh(const MhWeights& weights,
                                               const wrinkle::Skeleton& skeleton,
                                               std::size_t num_vertices, std::string_view source);

// The weights of a garment. Each vertex mixes the weights of its three base vertices. Negative
// mixing weights, which occur outside the triangle, count as 0.
[[nodiscard]] SkinWeights BindGarment(const Mhclo& garment, const SkinWeights& base);

}  // namespace furrow::authoring
