// SPDX-License-Identifier: Apache-2.0
// Every view of the procedural head with every region active.
#include <gtest/gtest.h>

#include "sitter.h"

namespace furrow::render::golden {
namespace {

constexpr Shot kShots[] = {
    {"final", View::kFinal, "face"},
    {"final_tangent_space", View::kFinal, "face", NormalBlend::kTangentSpace},
    {"final_three_quarter", View::kFinal, "three_quarter"},
    {"final_profile", View::kFinal, "profile"},
    {"normal", View::kNormal, "face"},
    {"mask_dynamic", View::kMaskDynamic, "face"},
    {"mask_texture", View::kMaskTexture, "face"},
    {"weights", View::kWeights, "face"},
    {"wireframe", View::kWireframe, "face"},
    {"skin", View::kFinal, "face", kBlend, Shading::kSkin},
    {"skin_three_quarter", View::kFinal, "three_quarter", kBlend, Shading::kSkin},
    {"skin_one_sample", View::kFinal, "three_quarter", kBlend, Shading::kSkin, 1},
    {"shadow", View::kShadow, "three_quarter"},
    {"shadow_maps", View::kShadowMaps, "three_quarter"},
    {"irradiance", View::kIrradiance, "face"},
    {"scattered", View::kScattered, "face"},
    {"specular", View::kSpecular, "three_quarter"},
    {"translucency", View::kTranslucency, "profile"},
    {"albedo", View::kAlbedo, "face"},
    {"depth", View::kDepth, "three_quarter"},
    {"material", View::kMaterial, "face"},
    {"occlusion", View::kOcclusion, "face"},
    {"bloom", View::kBloom, "face", kBlend, Shading::kDiffuse, 4, kGlow},
};

class Golden : public testing::TestWithParam<Shot> {};

TEST_P(Golden, LooksAsExpected) {
  Sitter head(test::MakeHead());
  test::Subject& subject = head.subject();
  subject.Set("l_squash", 1.0f);
  subject.Set("r_stretch", 0.9f);
  subject.pose.joints[2].rotation = glm::angleAxis(1.0f, glm::vec3(1.0f, 0.0f, 0.0f));
  subject.Solve();
  ExpectLooksLike(head.Draw(GetParam()), GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Views, Golden, testing::ValuesIn(kShots),
                         [](const auto& shot) { return std::string(shot.param.name); });

}  // namespace
}  // namespace furrow::render::golden
