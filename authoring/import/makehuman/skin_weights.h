// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "authoring/import/makehuman/formats/mhclo.h"
#include "authoring/import/makehuman/formats/mhskel.h"
#include "authoring/skinning/influences.h"
#include "base/status.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The skin weights of a mesh.
struct SkinWeights {
  std::vector<Influences> vertices;  // one per vertex
  int unweighted = 0;                // vertices without weights; they follow the root
  int truncated = 0;  // vertices with more than four joints; the weakest were dropped
};

// Converts the weights of a .mhw file to influences of the `num_vertices` base vertices. A vertex
// without weights follows joint 0, the root.
//
// Errors name `source` (the file name) and the joint: kNotFound (a joint missing from the
// skeleton), kInvalidArgument (a vertex missing from the mesh).
[[nodiscard]] Result<SkinWeights> BindBaseMesh(const MhWeights& weights,
                                               const wrinkle::Skeleton& skeleton,
                                               std::size_t num_vertices, std::string_view source);

// Returns the weights of a garment. Each vertex mixes the weights of its three base vertices in the
// proportions of GarmentVertex::weights. Negative proportions, which occur outside the triangle of
// the base vertices, count as 0.
[[nodiscard]] SkinWeights BindGarment(const Mhclo& garment, const SkinWeights& base);

}  // namespace furrow::authoring
