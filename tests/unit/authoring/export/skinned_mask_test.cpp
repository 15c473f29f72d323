// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/skinned_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/export/export_pictures.h"
#include "tests/unit/authoring/export/small_face.h"

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;

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

TEST(SkinnedMask, FollowsTheSkinWeightsOfTheDriversJoints) {
  const character::Character face = Dressed();
  const auto picture = SkinnedMaskPicture(face, face.rig.regions[3], 16);
  ASSERT_EQ(picture.pixels.size(), 256u);
  for (int x = 0; x < 8; ++x) {
    // The weight rises from 0 to 1 over 8 texels; centres lie at halves.
    EXPECT_NEAR(picture.pixels[static_cast<std::size_t>(16 * 5 + x)], 255.0 * (x + 0.5) / 8.0, 1.0);
  }
  EXPECT_EQ(picture.pixels[16 * 5 + 8], 255);  // beyond the edge, for filtering
  EXPECT_EQ(picture.pixels[16 * 5 + 12], 0);
}

TEST(SkinnedMask, OtherMaterialsLeaveNoTrace) {
  character::Character face = Dressed();
  face.meshes[0].material = 0;  // the map is for cloth
  const auto picture = SkinnedMaskPicture(face, face.rig.regions[3], 16);
  EXPECT_THAT(picture.pixels, ::testing::Each(0));
}

TEST(SkinnedMask, ThePlanPlacesItAndThePictureHoldsIt) {
  const character::Character face = Dressed();
  EXPECT_THAT(MaskJoints(face, face.rig.regions[3]),
              ::testing::Contains(face.skeleton.Find("lower")));
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok()) << plan.status().ToString();
  EXPECT_TRUE(plan->notes.empty());
  ASSERT_EQ(plan->masks.size(), 2u);
  EXPECT_THAT(plan->masks[1].regions, ElementsAre(2, 3, -1, -1));
  EXPECT_EQ(plan->masks[1].width, kSkinnedMaskSide);
  const auto picture = MaskPicture(face, plan->masks[1]);
  const std::size_t middle = 4 * (512 * kSkinnedMaskSide + 256);
  EXPECT_NEAR(picture.pixels[middle + 1], 128, 1);
}

TEST(SkinnedMask, OverlappingUvsAreLeftOut) {
  character::Character face = Dressed();
  character::Mesh& mesh = face.meshes[0];
  for (int i = 0; i < 5000; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  EXPECT_THAT(SkinnedMaskPicture(face, face.rig.regions[3], 16).pixels, ::testing::Each(0));
}

}  // namespace
}  // namespace furrow::authoring
