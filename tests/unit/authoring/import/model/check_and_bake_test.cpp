// SPDX-License-Identifier: Apache-2.0
// `furrow character check` and `furrow bake` agree: a character without errors can be baked.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/bake/surface/surface_check.h"
#include "authoring/import/model/character_check.h"
#include "authoring/import/model/character_report.h"
#include "character/source_notes.h"
#include "rig/rig_file.h"
#include "tests/unit/authoring/import/model/toy_body.h"

namespace furrow::authoring {
namespace {

using character::Character;
using character::Material;
using Surface = wrinkle::WrinkleMap::Surface;

constexpr char kRig[] = R"({
  "name": "toy",
  "reference_poses": [{"name": "nod", "joints": [{"joint": "head", "translation": [0, -0.05, 0]}]}],
  "drivers": [{"name": "head", "pose": {"points": [{"joint": "head", "kind": "origin"}],
    "values": [{"name": "down", "reference_pose": "nod"}]}}],
  "regions": [{"name": "neck", "mask": {"kind": "skinning"}, "feeds": [
    {"map": "folds", "sources": [{"from": "head.down"}]},
    {"map": "creases", "sources": [{"from": "head.down"}]}]}],
  "wrinkle_maps": [{"name": "folds", "surface": "skin"}, {"name": "creases", "surface": "cloth"}]})";

// A body of skin, and a coat that is the same boxes again.
Character DressedBody() {
  Character body = ToyBody();
  body.materials.push_back({.name = "coat", .kind = Material::Kind::kCloth});
  body.meshes.push_back(body.meshes[0]);
  body.meshes[1].name = "coat";
  body.meshes[1].material = 1;
  auto rig = rig::ParseRig(kRig, "toy.json", ".");
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  if (rig.ok()) body.rig = std::move(*rig);
  return body;
}

CharacterReport Check(const Character& body) {
  const character::MeshNotes good{
      .skinned = true, .has_uvs = true, .has_normals = true, .has_tangents = true};
  character::SourceNotes notes;
  notes.meshes.assign(body.meshes.size(), good);
  return CheckCharacter(body, notes, VrmMaps(), true);
}

// What `furrow bake` does, at the smallest size.
Status BakeAll(const Character& body) {
  auto poses = CollectBakePoses(body);
  FURROW_RETURN_IF_ERROR(poses);
  std::vector<std::string> warnings;
  const auto bakeable = CheckSurfaces(body, {}, &warnings);
  FURROW_RETURN_IF_ERROR(bakeable);
  std::erase_if(poses->poses, [&](const BakePose& pose) {
    return std::ranges::find(bakeable->names, pose.map) == bakeable->names.end();
  });
  BakeOptions options;
  options.size = 64;
  const auto maps = Bake(body, poses->poses, {}, options, {});
  FURROW_RETURN_IF_ERROR(maps);
  EXPECT_EQ(maps->maps.size(), bakeable->names.size());
  return {};
}

struct Case {
  const char* name;
  int bakes;         // number of maps; 0: refused
  const char* code;  // a finding of the check; may be null
  std::function<void(Character*)> change;
};

void FlattenUvs(int mesh, Character* body) {
  for (character::Vertex& vertex : body->meshes[static_cast<std::size_t>(mesh)].vertices)
    vertex.uv = {0.5f, 0.5f};
}

class CheckAndBake : public ::testing::TestWithParam<Case> {};

TEST_P(CheckAndBake, Agree) {
  Character body = DressedBody();
  GetParam().change(&body);
  const CharacterReport report = Check(body);
  const Status baked = BakeAll(body);
  EXPECT_EQ(report.Count(Severity::kError) == 0, baked.ok()) << ToText(report) << baked.ToString();
  EXPECT_EQ(baked.ok(), GetParam().bakes > 0);
  std::vector<std::string> warnings;
  const auto bakeable = CheckSurfaces(body, {}, &warnings);
  if (baked.ok()) {
    EXPECT_EQ(static_cast<int>(bakeable->names.size()), GetParam().bakes);
  }
  const bool found = std::ranges::any_of(report.findings, [](const Finding& finding) {
    return GetParam().code != nullptr && finding.code == GetParam().code;
  });
  EXPECT_EQ(found, GetParam().code != nullptr) << ToText(report);
}

INSTANTIATE_TEST_SUITE_P(
    Each, CheckAndBake,
    ::testing::Values(
        Case{"Good", 2, nullptr, [](Character*) {}},
        Case{"NoCloth", 1, "rig-surface", [](Character* c) { c->meshes.pop_back(); }},
        Case{"OnlyClothMapsWithoutCloth", 0, "rig-surface",
             [](Character* c) {
               c->meshes.pop_back();
               c->rig.wrinkle_maps[0].surface = Surface::kCloth;
             }},
        Case{"SkinUvsAtOnePoint", 1, "rig-surface", [](Character* c) { FlattenUvs(0, c); }},
        Case{"AllUvsAtOnePoint", 0, "rig-surface",
             [](Character* c) {
               FlattenUvs(0, c);
               FlattenUvs(1, c);
             }},
        Case{"OtherMaterialsAreSkin", 2, nullptr,
             [](Character* c) { c->materials[0].kind = Material::Kind::kOther; }},
        Case{"OtherMaterialsWithoutUvs", 1, "rig-surface",
             [](Character* c) {
               c->materials[0].kind = Material::Kind::kOther;
               FlattenUvs(0, c);
             }},
        Case{"NoMaterial", 2, nullptr, [](Character* c) { c->meshes[0].material = -1; }},
        Case{"SkinWithoutWrinkles", 1, "rig-surface",
             [](Character* c) { c->materials[0].wrinkles = false; }},
        Case{"OnlyHair", 0, "rig-surface",
             [](Character* c) {
               for (Material& m : c->materials) m.kind = Material::Kind::kHair;
             }},
        Case{"OverlappingUvs", 2, "uv-overlap",
             [](Character* c) {
               for (std::size_t v = 0; v < 24; ++v) {
                 c->meshes[0].vertices[v].uv = c->meshes[0].vertices[v + 48].uv;
               }
             }},
        Case{"FlatTriangles", 2, "degenerate-triangles",
             [](Character* c) { c->meshes[0].indices[1] = c->meshes[0].indices[0]; }},
        Case{"APoseAtRest", 0, "rig-poses",
             [](Character* c) { c->rig.reference_poses[0].joints.clear(); }},
        Case{"AnUnknownJoint", 0, "rig-binding",
             [](Character* c) {
               for (auto& joint : c->rig.reference_poses[0].joints) joint.joint = "tail";
             }}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace furrow::authoring
