// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/painted_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/export/export_pictures.h"
#include "authoring/export/shader_files.h"
#include "tests/unit/authoring/export/small_face.h"
#include "wrinkle/weights/sliding_mask.h"

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The small face with joints and a shirt: a square that fills the left half of the texture. Its
// left edge belongs to `upper` and its right edge to `lower`, which the elbow moves.
character::Character Dressed() {
  character::Character face = test::SmallFace();
  auto skeleton =
      wrinkle::Skeleton::Create({{.name = "root", .parent = -1, .rest = {}, .tail = {}},
                                 {.name = "upper", .parent = 0, .rest = {}, .tail = {}},
                                 {.name = "lower", .parent = 1, .rest = {}, .tail = {}}});
  EXPECT_TRUE(skeleton.ok()) << skeleton.status().ToString();
  face.skeleton = *skeleton;
  wrinkle::Driver elbow;
  elbow.name = "elbow";
  elbow.kind = wrinkle::Driver::Kind::kHinge;
  elbow.hinge.parent = "upper";
  elbow.hinge.joint = "lower";
  face.rig.drivers = {elbow};
  face.rig.regions[3].mask.lambda = wrinkle::LambdaMode::kLinear;
  character::Mesh mesh;
  mesh.material = 1;
  for (const auto& [u, v] : {std::pair(0.0f, 0.0f), {0.5f, 0.0f}, {0.5f, 1.0f}, {0.0f, 1.0f}}) {
    character::Vertex vertex;
    vertex.uv = {u, v};
    vertex.joints[0] = static_cast<std::uint16_t>(face.skeleton.Find("root"));
    vertex.joints[1] = static_cast<std::uint16_t>(face.skeleton.Find("lower"));
    vertex.skin_weights[0] = 1.0f - 2.0f * u;
    vertex.skin_weights[1] = 2.0f * u;
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  face.meshes = {mesh};
  return face;
}

TEST(PaintedMask, FollowsTheSkinWeightsOfTheDriversJoints) {
  const character::Character face = Dressed();
  const auto picture = PaintMask(face, face.rig.regions[3], 16).picture;
  ASSERT_EQ(picture.pixels.size(), 256u);
  for (int x = 0; x < 8; ++x) {
    // The weight rises from 0 to 1 over 8 texels; centres lie at halves.
    EXPECT_NEAR(picture.pixels[static_cast<std::size_t>(16 * 5 + x)], 255.0 * (x + 0.5) / 8.0, 1.0);
  }
  EXPECT_EQ(picture.pixels[16 * 5 + 8], 255);  // beyond the edge, for filtering
  EXPECT_EQ(picture.pixels[16 * 5 + 12], 0);
}

TEST(PaintedMask, OtherMaterialsLeaveNoTrace) {
  character::Character face = Dressed();
  face.meshes[0].material = 0;  // the map is for cloth
  const auto picture = PaintMask(face, face.rig.regions[3], 16).picture;
  EXPECT_THAT(picture.pixels, ::testing::Each(0));
}

TEST(PaintedMask, ThePlanPlacesItAndThePictureHoldsIt) {
  const character::Character face = Dressed();
  EXPECT_THAT(MaskJoints(face, face.rig.regions[3]),
              ::testing::Contains(face.skeleton.Find("lower")));
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok()) << plan.status().ToString();
  EXPECT_TRUE(plan->notes.empty());
  ASSERT_EQ(plan->masks.size(), 2u);
  EXPECT_THAT(plan->masks[1].regions, ElementsAre(2, 3, -1, -1));
  EXPECT_EQ(plan->masks[1].width, kPaintedMaskSide);
  std::vector<std::string> shared;
  const auto picture = MaskPicture(face, plan->masks[1], &shared);
  const std::size_t middle = 4 * (512 * kPaintedMaskSide + 256);
  EXPECT_NEAR(picture.pixels[middle + 1], 128, 1);
}

TEST(PaintedMask, PartsThatShareTexelsTakeTheLargest) {
  character::Character face = Dressed();
  EXPECT_FALSE(PaintMask(face, face.rig.regions[3], 16).is_shared);
  // A second square in the same place that the elbow does not move; in both orders.
  character::Mesh still = face.meshes[0];
  for (character::Vertex& vertex : still.vertices) vertex.skin_weights[1] = 0.0f;
  for (const bool first : {true, false}) {
    face.meshes.insert(first ? face.meshes.begin() : face.meshes.end(), still);
    const PaintedMask mask = PaintMask(face, face.rig.regions[3], 16);
    EXPECT_TRUE(mask.is_shared);
    EXPECT_NEAR(mask.picture.pixels[16 * 5 + 4], 255.0 * 4.5 / 8.0, 1.0);
    face.meshes.erase(first ? face.meshes.begin() : face.meshes.end() - 1);
  }
  std::vector<std::string> shared;
  face.meshes.push_back(still);
  (void)MaskPicture(face, {{2, 3, -1, -1}, 4, 4}, &shared);
  EXPECT_THAT(shared, ElementsAre("arm"));
}

