// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/export_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/authoring/export/small_face.h"

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ExportPlan, ListsAllWeightsInTheOrderOfTheStream) {
  const auto plan = PlanExport(test::SmallFace());
  ASSERT_TRUE(plan.ok()) << plan.status().ToString();
  std::vector<std::string> names;
  for (const ExportPlan::Weight& weight : plan->weights) names.push_back(weight.name);
  EXPECT_THAT(names, ElementsAre("brow_l.stretch", "brow_l.squash", "brow_r.stretch",
                                 "brow_r.squash", "knee.folds", "arm.folds"));
  EXPECT_TRUE(plan->weights[3].is_drawn());
  EXPECT_EQ(plan->weights[3].map, 1);
  EXPECT_EQ(plan->weights[3].mask, 0);
  EXPECT_EQ(plan->weights[3].channel, 1);
}

TEST(ExportPlan, SkinAndClothHavePicturesOfTheirOwn) {
  const auto plan = PlanExport(test::SmallFace());
  ASSERT_TRUE(plan.ok());
  ASSERT_EQ(plan->masks.size(), 2u);
  EXPECT_THAT(plan->masks[0].regions, ElementsAre(0, 1, -1, -1));
  EXPECT_EQ(plan->masks[0].width, 4);
  EXPECT_THAT(plan->masks[1].regions, ElementsAre(2, -1, -1, -1));
  EXPECT_EQ(plan->masks[1].width, 2);
}

TEST(ExportPlan, MaterialsUseOnlyWhatIsDrawnOnThem) {
  const auto plan = PlanExport(test::SmallFace());
  ASSERT_TRUE(plan.ok());
  ASSERT_EQ(plan->materials.size(), 2u);  // without the hair
  EXPECT_EQ(plan->materials[0].name, "skin");
  EXPECT_THAT(plan->materials[0].maps, ElementsAre(0, 1));
  EXPECT_THAT(plan->materials[0].masks, ElementsAre(0));
  EXPECT_THAT(plan->materials[0].weights, ElementsAre(0, 1, 2, 3));
  EXPECT_TRUE(plan->materials[1].cloth);
  EXPECT_THAT(plan->materials[1].weights, ElementsAre(4));
}

TEST(ExportPlan, MasksWithoutAPictureAreNoted) {
  const auto plan = PlanExport(test::SmallFace());
  ASSERT_TRUE(plan.ok());
  EXPECT_FALSE(plan->weights[5].is_drawn());
  EXPECT_THAT(plan->notes,
              ElementsAre(HasSubstr("1 region whose mask cannot become a picture: arm")));
}

TEST(ExportPlan, FiveRegionsNeedASecondPicture) {
  character::Character face = test::SmallFace();
  for (int i = 0; i < 3; ++i) {
    wrinkle::Region region = face.rig.regions[0];
    region.name = "extra_" + std::to_string(i);
    face.rig.regions.push_back(region);
  }
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok());
  ASSERT_EQ(plan->masks.size(), 3u);
  EXPECT_THAT(plan->masks[0].regions, ElementsAre(0, 1, 4, 5));
  EXPECT_THAT(plan->masks[1].regions, ElementsAre(6, -1, -1, -1));
}

TEST(ExportPlan, NamesOfFilesAreUniqueAndSafe) {
  character::Character face = test::SmallFace();
  face.materials[0].name = "../x";
  face.materials[1].kind = character::Material::Kind::kSkin;
  face.materials[1].name = "..-x";
  face.rig.wrinkle_maps[0].name = face.rig.regions[0].feeds[0].map = "material_skin";
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->maps[0].name, "map_material_skin");
  EXPECT_EQ(plan->materials[0].name, "___x");
  EXPECT_EQ(plan->materials[1].name, "___x_2");
}

TEST(ExportPlan, NamesOfFilesDifferByMoreThanCase) {
  character::Character face = test::SmallFace();
  face.materials[0].name = "Wrinkles";  // furrow_wrinkles.glsl holds the functions of all materials
  face.materials[1].name = std::string(300, 'M');
  face.rig.wrinkle_maps[0].name = "Squash";
  face.rig.regions[0].feeds[0].map = face.rig.regions[1].feeds[0].map = "Squash";
  face.rig.wrinkle_maps[2].name = "Material-skin";
  face.rig.regions[2].feeds[0].map = face.rig.regions[3].feeds[0].map = "Material-skin";
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok()) << plan.status().ToString();
  EXPECT_EQ(plan->maps[0].name, "Squash");
  EXPECT_EQ(plan->maps[1].name, "squash_2");
  EXPECT_EQ(plan->maps[2].name, "map_Material_skin");
  ASSERT_EQ(plan->materials.size(), 2u);
  EXPECT_EQ(plan->materials[0].name, "Wrinkles_2");
  EXPECT_EQ(plan->materials[1].name, std::string(100, 'M'));
}

TEST(ExportPlan, RefusesWhatCannotBeDrawn) {
  character::Character face = test::SmallFace();
  face.rig_pictures.clear();  // all pictures are missing
  const auto none = PlanExport(face);
  EXPECT_EQ(none.status().code(), StatusCode::kUnsupported);
  EXPECT_THAT(none.status().todo(), HasSubstr("furrow bake"));
  face.rig = {};
  EXPECT_EQ(PlanExport(face).status().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::authoring
