// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "character/gltf_skeleton.h"

namespace furrow::character {

inline constexpr std::size_t kMaxVertices = 8u << 20;
inline constexpr std::size_t kMaxIndices = 48u << 20;

// Every primitive of every node with a mesh, as one Mesh each. A mesh without skin follows the
// nearest joint above its node.
//
// Errors name the field: "meshes[0].primitives[1].attributes.WEIGHTS_0". kSchema (missing or
// mistyped attributes, counts that differ, indices out of range), kNonFinite, kInvalidArgument
// (skin weights negative, or all zero unless read leniently), kUnsupported (not triangles), kLimit.
[[nodiscard]] Result<std::vector<Mesh>> ReadGltfMeshes(const tinygltf::Model& model,
                                                       const GltfSkeleton& skeleton,
                                                       const ReadOptions& options = {});

}  // namespace furrow::character
