// SPDX-License-Identifier: Apache-2.0
// The two shipped characters. One side of the brow is raised and the other lowered, one side sneers
// and the other half smiles, so that swapped sides are visible. The default character is drawn in
// every view; MakeHuman's character requires its data.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/import/makehuman/makehuman.h"
#include "character/package/package.h"
#include "motion/pose_source.h"
#include "rig/rig_reference_pose.h"
#include "sitter.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::render::golden {
namespace {

constexpr auto kSkin = Shading::kSkin;

constexpr Shot kDefault[] = {
    {"final", View::kFinal, "face"},
    {"normal", View::kNormal, "eyes"},
    {"mask_dynamic", View::kMaskDynamic, "body"},
    {"mask_texture", View::kMaskTexture, "face"},
    {"weights", View::kWeights, "face"},
    {"wireframe", View::kWireframe, "eyes"},
    {"skin", View::kFinal, "face", kBlend, kSkin},
    {"skin_one_sample", View::kFinal, "three_quarter", kBlend, kSkin, 1},
    {"skin_eyes", View::kFinal, "eyes", kBlend, kSkin},
    {"skin_mouth", View::kFinal, "mouth", kBlend, kSkin},
    {"skin_body", View::kFinal, "body_three_quarter", kBlend, kSkin},
    {"shadow", View::kShadow, "three_quarter"},
    {"shadow_maps", View::kShadowMaps, "three_quarter"},
    {"irradiance", View::kIrradiance, "eyes"},
    {"scattered", View::kScattered, "face"},
    {"specular", View::kSpecular, "eyes"},
    {"translucency", View::kTranslucency, "profile"},
    {"albedo", View::kAlbedo, "face"},
    {"depth", View::kDepth, "three_quarter"},
    {"material", View::kMaterial, "face"},
    {"occlusion", View::kOcclusion, "face"},
    {"bloom", View::kBloom, "face", kBlend, kSkin, 4, kGlow},
};

constexpr Shot kMakeHuman[] = {
    {"final", View::kFinal, "face"},         {"skin", View::kFinal, "eyes", kBlend, kSkin},
    {"normal", View::kNormal, "eyes"},       {"weights", View::kWeights, "face"},
    {"occlusion", View::kOcclusion, "face"},
};

// Adds reference poses of the rig to the rest pose.
void Pose(const std::vector<std::string>& names, Sitter* sitter) {
  const wrinkle::Rig& rig = sitter->character().rig;
  test::Subject& subject = sitter->subject();
  for (const std::string& name : names) {
    const auto pose = std::ranges::find(rig.reference_poses, name, &wrinkle::ReferencePose::name);
    ASSERT_NE(pose, rig.reference_poses.end()) << name;
    const Status added =
        wrinkle::ApplyReferencePose(*pose, sitter->character().skeleton, subject.pose.joints);
    ASSERT_TRUE(added.ok()) << added.ToString();
  }
  subject.Solve();
}

class DefaultCharacter : public testing::TestWithParam<Shot> {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path glb =
        std::filesystem::path(FURROW_BINARY_DIR) / "share" / "furrow" / "default.glb";
    if (!std::filesystem::exists(glb)) return;
    sitter_ = std::make_unique<Sitter>(
        test::Expect(character::LoadCharacter(glb, {}, motion::CachedPoseSource())));
    Pose({"brow_raise_inner_l", "brow_raise_outer_l", "brow_lower_r", "nose_wrinkle_r",
          "cheek_raise_r", "lip_corner_pull_r"},
         sitter_.get());
  }
  static void TearDownTestSuite() { sitter_.reset(); }

  inline static std::unique_ptr<Sitter> sitter_;
};

TEST_P(DefaultCharacter, LooksAsExpected) {
  if (!sitter_) GTEST_SKIP() << "no default.glb: build furrow_share";
  ExpectLooksLike(sitter_->Draw(GetParam()), std::string("default/") + GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Views, DefaultCharacter, testing::ValuesIn(kDefault),
                         [](const auto& shot) { return std::string(shot.param.name); });

class MakeHuman : public testing::TestWithParam<Shot> {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path folder = std::filesystem::path(FURROW_SHARED_DATA) / "makehuman";
    if (!std::filesystem::exists(folder)) return;
    authoring::ImportOptions options;
    options.rig = std::filesystem::path(FURROW_SOURCE_DIR) / "rig" / "rigs" / "makehuman.json";
    options.poses = motion::CachedPoseSource();
    options.texture_size = 256;
    sitter_ = std::make_unique<Sitter>(test::Expect(authoring::ImportMakeHuman(folder, options)));
    Pose({"brow_inner_up_l", "brow_outer_up_l", "brow_down_r", "nose_wrinkle", "smile_r"},
         sitter_.get());
  }
  static void TearDownTestSuite() { sitter_.reset(); }

  inline static std::unique_ptr<Sitter> sitter_;
};

TEST_P(MakeHuman, LooksAsExpected) {
  if (!sitter_) GTEST_SKIP() << "no MakeHuman data in " << FURROW_SHARED_DATA;
  ExpectLooksLike(sitter_->Draw(GetParam()), std::string("makehuman/") + GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Views, MakeHuman, testing::ValuesIn(kMakeHuman),
                         [](const auto& shot) { return std::string(shot.param.name); });

}  // namespace
}  // namespace furrow::render::golden
