// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/surface_check.h"
#include "character/mesh/weld.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// A sheet whose shape "squeeze" at 1 shortens it along x by 30 %.
character::Character Squeezable() {
  character::Mesh sheet = toys::Sheet(0.1f, 0.1f, 10, 10);
  character::MorphTarget target;
  for (std::uint32_t v = 0; v < sheet.vertices.size(); ++v) {
    const float x = sheet.vertices[v].position.x;
    if (x != 0.0f) target.deltas.push_back({.vertex = v, .position = {-0.3f * x, 0.0f, 0.0f}});
  }
  sheet.morph_targets.push_back(std::move(target));
  character::Character character = toys::Wearing(std::move(sheet));
  character.shapes = {"squeeze"};
  return character;
}

BakePose Shaped(float weight) {
  BakePose pose = toys::Pose(glm::mat4(1.0f));
  pose.shape_weights = {weight};
  return pose;
}

// A shape and a joint that move the surface alike fold it alike.
TEST(ShapeBake, EqualsTheBakeOfAnEqualMotionOfJoints) {
  const character::Character character = Squeezable();
  const BakedMap shaped = toys::BakeFolds(character, {Shaped(1.0f)}, toys::Exact());
  const BakedMap jointed =
      toys::BakeFolds(character, {toys::Pose(toys::Squeeze(0.3f, 0.0f))}, toys::Exact());
  ASSERT_EQ(shaped.height_mm.size(), jointed.height_mm.size());
  float highest = 0.0f;
  for (std::size_t i = 0; i < shaped.height_mm.size(); ++i) {
    ASSERT_NEAR(shaped.height_mm[i], jointed.height_mm[i], 1e-3f) << i;
    highest = std::max(highest, shaped.height_mm[i]);
  }
  EXPECT_GT(highest, 0.5f);
}

TEST(ShapeBake, StrainIsThatOfTheWeightedShape) {
  const character::Character character = Squeezable();
  BakeOptions options = toys::Exact();
  options.skin.smoothing_mm = 0.0f;
  BakeProgress progress({});
  const auto surface = BakeSurface::Create(character, false, options, &progress);
  ASSERT_TRUE(surface.ok()) << surface.status().ToString();
  for (const float weight : {0.0f, 0.5f, 1.0f}) {
    const BakePose pose = Shaped(weight);
    const auto field = (*surface)->solver().Solve(pose.skin_matrices, pose.shape_weights, 0.9f);
    for (const Tensor2& tensor : field.tensors) {
      EXPECT_NEAR(PrincipalOf(tensor).large, 0.3f * weight, 1e-5f);
      EXPECT_NEAR(PrincipalOf(tensor).small, 0.0f, 1e-5f);
    }
  }
}

TEST(ShapeBake, RejectsBadShapeWeights) {
  const character::Character character = Squeezable();
  BakePose pose = Shaped(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(Bake(character, std::span(&pose, 1), {}, toys::Exact()).status().code(),
            StatusCode::kNonFinite);
  pose.shape_weights = {1.0f, 0.0f};
  const Status status = Bake(character, std::span(&pose, 1), {}, toys::Exact()).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.what(), HasSubstr("more shape weights (2) than shapes (1)"));
}

TEST(ShapeBake, PosesTheShapesThatDriversName) {
  character::Character character = Squeezable();
  character.shapes = {"PressLeft"};
  wrinkle::Rig& rig = character.rig;
  rig.drivers.resize(2);
  for (wrinkle::Driver& driver : rig.drivers) driver.kind = wrinkle::Driver::Kind::kBlendShape;
  rig.drivers[0].name = "press";
  rig.drivers[0].blend_shape = {.blend_shape = "pressLeft", .full = 0.8f};
  rig.drivers[1].name = "other";
  rig.drivers[1].blend_shape.blend_shape = "pressRight";
  rig.regions[0].feeds = {{"folds", {{"press", "value", 0.8f}, {"other", "value", 1.0f}}}};
  const auto found = CollectBakePoses(character);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 1u);
  EXPECT_EQ(found->poses[0].shape_weights, std::vector<float>{0.8f});
  EXPECT_EQ(found->poses[0].weight, 0.8f);
  EXPECT_EQ(found->poses[0].skin_matrices.size(), 2u);
  ASSERT_EQ(found->notes.size(), 1u);
  EXPECT_THAT(found->notes[0], HasSubstr("no shape of the character means pressRight;"));
}

