// SPDX-License-Identifier: Apache-2.0
#include "character/package/rig_patch.h"

#include <memory>
#include <span>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wrinkle/solver/solver.h"

namespace furrow::character {
namespace {

using ::testing::HasSubstr;

constexpr int kCells = 10;
constexpr float kSide = 0.1f;

// A square sheet of skin with 10 cells per side, moved by `low` at the bottom and by `high` at the
// top, and a second sheet 1 mm in front of it that shares no vertices with it.
Character Sheets() {
  Character character;
  character.name = "sheets";
  character.skeleton = *wrinkle::Skeleton::Create(
      {{"root", -1, {}, {}}, {"low", 0, {}, {}}, {"high", 0, {{0.0f, kSide, 0.0f}}, {}}});
  character.rig.anchor = "root";
  character.materials = {{.name = "skin", .kind = Material::Kind::kSkin}};
  for (const float z : {0.0f, 0.001f}) {
    Mesh& mesh = character.meshes.emplace_back();
    mesh.name = z == 0.0f ? "sheet" : "veil";
    mesh.material = 0;
    for (int y = 0; y <= kCells; ++y) {
      for (int x = 0; x <= kCells; ++x) {
        const glm::vec2 t = glm::vec2(x, y) / static_cast<float>(kCells);
        Vertex& vertex = mesh.vertices.emplace_back();
        vertex.position = glm::vec3(kSide * t, z);
        vertex.joints[0] = 1;
        vertex.joints[1] = 2;
        vertex.skin_weights[0] = 1.0f - t.y;
        vertex.skin_weights[1] = t.y;
        if (x == kCells || y == kCells) continue;
        const auto i = static_cast<std::uint32_t>(y * (kCells + 1) + x);
        for (const std::uint32_t corner : {0u, 1u, 11u, 1u, 12u, 11u}) {
          mesh.indices.push_back(i + corner);
        }
      }
    }
  }
  return character;
}

PatchOptions Middle(float radius = 0.025f) {
  return {.name = "p", .centre = {0.05f, 0.05f, 0.0f}, .radius = radius};
}

TEST(RigPatch, MeasuresTheStrainOfItsSurface) {
  const Character sheets = Sheets();
  const auto driver = CutPatch(sheets, Middle());
  ASSERT_TRUE(driver.ok()) << driver.status().ToString();
  EXPECT_EQ(driver->strain.joint, "root");
  wrinkle::Rig rig;
  rig.drivers = {*driver};
  auto binding = wrinkle::RigBinding::Create(rig, sheets.skeleton, {});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  wrinkle::LocalPose pose;
  pose.SetRest(sheets.skeleton);
  pose.joints[2].translation.y -= 0.1f * kSide;  // 9/10 of the height
  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)));
  ASSERT_EQ(solver.Update(pose, 0.0), wrinkle::JobStatus::kOk);
  const std::span<const float> values = solver.driver_values();
  EXPECT_NEAR(values[0], 0.4f, 2e-3f);  // along; a compression of 0.25 gives 1
  EXPECT_NEAR(values[1] + values[2] + values[3], 0.0f, 2e-3f);
}

// The sheet follows one joint; a shape lifts its bottom by a tenth of its height, and another one
// moves the veil.
TEST(RigPatch, TakesTheShapesThatMoveItsSurface) {
  Character sheets = Sheets();
  sheets.shapes = {"veil", "shrink", "nothing"};
  for (Mesh& mesh : sheets.meshes) {
    MorphTarget& target = mesh.morph_targets.emplace_back();
    target.shape = &mesh == &sheets.meshes[0] ? 1 : 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      Vertex& vertex = mesh.vertices[i];
      vertex.joints[0] = 1;
      vertex.skin_weights[0] = 1.0f;
      vertex.skin_weights[1] = 0.0f;
      const float lift = 0.1f * (kSide - vertex.position.y);
      target.deltas.push_back({.vertex = static_cast<std::uint32_t>(i), .position = {0, lift, 0}});
    }
  }
  const auto driver = CutPatch(sheets, Middle());
  ASSERT_TRUE(driver.ok()) << driver.status().ToString();
  ASSERT_EQ(driver->strain.shapes.size(), 1u);
  EXPECT_EQ(driver->strain.shapes[0].blend_shape, "shrink");
  EXPECT_EQ(driver->strain.shapes[0].vertices.size(), driver->strain.vertices.size());
  EXPECT_EQ(driver->strain.joints, std::vector<std::string>{"low"});
  wrinkle::Rig rig;
  rig.drivers = {*driver};
  auto binding = wrinkle::RigBinding::Create(rig, sheets.skeleton, sheets.shapes);
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)));
  wrinkle::LocalPose pose;
  pose.SetRest(sheets.skeleton);
  pose.blend_shapes = {1.0f, 0.5f, 1.0f};
  ASSERT_EQ(solver.Update(pose, 0.0), wrinkle::JobStatus::kOk);
  EXPECT_NEAR(solver.driver_values()[0], 0.2f, 2e-3f);  // 5% of a full 25%
}

TEST(RigPatch, CutsOnlyTheNearestSurface) {
  const Character sheets = Sheets();
  const auto driver = CutPatch(sheets, Middle());
  ASSERT_TRUE(driver.ok());
  for (const auto& vertex : driver->strain.vertices) EXPECT_EQ(vertex.position.z, 0.0f);
  PatchOptions veil = Middle();
  veil.mesh = "veil";
  const auto other = CutPatch(sheets, veil);
  ASSERT_TRUE(other.ok());
  for (const auto& vertex : other->strain.vertices) EXPECT_NEAR(vertex.position.z, 0.001f, 1e-6f);
}

