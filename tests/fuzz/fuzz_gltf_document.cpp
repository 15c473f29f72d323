// SPDX-License-Identifier: Apache-2.0
// The glTF stack alone: every part that opens must be readable without faults.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gltf/animation/animation.h"
#include "gltf/animation/vrm_animation.h"
#include "gltf/document/accessor.h"
#include "gltf/document/document.h"
#include "gltf/scene/joints.h"
#include "gltf/scene/materials.h"
#include "gltf/scene/meshes.h"
#include "gltf/scene/skins.h"

namespace {

using namespace furrow::gltf;
using furrow::Result;

void ReadScene(Document* document, const NodeForest& forest) {
  NodeSet all(forest);
  all.AddAll();
  if (ListJoints(forest, all, {}, document).joints.size() != forest.nodes.size()) std::abort();
  if (ModelMatrices(forest).size() != forest.nodes.size()) std::abort();
  for (std::size_t skin = 0; skin < NumSkins(*document); ++skin) {
    (void)ReadSkinJoints(*document, skin);
    (void)ReadInverseBindMatrices(*document, skin);
  }
  (void)ReadMaterials(document);
  for (std::size_t image = 0; image < document->images().size(); ++image) {
    (void)LocateImage(*document, image);
  }
  const auto meshes = ReadMeshes(document);
  if (!meshes.ok()) return;
  for (const Mesh& mesh : *meshes) {
    for (const Primitive& primitive : mesh.primitives) {
      if (primitive.morph_targets.size() > mesh.morph_target_names.size()) std::abort();
      for (const auto& [name, index] : primitive.attributes) {
        const auto accessor = Accessor::Create(*document, index, ElementType::kVec3, name);
        if (accessor.ok()) (void)accessor->Float(accessor->size() - 1, 2);
      }
    }
  }
}

// Stands for the decoder, which is another program: a triangle with the attributes 0 to 3.
Result<std::vector<DracoMesh>> DecodeToTriangles(
    std::span<const std::span<const std::uint8_t>> compressed) {
  DracoMesh triangle{.num_points = 3, .indices = {0, 1, 2}};
  for (std::uint32_t id = 0; id < 4; ++id) {
    const int components = static_cast<int>(id) + 1;
    triangle.attributes.push_back(
        {id, 5126, components,
         std::vector<std::uint8_t>(static_cast<std::size_t>(12 * components))});
  }
  return std::vector<DracoMesh>(compressed.size(), triangle);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const Contents contents : {Contents::kAnimation, Contents::kCharacter}) {
    const DracoDecoder draco = DecodeToTriangles;
    auto document = Document::Open(bytes, {.contents = contents, .folder = {}, .draco = &draco});
    if (!document.ok()) continue;
    const auto forest = ReadNodes(&*document);
    if (!forest.ok()) continue;
    ReadScene(&*document, *forest);
    (void)ReadVrmAnimation(*document);
    const auto animation = ReadAnimation(&*document, *forest);
    if (!animation.ok()) continue;
    for (const NodeTrack& track : animation->tracks) {
      if (track.target == TrackTarget::kMorphWeights) continue;
      float values[4];
      track.track.Evaluate(0.5, values);
    }
  }
  return 0;
}
