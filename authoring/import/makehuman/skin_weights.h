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
  int unweighted = 0;  // vertices without any weight; they follow the root
  int truncated = 0;   // vertices with more than four joints; the weakest were dropped
};

// Weights of `num_vertices` base vertices. A vertex without weights follows joint 0, the root.
//
// Errors name `source` and the joint: kNotFound (a joint the skeleton lacks), kInvalidArgument (a
// vertex the mesh lacks).
[[nodiscard]] Result<SkinWeights> BindBaseMesh(const MhWeights& weights,
                                               const wrinkle::Skeleton& skeleton,
                                               std::size_t num_vertices, std::string_view source);

// Weights of a garment: each vertex mixes those of its three base vertices by the weights it hangs
// by (negative ones, from outside the triangle, count as 0).
[[nodiscard]] SkinWeights BindGarment(const Mhclo& garment, const SkinWeights& base);

}  // namespace furrow::authoring