TEST(RigPatch, CoincidentSheetsStaySeparate) {
  Character sheets = Sheets();
  for (Vertex& vertex : sheets.meshes[1].vertices) vertex.position.z = 0.0f;
  const auto whole = CutPatch(sheets, Middle(1.0f));
  ASSERT_TRUE(whole.ok()) << whole.status().ToString();
  EXPECT_EQ(whole->strain.triangles.size(), 3u * 2 * kCells * kCells);
  // One mesh with two coincident halves that can move apart, like closed lips.
  Mesh lips = sheets.meshes[0];
  const auto half = static_cast<std::uint32_t>(lips.vertices.size());
  for (Vertex vertex : sheets.meshes[1].vertices) {
    std::swap(vertex.skin_weights[0], vertex.skin_weights[2]);
    vertex.joints[2] = 0;
    lips.vertices.push_back(vertex);
  }
  for (const std::uint32_t index : sheets.meshes[1].indices) lips.indices.push_back(half + index);
  sheets.meshes = {lips};
  // Gives the top rows different weights. Both followed `high` alone and would be joined.
  for (std::size_t i = half - kCells - 1; i < half; ++i) {
    sheets.meshes[0].vertices[i].skin_weights[1] = 0.9f;
    sheets.meshes[0].vertices[i].skin_weights[0] = 0.1f;
  }
  const auto lip = CutPatch(sheets, Middle(1.0f));
  ASSERT_TRUE(lip.ok()) << lip.status().ToString();
  EXPECT_EQ(lip->strain.triangles.size(), 3u * 2 * kCells * kCells);
  EXPECT_EQ(lip->strain.vertices.size(), 11u * 11);
}

TEST(RigPatch, CrossesUvSeams) {
  Character sheets = Sheets();
  Mesh& sheet = sheets.meshes[0];
  for (std::uint32_t& index : sheet.indices) {  // gives every corner its own vertex
    sheet.vertices.push_back(Vertex(sheet.vertices[index]));
    index = static_cast<std::uint32_t>(sheet.vertices.size()) - 1;
  }
  const auto whole = CutPatch(sheets, Middle(1.0f));
  ASSERT_TRUE(whole.ok()) << whole.status().ToString();
  EXPECT_EQ(whole->strain.vertices.size(), 11u * 11);
}

TEST(RigPatch, GrowsWithTheRadiusToTheWholeSheet) {
  const Character sheets = Sheets();
  const auto small = CutPatch(sheets, Middle(0.015f));
  const auto whole = CutPatch(sheets, Middle(1.0f));
  ASSERT_TRUE(small.ok() && whole.ok());
  EXPECT_GT(small->strain.triangles.size(), 3u * 3);
  EXPECT_LT(small->strain.triangles.size(), whole->strain.triangles.size());
  EXPECT_EQ(whole->strain.triangles.size(), 3u * 2 * kCells * kCells);
  EXPECT_EQ(whole->strain.vertices.size(), 11u * 11);
}

TEST(RigPatch, ExplainsWhyNoPatchWasCut) {
  Character sheets = Sheets();
  PatchOptions far = Middle();
  far.centre = {3, 0, 0};
  EXPECT_THAT(CutPatch(sheets, far).status().what(), HasSubstr("nearest is at 0.1000,0.0000"));
  const Status small = CutPatch(sheets, Middle(0.001f)).status();
  EXPECT_EQ(small.code(), StatusCode::kNotFound);
  EXPECT_THAT(small.what(), HasSubstr("within 1.0 mm; the nearest is 4.7 mm away"));
  PatchOptions nowhere = Middle();
  nowhere.mesh = "tail";
  EXPECT_EQ(CutPatch(sheets, nowhere).status().code(), StatusCode::kNotFound);
  for (Vertex& vertex : sheets.meshes[0].vertices) {
    vertex.skin_weights[0] = 1.0f;
    vertex.skin_weights[1] = 0.0f;
  }
  const Status rigid = CutPatch(sheets, Middle()).status();
  EXPECT_EQ(rigid.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(rigid.what(), HasSubstr("joint 'low' alone"));
}

TEST(RigPatch, FindsJointsAndRegions) {
  Character sheets = Sheets();
  EXPECT_EQ(*JointPosition(sheets, "high"), glm::vec3(0.0f, kSide, 0.0f));
  EXPECT_EQ(JointPosition(sheets, "tail").status().code(), StatusCode::kNotFound);
  // A mask that covers the left half. u increases with x.
  for (Mesh& mesh : sheets.meshes) {
    for (Vertex& vertex : mesh.vertices) vertex.uv = {0.99f * vertex.position.x / kSide, 0.5f};
  }
  Picture& mask = sheets.pictures.emplace_back();
  mask.name = "mask.png";
  mask.width = 2;
  mask.height = 1;
  mask.channels = 1;
  mask.pixels = {255, 0};
  sheets.rig_pictures = {{"mask.png", 0}};
  wrinkle::Region& region = sheets.rig.regions.emplace_back();
  region.name = "left";
  region.mask.texture = "mask.png";
  const auto place = RegionPosition(sheets, "left");
  ASSERT_TRUE(place.ok()) << place.status().ToString();
  EXPECT_NEAR(place->x, 0.025f, 0.006f);  // the vertex nearest to the centre
  EXPECT_NEAR(place->y, 0.05f, 1e-3f);
  EXPECT_EQ(RegionPosition(sheets, "right").status().code(), StatusCode::kNotFound);
  sheets.pictures[0].pixels = {0, 0};
  EXPECT_THAT(RegionPosition(sheets, "left").status().what(), HasSubstr("covers no vertex"));
}

}  // namespace
}  // namespace furrow::character
