// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "test_character.h"

// Every view of the procedural head with every region at work. Drivers differ at edges and in the
// last bit of a texture filter, so a pixel may differ by little, and few may differ by much.
namespace furrow::render {
namespace {

constexpr int kSize = 96;
constexpr float kSmall = 6.0f / 255.0f;  // what another driver's rounding may do to any pixel ...
constexpr double kMaxFailShare = 0.01;  // ... and the share of pixels, at edges, that may exceed it
constexpr double kMaxMeanError = 1.5 / 255;  // of all pixels: nothing has shifted or changed tone

struct Shot {
  const char* name;
  View view;
  const char* camera;
  NormalBlend blend = NormalBlend::kPartialDerivative;
  Shading shading = Shading::kDiffuse;
  int samples = 4;  // on every device
};

constexpr auto kBlend = NormalBlend::kPartialDerivative;

void PrintTo(const Shot& shot, std::ostream* out) { *out << shot.name; }

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
    {"irradiance", View::kIrradiance, "face"},
    {"scattered", View::kScattered, "face"},
    {"specular", View::kSpecular, "three_quarter"},
    {"translucency", View::kTranslucency, "profile"},
    {"albedo", View::kAlbedo, "face"},
    {"depth", View::kDepth, "three_quarter"},
    {"material", View::kMaterial, "face"},
    {"occlusion", View::kOcclusion, "face"},
    {"bloom", View::kBloom, "face"},
};

std::filesystem::path Folder() {
  return std::filesystem::path(FURROW_SOURCE_DIR) / "tests" / "golden" / "images";
}

Result<Image> Draw(const Shot& shot) {
  const character::Character head = test::MakeHead();
  auto renderer = Renderer::Create(head);
  if (!renderer.ok()) return renderer.status();
  test::Subject subject(head);
  subject.Set("l_squash", 1.0f);
  subject.Set("r_stretch", 0.9f);
  subject.pose.joints[2].rotation = glm::angleAxis(1.0f, glm::vec3(1.0f, 0.0f, 0.0f));
  subject.Solve();
  FrameRequest request;
  request.model = subject.model;
  request.binding = &subject.binding;
  request.wrinkle_weights = subject.weights;
  request.filtered_values = subject.driver_values;
  request.settings.view = shot.view;
  request.settings.normal_blend = shot.blend;
  request.settings.shading = shot.shading;
  request.settings.anti_aliasing.samples = shot.samples;
  request.camera = *(*renderer)->Preset(shot.camera);
  request.width = request.height = kSize;
  return (*renderer)->Render(request);
}

void Save(const Image& image, const std::filesystem::path& path) {
  const auto bytes = EncodeImage(image, ImageFormat::kPng);
  ASSERT_TRUE(bytes.ok()) << bytes.status().ToString();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes->data()),
             static_cast<std::streamsize>(bytes->size()));
  ASSERT_TRUE(file.good()) << path;
}

class Golden : public testing::TestWithParam<Shot> {};

TEST_P(Golden, LooksAsExpected) {
  Result<Image> drawn = Draw(GetParam());
  ASSERT_TRUE(drawn.ok()) << drawn.status().ToString();
  const std::filesystem::path expected_path = Folder() / (std::string(GetParam().name) + ".png");
  if (std::getenv("FURROW_UPDATE_GOLDEN") != nullptr) {
    Save(*drawn, expected_path);
    GTEST_SKIP() << "wrote " << expected_path;
  }
  const OIIO::ImageBuf expected(expected_path.string());
  ASSERT_TRUE(expected.has_error() == false && expected.spec().width == kSize)
      << expected_path << ": " << expected.geterror();
  const OIIO::ImageSpec spec(kSize, kSize, 3, OIIO::TypeDesc::UINT8);
  const OIIO::ImageBuf actual(spec, drawn->rgb.data());
  const auto difference = OIIO::ImageBufAlgo::compare(actual, expected, kSmall, kSmall);
  const bool close =
      difference.nfail <= kMaxFailShare * kSize * kSize && difference.meanerror <= kMaxMeanError;
  if (!close) Save(*drawn, std::filesystem::path(FURROW_BINARY_DIR) / expected_path.filename());
  EXPECT_TRUE(close) << difference.nfail << " pixels differ, mean " << difference.meanerror
                     << ", at most " << difference.maxerror << " at " << difference.maxx << ", "
                     << difference.maxy << "; the picture is in " << FURROW_BINARY_DIR;
}

INSTANTIATE_TEST_SUITE_P(Views, Golden, testing::ValuesIn(kShots),
                         [](const auto& shot) { return std::string(shot.param.name); });

}  // namespace
}  // namespace furrow::render
