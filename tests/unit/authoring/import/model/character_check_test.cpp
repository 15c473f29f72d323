// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/character_check.h"

#include <algorithm>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "authoring/import/model/character_report.h"
#include "character/source_notes.h"
#include "tests/unit/authoring/import/model/toy_body.h"

namespace furrow::authoring {
namespace {

using ::testing::HasSubstr;

// The reader's notes on a valid file.
character::SourceNotes GoodNotes() {
  character::SourceNotes notes;
  notes.meshes.push_back(
      {.skinned = true, .has_uvs = true, .has_normals = true, .has_tangents = true});
  return notes;
}

const Finding* FindFinding(const CharacterReport& report, const std::string& code) {
  const auto found = std::find_if(report.findings.begin(), report.findings.end(),
                                  [&](const Finding& finding) { return finding.code == code; });
  return found == report.findings.end() ? nullptr : &*found;
}

TEST(CharacterCheck, GoodBodyLacksOnlyFaceAndRig) {
  const CharacterReport report = CheckCharacter(ToyBody(), GoodNotes(), VrmMaps(), false);
  EXPECT_EQ(report.Count(Severity::kError), 0u) << ToText(report);
  EXPECT_EQ(report.Count(Severity::kWarning), 0u) << ToText(report);
  EXPECT_NE(FindFinding(report, "no-rig"), nullptr);
  EXPECT_NE(FindFinding(report, "no-face-joints"), nullptr);
  EXPECT_EQ(report.space.axes, "up +Y, facing +Z");
  EXPECT_EQ(report.joints.map, "vrm");
  EXPECT_EQ(report.joints.num_roles, 19);
}

// Gives the mesh the shapes by which a face is recognised.
void AddShapeFace(character::Character* character) {
  character->shapes = {"browInnerUp",   "browDownLeft",   "browDownRight",  "eyeBlinkLeft",
                       "eyeBlinkRight", "mouthSmileLeft", "mouthSmileRight"};
  for (int shape = 0; shape < 7; ++shape) {
    character::MorphTarget& target = character->meshes[0].morph_targets.emplace_back();
    target.shape = shape;
    target.deltas.push_back({.vertex = 0, .position = {0.0f, 0.01f, 0.0f}});
  }
}

// Heads without a skeleton are common: scans, and test files of trackers.
TEST(CharacterCheck, AFaceOfBlendShapesNeedsNoSkin) {
  character::Character face = ToyBody();
  AddShapeFace(&face);
  character::SourceNotes notes = GoodNotes();
  for (character::MeshNotes& mesh : notes.meshes) mesh.skinned = false;
  const CharacterReport report = CheckCharacter(face, notes, VrmMaps(), false);
  const Finding* finding = FindFinding(report, "no-skin");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, Severity::kNote);
  EXPECT_EQ(report.Count(Severity::kError), 0u) << ToText(report);
  EXPECT_NE(FindFinding(report, "shape-face"), nullptr);
}

// An error only if nothing else has UVs.
TEST(CharacterCheck, APartWithoutUvsIsAWarning) {
  character::Character body = ToyBody();
  body.meshes.push_back(body.meshes[0]);
  character::SourceNotes notes = GoodNotes();
  notes.meshes.push_back(notes.meshes[0]);
  notes.meshes[1].has_uvs = false;
  const CharacterReport report = CheckCharacter(body, notes, VrmMaps(), false);
  EXPECT_EQ(report.Count(Severity::kError), 0u) << ToText(report);
  const Finding* finding = FindFinding(report, "uv-missing");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, Severity::kWarning);
}

struct Fault {
  const char* code;
  Severity severity;
  const char* says;
  std::function<void(character::Character*, character::SourceNotes*)> make;
};

class CharacterFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(CharacterFaults, AreReported) {
  character::Character body = ToyBody();
  character::SourceNotes notes = GoodNotes();
  GetParam().make(&body, &notes);
  const CharacterReport report = CheckCharacter(body, notes, VrmMaps(), false);
  const Finding* finding = FindFinding(report, GetParam().code);
  ASSERT_NE(finding, nullptr) << ToText(report);
  EXPECT_EQ(finding->severity, GetParam().severity);
  EXPECT_THAT(finding->what, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Each, CharacterFaults,
    ::testing::Values(
        Fault{
            "no-skin", Severity::kError, "no mesh is skinned",
            [](character::Character*, character::SourceNotes* n) { n->meshes[0].skinned = false; }},
        Fault{
            "uv-missing", Severity::kWarning, "nothing folds",
            [](character::Character*, character::SourceNotes* n) { n->meshes[0].has_uvs = false; }},
        Fault{"uv-missing", Severity::kWarning, "one point",
              [](character::Character* c, character::SourceNotes*) {
                for (character::Vertex& v : c->meshes[0].vertices) v.uv = {0.5f, 0.5f};
              }},
        Fault{"uv-overlap", Severity::kWarning, "used twice",
              [](character::Character* c, character::SourceNotes*) {
                for (std::size_t v = 0; v < 24; ++v) {
                  c->meshes[0].vertices[v].uv = c->meshes[0].vertices[v + 48].uv;
                }
              }},
        Fault{"unskinned-vertices", Severity::kError, "3 vertices follow no joint",
              [](character::Character*, character::SourceNotes* n) {
                n->meshes[0].unskinned_vertices = 3;
              }},
        Fault{
            "degenerate-triangles", Severity::kNote, "1 triangle has no area",
            [](character::Character* c, character::SourceNotes*) { c->meshes[0].indices[1] = 0; }},
        Fault{"weights-sum", Severity::kWarning, "the worst: 1.8",
              [](character::Character*, character::SourceNotes* n) {
                n->meshes[0].unnormalised_vertices = 5;
                n->meshes[0].worst_sum = 1.8f;
              }},
        Fault{"weights-truncated", Severity::kNote, "more than four",
              [](character::Character*, character::SourceNotes* n) {
                n->meshes[0].truncated_vertices = 2;
              }},
        Fault{"normals-missing", Severity::kWarning, "computed",
              [](character::Character*, character::SourceNotes* n) {
                n->meshes[0].has_normals = false;
              }},
        Fault{"tangents-missing", Severity::kNote, "computed",
              [](character::Character*, character::SourceNotes* n) {
                n->meshes[0].has_tangents = false;
              }},
        Fault{"idle-shapes", Severity::kNote, "7 shapes move nothing visibly: a, b, c, d, e, ...",
              [](character::Character*, character::SourceNotes* n) {
                n->idle_shapes = {"a", "b", "c", "d", "e", "f", "g"};
              }},
        Fault{"shape-face", Severity::kNote, "has ARKit's blend shapes",
              [](character::Character* c, character::SourceNotes*) { AddShapeFace(c); }},
        Fault{"few-shapes", Severity::kNote, "it lacks browInnerUp, browDownLeft, browDownRight",
              [](character::Character* c, character::SourceNotes*) {
                AddShapeFace(c);
                for (int brow = 0; brow < 3; ++brow) c->shapes[brow] = std::string(3, 'x');
              }},
        Fault{"picture-missing", Severity::kWarning, "skin.png",
              [](character::Character*, character::SourceNotes* n) {
                n->missing_pictures = {"skin.png: no such file"};
              }},
        Fault{"joint-names", Severity::kWarning, "4 joints have no name",
              [](character::Character*, character::SourceNotes* n) { n->nameless_joints = 4; }},
        Fault{"units", Severity::kWarning, "the unit is probably 0.01 m",
              [](character::Character* c, character::SourceNotes*) {
                ASSERT_TRUE(MoveToSpace(glm::mat3(1.0f), 100.0f, c).ok());
              }},
        Fault{"up-axis", Severity::kWarning, "up +Z, facing -Y",
              [](character::Character* c, character::SourceNotes*) {
                ASSERT_TRUE(MoveToSpace(glm::mat3(1, 0, 0, 0, 0, 1, 0, -1, 0), 1.0f, c).ok());
              }}));

// The inside of closed lips is flat at rest, and opens with the jaw.
TEST(CharacterCheck, TrianglesThatAShapeOpensStay) {
  character::Character body = ToyBody();
  character::Mesh& mesh = body.meshes[0];
  mesh.vertices[mesh.indices[1]].position = mesh.vertices[mesh.indices[0]].position;
  EXPECT_EQ(CountDegenerateTriangles(mesh), 1u);
  mesh.morph_targets = {{0, {{mesh.indices[1], glm::vec3(0.01f, 0, 0), {}, {}}}}};
  EXPECT_EQ(CountDegenerateTriangles(mesh), 0u);
  EXPECT_EQ(DropDegenerateTriangles(&mesh), 0u);
}

TEST(CharacterCheck, JsonContainsTheSameFindings) {
  character::SourceNotes notes = GoodNotes();
  notes.meshes[0].unskinned_vertices = 1;
  const CharacterReport report = CheckCharacter(ToyBody(), notes, VrmMaps(), false);
  const auto json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["counts"]["joints"], 19);
  EXPECT_EQ(json["findings"].size(), report.findings.size());
  EXPECT_EQ(json["findings"][0]["severity"], "error");
  EXPECT_EQ(json["findings"][0]["code"], "unskinned-vertices");
}

}  // namespace
}  // namespace furrow::authoring