TEST(PaintedMask, RegionsOfTheSameJointsShareAChannel) {
  character::Character face = Dressed();
  wrinkle::Region outer = face.rig.regions[3];
  outer.name = "outer";
  face.rig.regions.push_back(outer);
  outer.name = "linear";
  outer.mask.lambda = wrinkle::LambdaMode::kBinary;  // another mask
  face.rig.regions.push_back(outer);
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok()) << plan.status().ToString();
  EXPECT_THAT(plan->masks[1].regions, ElementsAre(2, 3, 5, -1));
  EXPECT_EQ(RegionsOf(face.rig, *plan, 1, 1), "arm outer");
  EXPECT_EQ(plan->weights[6].channel, plan->weights[5].channel);
  EXPECT_TRUE(plan->weights[6].is_skinned);
  EXPECT_FALSE(plan->weights[4].is_skinned);
  // The largest counts, and the sum is at most 1.
  const TemplateData data = ShaderData(face, *plan, Engine::kGeneric, {});
  const auto files = ShaderFiles(Engine::kGeneric, data);
  ASSERT_TRUE(files.ok()) << files.status().ToString();
  const std::string& glsl = files->back().text;
  EXPECT_THAT(glsl, HasSubstr("c += dot(mask1, vec4(furrowWeights[4], 0.0, 0.0, 0.0));"));
  EXPECT_THAT(glsl, HasSubstr("s += dot(mask1, vec4(0.0, max(furrowWeights[5], furrowWeights[6]), "
                              "furrowWeights[7], 0.0));\n    c += min(s, 1.0);"));
}

TEST(PaintedMask, OverlappingUvsAreLeftOut) {
  character::Character face = Dressed();
  character::Mesh& mesh = face.meshes[0];
  for (int i = 0; i < 5000; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  EXPECT_THAT(PaintMask(face, face.rig.regions[3], 16).picture.pixels, ::testing::Each(0));
}

// The dressed face with bones along -y and an elbow that flexes forwards. The arm's mask slides;
// the vertices lie in front of the elbow and behind it.
character::Character Sliding(const std::vector<std::string>& values) {
  character::Character face = Dressed();
  const glm::vec3 down(0.0f, -1.0f, 0.0f);
  wrinkle::Transform below;
  below.translation = down;
  auto skeleton =
      wrinkle::Skeleton::Create({{.name = "upper", .parent = -1, .rest = {}, .tail = down},
                                 {.name = "lower", .parent = 0, .rest = below, .tail = down}});
  EXPECT_TRUE(skeleton.ok()) << skeleton.status().ToString();
  face.skeleton = *skeleton;
  wrinkle::Driver& elbow = face.rig.drivers[0];
  elbow.hinge.axis = glm::vec3(-1.0f, 0.0f, 0.0f);
  wrinkle::Region& arm = face.rig.regions[3];
  arm.mask.kind = wrinkle::Mask::Kind::kSliding;
  arm.mask.driver = "elbow";
  arm.feeds[0].sources.clear();
  for (const std::string& value : values) arm.feeds[0].sources.push_back({"elbow", value, 1.0f});
  for (character::Vertex& vertex : face.meshes[0].vertices) {
    vertex.joints[0] = vertex.joints[1] = 0;
    vertex.position = {0.0f, -1.1f, vertex.uv.x > 0.0f ? 0.1f : -0.1f};
  }
  return face;
}

TEST(PaintedMask, ASlidingMaskThatStaysBecomesAPicture) {
  for (const auto& [value, left, right] :
       {std::tuple("flexed", false, true), std::tuple("extended", true, false)}) {
    const character::Character face = Sliding({value});
    const wrinkle::Region& arm = face.rig.regions[3];
    ASSERT_TRUE(CanPaintMask(face, arm)) << value;
    // The renderer's mask at the vertices on both sides.
    const auto frame = wrinkle::RestSlidingFrame(face.rig.drivers[0], arm.feeds[0], face.skeleton);
    ASSERT_TRUE(frame.has_value());
    const std::vector<float> moved(8, 1.0f);
    const glm::vec3 towards = wrinkle::BendDirection(*frame, moved);
    const auto picture = PaintMask(face, arm, 16).picture;
    for (int x = 0; x < 8; ++x) {
      const float at_left =
          wrinkle::SlidingMaskAt(*frame, arm.mask, towards, face.meshes[0].vertices[0].position);
      const float at_right =
          wrinkle::SlidingMaskAt(*frame, arm.mask, towards, face.meshes[0].vertices[1].position);
      EXPECT_EQ(at_left > 0.5f, left) << value;
      EXPECT_EQ(at_right > 0.5f, right) << value;
      const float share = (static_cast<float>(x) + 0.5f) / 8.0f;
      EXPECT_NEAR(picture.pixels[static_cast<std::size_t>(16 * 5 + x)],
                  255.0f * (at_left + share * (at_right - at_left)), 1.0f)
          << value << " " << x;
    }
    const auto plan = PlanExport(face);
    ASSERT_TRUE(plan.ok());
    EXPECT_TRUE(plan->notes.empty());
    EXPECT_TRUE(plan->weights.back().is_drawn());
    EXPECT_TRUE(plan->weights.back().is_skinned);
  }
}

TEST(PaintedMask, ASlidingMaskThatMovesIsNoted) {
  // Both sides of the elbow raise the weight, but the mask lies on one.
  const character::Character face = Sliding({"flexed", "extended"});
  EXPECT_FALSE(CanPaintMask(face, face.rig.regions[3]));
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok());
  EXPECT_THAT(plan->notes, ElementsAre(HasSubstr("cannot become a picture: arm")));
  // Another driver may raise it while the elbow rests.
  character::Character other = Sliding({"flexed"});
  other.rig.regions[3].feeds[0].sources.push_back({"brow", "value", 1.0f});
  EXPECT_FALSE(CanPaintMask(other, other.rig.regions[3]));
  // A ball swings in all directions.
  character::Character ball = Sliding({"front"});
  ball.rig.drivers[0].kind = wrinkle::Driver::Kind::kBall;
  ball.rig.drivers[0].ball.parent = "upper";
  ball.rig.drivers[0].ball.joint = "lower";
  EXPECT_FALSE(CanPaintMask(ball, ball.rig.regions[3]));
}

}  // namespace
}  // namespace furrow::authoring
