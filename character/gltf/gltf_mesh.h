// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "character/character.h"
#include "character/gltf/gltf_skeleton.h"
#include "character/source_notes.h"
#include "gltf/document/document.h"
#include "gltf/scene/materials.h"
#include "gltf/scene/nodes.h"

namespace furrow::character {

// The meshes of a file, and Character::shapes, which their morph targets refer to.
struct GltfMeshes {
  std::vector<Mesh> meshes;
  std::vector<std::string> shapes;
};

// Reads every primitive of every node that has a mesh, as one Mesh each, in model space. A mesh
// without a skin follows the nearest joint at or above its node.
//
// - Up to 16 influences per vertex are read; the strongest four are kept and normalised.
// - Missing or degenerate normals and tangents are computed.
// - UVs are those of the image: the transform of the mesh's material (KHR_texture_transform) is
//   applied. `materials`: those of the file.
// - Morph targets are read as GltfMorphTargets describes.
//
// Errors: kSchema (missing or mistyped attributes, counts that differ, indices out of range),
// kNonFinite, kInvalidArgument (negative skin weights; weights that are all zero, unless
// options.lenient), kUnsupported (not triangles), kLimit (gltf/limits.h). `where` names the field:
// "meshes[0].primitives[1].attributes.WEIGHTS_0".
[[nodiscard]] Result<GltfMeshes> ReadGltfMeshes(gltf::Document* document,
                                                const gltf::NodeForest& forest,
                                                const GltfSkeleton& skeleton,
                                                const std::vector<gltf::Material>& materials,
                                                const ReadOptions& options = {});

}  // namespace furrow::character
