// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/contained_jaw.h"

#include <algorithm>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/shapes/morph.h"
#include "tests/unit/authoring/shapes/shape_head.h"
#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::authoring {
namespace {

// The default head, whose mouthClose is ARKit's.
class ContainedJawTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { face_ = new character::Character(MakeShapeHead()); }
  static void TearDownTestSuite() { delete face_; }

  static int ShapeOf(const character::Character& face, const std::string& name) {
    return static_cast<int>(std::ranges::find(face.shapes, name) - face.shapes.begin());
  }

  // The same face as other tools make it: its mouthClose opens the jaw as well.
  static character::Character WithContainedJaw() {
    character::Character face = *face_;
    const int jaw = ShapeOf(face, "jawOpen"), close = ShapeOf(face, "mouthClose");
    for (character::Mesh& mesh : face.meshes) {
      std::vector<glm::vec3> sum(mesh.vertices.size(), glm::vec3(0.0f));
      for (const character::MorphTarget& target : mesh.morph_targets) {
        if (target.shape != jaw && target.shape != close) continue;
        for (const auto& delta : target.deltas) sum[delta.vertex] += delta.position;
      }
      // Lashes and teeth have no part in ARKit's mouthClose.
      character::MorphTarget both{.shape = close, .deltas = {}};
      for (std::uint32_t v = 0; v < sum.size(); ++v) {
        if (sum[v] != glm::vec3(0.0f)) both.deltas.push_back({v, sum[v]});
      }
      std::erase_if(mesh.morph_targets, [&](const auto& t) { return t.shape == close; });
      if (!both.deltas.empty()) mesh.morph_targets.push_back(both);
      std::ranges::sort(mesh.morph_targets, {}, &character::MorphTarget::shape);
    }
    return face;
  }

  static character::Character* face_;
};
character::Character* ContainedJawTest::face_ = nullptr;

TEST_F(ContainedJawTest, TheChinTells) {
  const rig::ShapeMatcher matcher = rig::ShippedShapeMatcher();
  character::Character own = *face_;
  EXPECT_FALSE(NoteContainedJaw(matcher, &own));
  EXPECT_TRUE(own.shape_rules.empty());
  character::Character other = WithContainedJaw();
  other.shape_rules = {{.shape = 3, .is_binary = true}};
  const int jaw = ShapeOf(other, "jawOpen"), close = ShapeOf(other, "mouthClose");
  other.shapes[static_cast<std::size_t>(close)] = "Mouth_Ape_Shape";
  other.shapes[static_cast<std::size_t>(jaw)] = "jaw_open";
  EXPECT_TRUE(NoteContainedJaw(matcher, &other));
  ASSERT_EQ(other.shape_rules.size(), 2u);
  EXPECT_EQ(other.shape_rules[1].shape, static_cast<std::uint32_t>(close));
  EXPECT_EQ(other.shape_rules[1].contains, static_cast<std::uint32_t>(jaw));
  EXPECT_TRUE(NoteContainedJaw(matcher, &other));
  EXPECT_EQ(other.shape_rules.size(), 2u) << "noted once";
}

TEST_F(ContainedJawTest, FacesWithoutTheShapesHaveNone) {
  character::Character face = *face_;
  face.shapes[static_cast<std::size_t>(ShapeOf(face, "mouthClose"))] = "other";
  EXPECT_FALSE(NoteContainedJaw(rig::ShippedShapeMatcher(), &face));
  EXPECT_FALSE(NoteContainedJaw({}, &face));
}

// A stream with ARKit's coefficients moves both faces alike.
TEST_F(ContainedJawTest, BothKindsOfFaceMoveAlike) {
  const rig::ShapeMatcher matcher = rig::ShippedShapeMatcher();
  character::Character other = WithContainedJaw();
  ASSERT_TRUE(NoteContainedJaw(matcher, &other));
  const std::vector<std::string> names = rig::ArkitNamesForTests();
  std::vector<float> sent(names.size(), 0.0f);
  sent[static_cast<std::size_t>(rig::FindArkitShape("jawOpen"))] = 0.9f;
  sent[static_cast<std::size_t>(rig::FindArkitShape("mouthClose"))] = 0.6f;
  const auto weights = [&](const character::Character& face) {
    std::vector<float> result(face.shapes.size());
    const auto program = rig::MatchShapes(matcher, names, face.shapes, face.shape_rules);
    EXPECT_EQ(program.Run(sent, result), wrinkle::JobStatus::kOk);
    return result;
  };
  for (std::size_t m = 0; m < other.meshes.size(); ++m) {
    const auto want = MorphedPositions(face_->meshes[m], weights(*face_));
    const auto found = MorphedPositions(other.meshes[m], weights(other));
    for (std::size_t v = 0; v < want.size(); ++v) {
      ASSERT_LT(glm::distance(want[v], found[v]), 1e-5f) << other.meshes[m].name << ' ' << v;
    }
  }
}

}  // namespace
}  // namespace furrow::authoring
