// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/stroke_transfer.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/bake/strokes_file.h"
#include "authoring/bake/surface/triangle_tree.h"
#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "authoring/generator/default_character.h"
#include "rig/rig_file.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

wrinkle::Rig ArkitRig() {
  auto rig = rig::LoadRig(fs::path(FURROW_SOURCE_DIR) / "rig/rigs/arkit.json");
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  return rig.ok() ? std::move(*rig) : wrinkle::Rig();
}

class StrokeTransferTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const fs::path rigs = fs::path(FURROW_SOURCE_DIR) / "rig/rigs";
    auto rig = rig::LoadRig(rigs / "default.json");
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    face_ = new character::Character(MakeDefaultCharacter(*rig, {.texture_size = 64}));
    ASSERT_TRUE(MakeBlendShapeFace(face_).ok());
    auto strokes = LoadStrokes(rigs / "default.strokes.json", *rig);
    ASSERT_TRUE(strokes.ok()) << strokes.status().ToString();
    strokes_ = new std::vector<BakeStroke>(std::move(*strokes));
  }
  static void TearDownTestSuite() {
    delete strokes_;
    delete face_;
  }
  static character::Character* face_;
  static std::vector<BakeStroke>* strokes_;
};
character::Character* StrokeTransferTest::face_ = nullptr;
std::vector<BakeStroke>* StrokeTransferTest::strokes_ = nullptr;

FaceMeasures MeasuresOf(const FaceSkin& skin) {
  return MeasureFace(skin, FindShapeLandmarks(skin));
}

float DistanceToSkin(const FaceSkin& skin, const glm::vec3& point) {
  float nearest = 1e30f;
  for (const auto& [a, b, c] : skin.Triangles()) {
    const auto at = skin.positions();
    nearest =
        std::min(nearest, glm::distance(point, NearestInTriangle(point, at[a], at[b], at[c])));
  }
  return nearest;
}

TEST_F(StrokeTransferTest, TheDefaultFaceIsMeasuredAsItIs) {
  const ArkitFace arkit(*face_, rig::ShapeMatcher());
  const auto skin = FaceSkin::Create(*face_, arkit);
  ASSERT_TRUE(skin.ok()) << skin.status().ToString();
  const FaceMeasures is = MeasuresOf(*skin), said = DefaultFaceMeasures();
  constexpr float kMillimetre = 0.001f;
  EXPECT_NEAR(is.middle, said.middle, kMillimetre);
  EXPECT_NEAR(is.eye_distance, said.eye_distance, kMillimetre);
  EXPECT_NEAR(is.eye_depth, said.eye_depth, kMillimetre);
  EXPECT_NEAR(is.brow, said.brow, kMillimetre);
  EXPECT_NEAR(is.lid, said.lid, kMillimetre);
  EXPECT_NEAR(is.wing, said.wing, kMillimetre);
  EXPECT_NEAR(is.corner, said.corner, kMillimetre);
  EXPECT_NEAR(is.chin, said.chin, kMillimetre);
  EXPECT_NEAR(is.corner_x, said.corner_x, kMillimetre);
  EXPECT_NEAR(is.corner_z, said.corner_z, kMillimetre);
}

// The default face is its own counterpart: strokes stay where they are drawn, on the skin.
TEST_F(StrokeTransferTest, KeepsStrokesOnTheirOwnFace) {
  const ArkitFace arkit(*face_, rig::ShapeMatcher());
  const auto skin = FaceSkin::Create(*face_, arkit);
  ASSERT_TRUE(skin.ok()) << skin.status().ToString();
  const TransferredStrokes moved =
      TransferStrokes(*strokes_, DefaultFaceMeasures(), MeasuresOf(*skin), *skin, ArkitRig());
  EXPECT_EQ(moved.lost, 0u);
  EXPECT_GT(moved.strokes.size(), 90u);
  for (const BakeStroke& stroke : moved.strokes) {
    const auto drawn = std::find_if(strokes_->begin(), strokes_->end(),
                                    [&](const auto& s) { return s.name == stroke.name; });
    ASSERT_NE(drawn, strokes_->end());
    ASSERT_EQ(stroke.points.size(), drawn->points.size()) << stroke.name;
    EXPECT_NEAR(stroke.width_mm, drawn->width_mm, 0.02f * drawn->width_mm);
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
      EXPECT_LT(DistanceToSkin(*skin, stroke.points[i]), 1e-4f) << stroke.name;
      // Drawn points lie near the skin, not on it.
      const float off = DistanceToSkin(*skin, drawn->points[i]);
      EXPECT_LT(glm::distance(stroke.points[i], drawn->points[i]), 0.004f + 2.0f * off)
          << stroke.name;
    }
  }
}