// A reference pose of one joint and of blend shapes, which a pose driver reads.
character::Character Expressive(std::vector<wrinkle::ShapeValue> shapes) {
  character::Character character = Squeezable();
  character.shapes = {"pressLeft"};
  wrinkle::Rig& rig = character.rig;
  rig.reference_poses = {{.name = "press", .shapes = std::move(shapes)}};
  rig.drivers.resize(1);
  rig.drivers[0].name = "face";
  for (const wrinkle::ShapeValue& shape : rig.reference_poses[0].shapes) {
    rig.drivers[0].pose.points.push_back({.joint = "",
                                          .kind = wrinkle::ControlPoint::Kind::kBlendShape,
                                          .blend_shape = shape.blend_shape});
  }
  rig.drivers[0].pose.values = {{"press", "press"}};
  rig.regions[0].feeds = {{"folds", {{"face", "press", 1.0f}}}};
  return character;
}

TEST(ShapeBake, PosesTheShapesOfReferencePoses) {
  const auto found = CollectBakePoses(Expressive({{"PRESSLEFT", 0.75f}, {"tongueOut", 1.0f}}));
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 1u);
  EXPECT_EQ(found->poses[0].shape_weights, std::vector<float>{0.75f});
  EXPECT_THAT(found->notes,
              testing::ElementsAre(HasSubstr("move nothing on this character: tongueOut")));
}

// As in the daemon, a reference pose with the name of a blend shape moves joints.
TEST(ShapeBake, PosesJointsWhereTheCharacterHasNoSuchShape) {
  character::Character character = Expressive({{"tongueOut", 0.5f}});
  const std::string joint = character.skeleton.joint_names()[1];
  character.rig.reference_poses.push_back(
      {.name = "tongueOut",
       .joints = {{.joint = joint, .rotation = {1, 0, 0, 0}, .translation = {0, 0, 0.02f}}}});
  const auto found = CollectBakePoses(character);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 1u);
  EXPECT_TRUE(found->poses[0].shape_weights.empty());
  EXPECT_NEAR(found->poses[0].skin_matrices[1][3].z, 0.01f, 1e-6f);
  EXPECT_TRUE(found->notes.empty());
}

TEST(ShapeBake, NotesAPoseOfShapesThatTheCharacterLacks) {
  const auto found = CollectBakePoses(Expressive({{"tongueOut", 1.0f}}));
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  EXPECT_TRUE(found->poses.empty());
  EXPECT_THAT(found->notes, Contains(HasSubstr("face.press has no pose on this character")));
}

// Closed lips share their positions and joints. Only a shape parts them.
TEST(ShapeBake, LipsThatAShapePartsAreNotWelded) {
  character::Mesh lips = toys::Sheet(0.1f, 0.05f, 2, 2);
  const std::size_t lower = lips.vertices.size();
  toys::Append(character::Mesh(lips), &lips);
  std::vector<std::uint32_t> welded = character::WeldVertices(lips);
  EXPECT_EQ(welded[lower], welded[0]);
  character::MorphTarget open;
  for (std::uint32_t v = 0; v < lower; ++v) {
    open.deltas.push_back(
        {.vertex = static_cast<std::uint32_t>(lower + v), .position = {0.0f, -0.02f, 0.0f}});
  }
  lips.morph_targets.push_back(open);
  welded = character::WeldVertices(lips);
  for (std::size_t v = 0; v < lower; ++v) EXPECT_NE(welded[lower + v], welded[v]);
  // A seam, which the shape moves alike on both sides, stays one vertex.
  for (std::uint32_t v = 0; v < lower; ++v) {
    lips.morph_targets[0].deltas.insert(lips.morph_targets[0].deltas.begin() + v,
                                        {.vertex = v, .position = {0.0f, -0.02f, 0.0f}});
  }
  welded = character::WeldVertices(lips);
  for (std::size_t v = 0; v < lower; ++v) EXPECT_EQ(welded[lower + v], welded[v]);
}

// The half at the larger x owns shared texels, whatever the order of the triangles.
TEST(ShapeBake, MirroredHalvesTakeTheTexelsOfOneHalf) {
  character::Mesh sheet = toys::Sheet(0.2f, 0.1f, 20, 10);
  for (character::Vertex& vertex : sheet.vertices) {
    vertex.position.x -= 0.1f;
    vertex.uv.x = 10.0f * std::abs(vertex.position.x);
  }
  const character::Character character = toys::Wearing(std::move(sheet));
  BakeProgress progress({});
  const auto surface = BakeSurface::Create(character, false, toys::Exact(), &progress);
  ASSERT_TRUE(surface.ok()) << surface.status().ToString();
  EXPECT_GT((*surface)->overlaps(), 0);
  for (const SurfaceTexel& texel : (*surface)->texels()) {
    ASSERT_GE(texel.position.x, 0.0f);
    ASSERT_GE((*surface)->surface().Corners(texel.triangle)[0].x, -1e-6f);
  }
  std::vector<std::string> warnings;
  EXPECT_TRUE(CheckSurfaces(character, {}, &warnings).ok());
  EXPECT_THAT(warnings, Contains(HasSubstr("UVs overlap on")));
}

}  // namespace
}  // namespace furrow::authoring
