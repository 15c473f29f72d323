// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/own_parts.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/import/makehuman/face/prop_paint.h"
#include "authoring/import/makehuman/hair.h"
#include "authoring/paint/teeth.h"

namespace furrow::authoring {
namespace {

using character::Material;

int SmallSize(const PartSource& source) { return std::max(source.texture_size / 2, 64); }

void AddPart(character::Mesh mesh, const PartSource& source) {
  if (mesh.indices.empty()) {
    source.warnings->push_back("base.obj has no group '" + mesh.name + "'; skipped");
    return;
  }
  source.character->meshes.push_back(std::move(mesh));
}

}  // namespace

int AddPicture(character::Picture picture, character::Character* character) {
  character->pictures.push_back(std::move(picture));
  return static_cast<int>(character->pictures.size()) - 1;
}

int AddMaterial(Material material, character::Character* character) {
  character->materials.push_back(std::move(material));
  return static_cast<int>(character->materials.size()) - 1;
}

void AddOwnEyes(const PartSource& source) {
  Material material{.name = "eye", .kind = Material::Kind::kEye, .roughness = 0.12f};
  material.base_colour_texture = AddPicture(PaintEye(SmallSize(source)), source.character);
  const int index = AddMaterial(material, source.character);
  constexpr const char* kGroups[2] = {"helper-l-eye", "helper-r-eye"};
  constexpr const char* kJoints[2] = {"eye.L", "eye.R"};
  for (std::size_t s = 0; s < 2; ++s) {
    const FaceLandmarks::Side& side = source.face.sides[s];
    const glm::vec3 sight = side.pupil - side.eye;
    const glm::vec3 forward =
        glm::length(sight) > 1e-6f ? glm::normalize(sight) : glm::vec3(0.0f, 0.0f, 1.0f);
    const int joint = source.character->skeleton.Find(kJoints[s]);
    AddPart(BuildEye(source.base, kGroups[s], joint, forward, index), source);
  }
}

void AddOwnTeeth(const PartSource& source) {
  Material teeth{.name = "teeth", .roughness = 0.3f};
  teeth.base_colour_texture = AddPicture(
      PaintTeeth(std::max(0.1f, 0.8f * source.look.old), SmallSize(source)), source.character);
  const int material = AddMaterial(teeth, source.character);
  AddPart(BuildTeeth(source.base, "helper-upper-teeth", true, material), source);
  AddPart(BuildTeeth(source.base, "helper-lower-teeth", false, material), source);
}

void AddOwnTongue(const PartSource& source) {
  const int tongue = AddMaterial(
      {.name = "tongue", .base_colour = glm::vec4(0.20f, 0.05f, 0.05f, 1.0f), .roughness = 0.5f},
      source.character);
  AddPart(BuildHelper(source.base, "helper-tongue", tongue), source);
}

void AddOwnHair(const PartSource& source) {
  Material hair{.name = "hair", .kind = Material::Kind::kHair, .roughness = 0.45f};
  hair.double_sided = true;
  hair.base_colour_texture =
      AddPicture(PaintMakeHumanHair(source.look, SmallSize(source)), source.character);
  const int material = AddMaterial(hair, source.character);
  AddPart(BuildMakeHumanHair(source.character->meshes.front(), source.face, material), source);
}

void AddOwnLashes(const PartSource& source) {
  Material lashes{.name = "lashes", .kind = Material::Kind::kHair, .roughness = 0.6f};
  lashes.double_sided = true;
  lashes.alpha_cutoff = kLashCutoff;
  lashes.base_colour_texture = AddPicture(PaintLashes(SmallSize(source)), source.character);
  const int material = AddMaterial(lashes, source.character);
  for (int s = 0; s < 2; ++s) {
    const std::string group = s == 0 ? "helper-l-eyelashes-" : "helper-r-eyelashes-";
    const glm::vec3& eye = source.face.sides[s].eye;
    AddPart(BuildLashes(source.base, group + "1", eye, 0.6f, material), source);
    AddPart(BuildLashes(source.base, group + "2", eye, 1.0f, material), source);
  }
}

}  // namespace furrow::authoring