// A face half as large again, elsewhere: strokes grow and move with it.
TEST_F(StrokeTransferTest, FollowsSizeAndPlace) {
  character::Character giant = *face_;
  const glm::vec3 shift(0.2f, -0.4f, 0.1f);
  for (character::Mesh& mesh : giant.meshes) {
    for (character::Vertex& vertex : mesh.vertices) {
      vertex.position = 1.5f * vertex.position + shift;
    }
    for (character::MorphTarget& target : mesh.morph_targets) {
      for (character::MorphDelta& delta : target.deltas) delta.position *= 1.5f;
    }
  }
  const ArkitFace small_face(*face_, rig::ShapeMatcher()), large_face(giant, rig::ShapeMatcher());
  const auto small = FaceSkin::Create(*face_, small_face);
  const auto large = FaceSkin::Create(giant, large_face);
  ASSERT_TRUE(small.ok() && large.ok());
  const FaceMeasures from = MeasuresOf(*small);
  const auto before = TransferStrokes(*strokes_, from, from, *small, ArkitRig());
  const auto after = TransferStrokes(*strokes_, from, MeasuresOf(*large), *large, ArkitRig());
  ASSERT_EQ(before.strokes.size(), after.strokes.size());
  for (std::size_t s = 0; s < before.strokes.size(); ++s) {
    const BakeStroke& one = before.strokes[s];
    const BakeStroke& other = after.strokes[s];
    EXPECT_NEAR(other.width_mm, 1.5f * one.width_mm, 0.01f) << one.name;
    EXPECT_NEAR(other.depth_mm, 1.5f * one.depth_mm, 0.01f) << one.name;
    ASSERT_EQ(one.points.size(), other.points.size()) << one.name;
    for (std::size_t i = 0; i < one.points.size(); ++i) {
      EXPECT_LT(glm::distance(other.points[i], 1.5f * one.points[i] + shift), 0.002f) << one.name;
    }
  }
}

TEST_F(StrokeTransferTest, LeavesOutWhatTheRigLacks) {
  const ArkitFace arkit(*face_, rig::ShapeMatcher());
  const auto skin = FaceSkin::Create(*face_, arkit);
  ASSERT_TRUE(skin.ok()) << skin.status().ToString();
  const FaceMeasures measures = MeasuresOf(*skin);
  BakeStroke stroke{.name = "a", .maps = {"squash", "folds"}};
  stroke.points = {{-0.01f, measures.lid, 0.11f}, {0.01f, measures.lid, 0.11f}};
  BakeStroke cloth = stroke, elsewhere = stroke, neck = stroke, far = stroke, dimple = stroke;
  dimple.personal = true;
  cloth.maps = {"folds"};
  elsewhere.region = "knee_l_inner";
  for (glm::vec3& p : neck.points) p.y = measures.chin - 0.1f;
  for (glm::vec3& p : far.points) p.y = measures.brow + 1.0f;
  const std::vector<BakeStroke> strokes = {stroke, cloth, elsewhere, neck, far, dimple};
  const auto moved = TransferStrokes(strokes, measures, measures, *skin, ArkitRig());
  ASSERT_EQ(moved.strokes.size(), 1u);
  EXPECT_EQ(moved.strokes[0].maps, std::vector<std::string>{"squash"});
  EXPECT_EQ(moved.lost, 1u);  // no skin a metre above the brows
}

}  // namespace
}  // namespace furrow::authoring
