// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_reader.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "character/gltf/gltf_material.h"
#include "character/gltf/gltf_material_binds.h"
#include "character/gltf/gltf_mesh.h"
#include "character/gltf/gltf_shape_rules.h"
#include "character/gltf/gltf_skeleton.h"
#include "character/source_notes.h"
#include "gltf/document/document.h"
#include "gltf/scene/material_binds.h"
#include "gltf/scene/materials.h"
#include "gltf/scene/nodes.h"

namespace furrow::character {
namespace {

// Removes the pictures without pixels, which ReadGltfPictures() leaves for images not decoded, and
// the references to them.
void DropMissingPictures(Character* character) {
  std::vector<Picture> kept;
  std::vector<int> index;
  for (Picture& picture : character->pictures) {
    index.push_back(picture.width > 0 ? static_cast<int>(kept.size()) : -1);
    if (picture.width > 0) kept.push_back(std::move(picture));
  }
  character->pictures = std::move(kept);
  for (Material& material : character->materials) {
    for (int* picture :
         {&material.base_colour_texture, &material.normal_texture, &material.roughness_texture,
          &material.emission_texture, &material.thickness_texture}) {
      if (*picture >= 0) *picture = index[static_cast<std::size_t>(*picture)];
    }
  }
}

// Gives meshes without a material that of glTF: white, and as rough as can be (3.9.6).
void AddDefaultMaterial(Character* character) {
  const int added = static_cast<int>(character->materials.size());
  bool is_needed = false;
  for (Mesh& mesh : character->meshes) {
    if (mesh.material >= 0) continue;
    mesh.material = added;
    is_needed = true;
  }
  if (!is_needed) return;
  Material& material = character->materials.emplace_back();
  material.name = "default";
  material.roughness = 1.0f;
}

// Reads the binds of materials, which may add shapes.
Status ReadMaterialBinds(gltf::Document* document, std::span<const gltf::Material> materials,
                         const ReadOptions& options, Character* character) {
  const Result<std::vector<gltf::MaterialBind>> from = gltf::ReadMaterialBinds(document, materials);
  FURROW_RETURN_IF_ERROR(from);
  const std::vector<std::string> surplus =
      MakeMaterialBinds(*from, &character->shapes, &character->material_binds);
  if (!surplus.empty()) {
    document->Warn("extensions.VRM", "the avatar has more than " + std::to_string(kMaxShapes) +
                                         " shapes; left out, with what they change in materials: " +
                                         std::to_string(surplus.size()));
  }
  if (options.notes != nullptr) {
    // A shape that moves nothing may still change a colour.
    std::erase_if(options.notes->idle_shapes, [&](const std::string& name) {
      return std::ranges::find(character->shapes, name) != character->shapes.end();
    });
  }
  return {};
}

}  // namespace

Status ReadGltfCharacter(std::string_view bytes, const std::filesystem::path& folder,
                         const ReadOptions& options, Character* character) {
  Result<gltf::Document> document = gltf::Document::Open(
      bytes, {.contents = gltf::Contents::kCharacter, .folder = folder, .draco = options.draco});
  FURROW_RETURN_IF_ERROR(document);
  const Result<gltf::NodeForest> forest = gltf::ReadNodes(&*document);
  FURROW_RETURN_IF_ERROR(forest);
  Result<GltfSkeleton> skeleton = ReadGltfSkeleton(&*document, *forest, options);
  FURROW_RETURN_IF_ERROR(skeleton);
  const Result<std::vector<gltf::Material>> materials = gltf::ReadMaterials(&*document);
  FURROW_RETURN_IF_ERROR(materials);
  Result<GltfMeshes> meshes = ReadGltfMeshes(&*document, *forest, *skeleton, *materials, options);
  FURROW_RETURN_IF_ERROR(meshes);
  Result<std::vector<Picture>> pictures = ReadGltfPictures(*document, *materials, options);
  FURROW_RETURN_IF_ERROR(pictures);
  if (options.notes != nullptr) {
    options.notes->nameless_joints = skeleton->num_nameless_joints;
    options.notes->look_at = gltf::ReadVrmLookAt(*document);
  }
  character->name = document->SceneName();
  character->skeleton = std::move(skeleton->skeleton);
  character->roles = std::move(skeleton->roles);
  character->inverse_bind_matrices = std::move(skeleton->inverse_bind_matrices);
  character->meshes = std::move(meshes->meshes);
  character->shapes = std::move(meshes->shapes);
  FURROW_RETURN_IF_ERROR(ReadMaterialBinds(&*document, *materials, options, character));
  character->shape_rules = MakeShapeRules(gltf::ReadExpressionRules(&*document), character->shapes);
  character->materials = MakeGltfMaterials(*materials);
  AddDefaultMaterial(character);
  character->pictures = std::move(*pictures);
  character->warnings = document->warnings();
  if (options.lenient || options.pictures == Pictures::kLeaveOut) DropMissingPictures(character);
  return {};
}

Result<NamedRoles> ReadGltfRoles(std::string_view bytes, const std::filesystem::path& folder) {
  // What animations need of a file: its nodes and the joints of its skins.
  Result<gltf::Document> document =
      gltf::Document::Open(bytes, {.contents = gltf::Contents::kAnimation, .folder = folder});
  FURROW_RETURN_IF_ERROR(document);
  const Result<gltf::NodeForest> forest = gltf::ReadNodes(&*document);
  FURROW_RETURN_IF_ERROR(forest);
  return ReadGltfRoles(&*document, *forest);
}

}  // namespace furrow::character
