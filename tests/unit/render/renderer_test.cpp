// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "lost_context.h"
#include "test_character.h"

namespace furrow::render {
namespace {

constexpr int kSize = 96;

class RendererTest : public testing::Test {
 protected:
  void SetUp() override {
    auto renderer = Renderer::Create(head_);
    ASSERT_TRUE(renderer.ok()) << renderer.status().ToString();
    renderer_ = std::move(*renderer);
  }
  FrameRequest Request(const test::Subject& subject, View view = View::kFinal) {
    FrameRequest request;
    request.model = subject.model;
    request.binding = &subject.binding;
    request.wrinkle_weights = subject.weights;
    request.filtered_values = subject.driver_values;
    request.settings.view = view;
    request.camera = *renderer_->Preset("face");
    request.width = request.height = kSize;
    return request;
  }
  Image Render(const FrameRequest& request) {
    Result<Image> image = renderer_->Render(request);
    EXPECT_TRUE(image.ok()) << image.status().ToString();
    return image.ok() ? *image : Image();
  }
  static glm::ivec3 Pixel(const Image& image, int x, int y) {
    const std::uint8_t* rgb = &image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
    return {rgb[0], rgb[1], rgb[2]};
  }

  const character::Character head_ = test::MakeHead();
  std::unique_ptr<Renderer> renderer_;
  test::Subject subject_{head_};
};

TEST_F(RendererTest, DescribesItsDriver) {
  EXPECT_NE(renderer_->description().find("4."), std::string::npos) << renderer_->description();
}

TEST_F(RendererTest, RowsStartAtTheTopAndLightComesFromTheUpperLeft) {
  const Image normals = Render(Request(subject_, View::kNormal));
  EXPECT_GT(Pixel(normals, kSize / 2, 14).g, 180);             // the crown faces up
  EXPECT_LT(Pixel(normals, kSize / 2, kSize - 15).g, 80);      // the chin faces down
  EXPECT_GT(Pixel(normals, kSize * 2 / 3, kSize / 2).r, 140);  // +X is on the right of the picture
  const Image lit = Render(Request(subject_));
  const int upper_left = Pixel(lit, kSize * 3 / 8, kSize / 3).g;
  EXPECT_GT(upper_left, Pixel(lit, kSize * 5 / 8, kSize * 2 / 3).g + 40);
}

TEST_F(RendererTest, TheBackgroundFollowsTheSettings) {
  FrameRequest request = Request(subject_);
  request.settings.background = {0.0f, 0.0f, 0.0f};
  EXPECT_EQ(Pixel(Render(request), 2, 2), glm::ivec3(0));
  request.settings.background = {0.5f, 0.5f, 0.5f};
  EXPECT_NEAR(Pixel(Render(request), 2, 2).g, 188, 1);  // sRGB(0.5), which the tone map does not
                                                        // change
}

// Black skin is the dark inside of a mouth. A black eye is a glossy pupil.
TEST(Renderer, BlackSkinIsDarkAndABlackEyeIsGlossy) {
  for (const auto kind : {character::Material::Kind::kSkin, character::Material::Kind::kEye}) {
    character::Character head = test::MakeHead();
    for (character::Material& material : head.materials) {
      material.kind = kind;
      material.base_colour = {0.0f, 0.0f, 0.0f, 1.0f};
    }
    const auto renderer = Renderer::Create(head);
    ASSERT_TRUE(renderer.ok()) << renderer.status().ToString();
    const test::Subject subject(head);
    FrameRequest request;
    request.model = subject.model;
    request.settings.background = glm::vec3(0.0f);
    request.camera = *(*renderer)->Preset("face");
    request.width = request.height = kSize;
    const Result<Image> image = (*renderer)->Render(request);
    ASSERT_TRUE(image.ok()) << image.status().ToString();
    const int brightest = *std::max_element(image->rgb.begin(), image->rgb.end());
    if (kind == character::Material::Kind::kSkin) EXPECT_EQ(brightest, 0);
    if (kind == character::Material::Kind::kEye) EXPECT_GT(brightest, 60);
  }
}

// A shade in front of the right half of a plane.
character::Character ShadedPlane(bool shaded) {
  character::Character plane = test::MakeSheet(4, 4);
  plane.materials[0].kind = character::Material::Kind::kEye;
  plane.materials[0].base_colour = {0.4f, 0.4f, 0.4f, 1.0f};
  if (!shaded) return plane;
  character::Mesh shade = plane.meshes[0];
  for (character::Vertex& vertex : shade.vertices) {
    vertex.position.x = 0.5f * vertex.position.x + 0.5f;
    vertex.position.z = 0.01f;
  }
  shade.material = 1;
  plane.meshes.push_back(shade);
  character::Material& material = plane.materials.emplace_back();
  material.kind = character::Material::Kind::kShade;
  material.base_colour = {0.25f, 0.25f, 0.25f, 1.0f};
  return plane;
}

TEST(Renderer, AShadeOnlyDarkensWhatLiesBehindIt) {
  const character::Character bare = ShadedPlane(false), covered = ShadedPlane(true);
  const auto render = [](const character::Character& character, View view, Shading shading,
                         int samples) {
    const auto renderer = Renderer::Create(character);
    EXPECT_TRUE(renderer.ok()) << renderer.status().ToString();
    const test::Subject subject(character);
    FrameRequest request;
    request.model = subject.model;
    request.camera = {.position = {0.0f, 0.0f, 3.0f}, .target = {0.0f, 0.0f, 0.0f}};
    request.settings.view = view;
    request.settings.shading = shading;
    request.settings.anti_aliasing.samples = samples;
    request.width = request.height = kSize;
    const Result<Image> image = (*renderer)->Render(request);
    EXPECT_TRUE(image.ok()) << image.status().ToString();
    return *image;
  };
  const auto green = [](const Image& image, int x) {
    return int{image.rgb[static_cast<std::size_t>(3 * (kSize / 2 * kSize + x)) + 1]};
  };
  for (const auto& [shading, samples] :
       {std::pair(Shading::kDiffuse, 1), {Shading::kSkin, 1}, {Shading::kSkin, 4}}) {
    const Image off = render(bare, View::kFinal, shading, samples);
    const Image on = render(covered, View::kFinal, shading, samples);
    EXPECT_NEAR(green(on, kSize / 3), green(off, kSize / 3), 1) << samples;
    EXPECT_GT(green(off, kSize * 2 / 3), 60) << samples;
    EXPECT_LT(green(on, kSize * 2 / 3), 0.7 * green(off, kSize * 2 / 3)) << samples;
    EXPECT_GT(green(on, kSize * 2 / 3), 0.2 * green(off, kSize * 2 / 3)) << samples;
  }
  for (const View view : {View::kNormal, View::kAlbedo, View::kDepth, View::kShadow}) {
    EXPECT_EQ(render(bare, view, Shading::kSkin, 1).rgb,
              render(covered, view, Shading::kSkin, 1).rgb)
        << ViewName(view);
  }
}

// A plane whose UVs lie in a quarter of an atlas, and whose texture fills the unit square, looks as
// one that was never moved.
TEST(Renderer, TilesOfAnAtlasKeepTheirTextures) {
  const auto waves = [](float u, float v) { return 0.004f * std::sin(30.0f * u + 17.0f * v); };
  character::Character plane = test::MakePlane(64, waves, {});
  plane.materials[0].base_colour_texture = static_cast<int>(plane.pictures.size());
  plane.pictures.push_back(test::MakePicture("colours", 64, [](float u, float v) {
    return glm::vec4(u, v, u < 0.5f ? 1.0f : 0.0f, v < 0.25f ? 0.0f : 1.0f);
  }));
  plane.materials[0].alpha_cutoff = 0.5f;  // the shadow and the picture have a hole
  const auto picture = [](const character::Character& character) {
    const auto renderer = Renderer::Create(character);
    EXPECT_TRUE(renderer.ok()) << renderer.status().ToString();
    const test::Subject subject(character);
    FrameRequest request;
    request.model = subject.model;
    request.camera = *(*renderer)->Preset("face");
    request.width = request.height = kSize;
    return (*(*renderer)->Render(request)).rgb;
  };
  const std::vector<std::uint8_t> expected = picture(plane);
  for (character::Vertex& vertex : plane.meshes[0].vertices) {
    vertex.uv = 0.5f * vertex.uv + glm::vec2(0.5f, 0.0f);
  }
  EXPECT_NE(picture(plane), expected);
  plane.materials[0].texture_scale = glm::vec2(2.0f);
  plane.materials[0].texture_offset = glm::vec2(-1.0f, 0.0f);
  const std::vector<std::uint8_t> tiled = picture(plane);
  ASSERT_EQ(tiled.size(), expected.size());
  int different = 0;
  for (std::size_t i = 0; i < tiled.size(); ++i) {
    different += std::abs(int{tiled[i]} - int{expected[i]}) > 2 ? 1 : 0;
  }
  EXPECT_LT(different, 20);  // rounded UVs at the edge of the hole
}

// A composed texel may affect one pixel beyond a mask.
TEST_F(RendererTest, WrinklesChangeOnlyMaskedPixels) {
  const Image mask = Render(Request(subject_, View::kMaskTexture));
  const Image base = Render(Request(subject_));
  subject_.Set("l_squash", 1.0f);
  subject_.Set("r_stretch", 1.0f);
  subject_.Solve();
  const Image wrinkled = Render(Request(subject_));
  const auto is_masked = [&](int x, int y) {
    for (int i = 0; i < 9; ++i) {
      const int column = std::clamp(x + i % 3 - 1, 0, kSize - 1);
      const int row = std::clamp(y + i / 3 - 1, 0, kSize - 1);
      if (Pixel(mask, column, row) != glm::ivec3(0)) return true;
    }
    return false;
  };
  int changed = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const bool same = Pixel(base, x, y) == Pixel(wrinkled, x, y);
      if (!same) ++changed;
      if (!is_masked(x, y)) EXPECT_TRUE(same) << x << ", " << y;
    }
  }
  EXPECT_GT(changed, kSize * kSize / 10);
}

TEST_F(RendererTest, TheWeightsViewIsGreenForStretchAndRedForSquash) {
  subject_.Set("l_squash", 1.0f);
  subject_.Set("r_stretch", 1.0f);
  subject_.Solve();
  const Image image = Render(Request(subject_, View::kWeights));
  const glm::ivec3 right = Pixel(image, kSize * 3 / 8, kSize / 2);  // the subject's right
  const glm::ivec3 left = Pixel(image, kSize * 5 / 8, kSize / 2);
  EXPECT_GT(right.g, right.r + 40);
  EXPECT_GT(left.r, left.g + 40);
  const glm::ivec3 crown =
      Pixel(image, kSize / 2, 14);  // no region: grey, tinted by the lights only
  EXPECT_LT(std::abs(crown.r - crown.g), 20);
}

TEST_F(RendererTest, MaskModesChooseWhichRegionsShow) {
  subject_.Set("l_squash", 1.0f);
  subject_.Solve();
  FrameRequest request = Request(subject_);
  const Image as_rig = Render(request);
  request.settings.mask_mode = MaskMode::kTexture;
  EXPECT_EQ(Render(request).rgb, as_rig.rgb);  // the only active weight has a texture mask
  request.settings.mask_mode = MaskMode::kDynamic;
  // Blend shapes move no joint, so this weight is invisible with dynamic masks only.
  const Image dynamic = Render(request);
  request.settings.wrinkles = false;
  EXPECT_EQ(Render(request).rgb, dynamic.rgb);
}

TEST_F(RendererTest, TheSameRequestGivesTheSamePicture) {
  subject_.Set("l_squash", 0.6f);
  subject_.Solve();
  for (const View view : {View::kFinal, View::kNormal, View::kWeights, View::kWireframe}) {
    const Image first = Render(Request(subject_, view));
    EXPECT_EQ(Render(Request(subject_, view)).rgb, first.rgb) << ViewName(view);
    auto other = Renderer::Create(head_);
    ASSERT_TRUE(other.ok());
    const Result<Image> again = (*other)->Render(Request(subject_, view));
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again->rgb, first.rgb) << ViewName(view);
  }
}

// The bound that FrameRequest states, over the pixels of the head.
TEST_F(RendererTest, AMovingPictureIsNearlyExact) {
  FrameRequest request = Request(subject_);
  request.settings.shading = Shading::kSkin;
  request.settings.anti_aliasing.samples = 1;
  request.width = request.height = 400;
  const Image exact = Render(request);
  request.is_moving = true;
  const Image moving = Render(request);
  EXPECT_NE(moving.rgb, exact.rgb);
  ASSERT_EQ(moving.rgb.size(), exact.rgb.size());
  const glm::ivec3 background = Pixel(exact, 0, 0);
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < exact.height; ++y) {
    for (int x = 0; x < exact.width; ++x) {
      if (Pixel(exact, x, y) == background) continue;
      const glm::dvec3 difference(Pixel(moving, x, y) - Pixel(exact, x, y));
      sum += glm::dot(difference, difference) / 3.0;
      ++count;
    }
  }
  ASSERT_GT(count, 10000);
  EXPECT_LT(std::sqrt(sum / count), 1.0);
}

TEST_F(RendererTest, TwoPicturesInFlightArriveInOrder) {
  FrameRequest first = Request(subject_, View::kNormal);
  first.token = 1;
  FrameRequest second = Request(subject_, View::kWireframe);
  second.token = 2;
  second.width = 48;  // the ring's buffers adapt to any size
  ASSERT_TRUE(renderer_->Submit(first).ok());
  ASSERT_TRUE(renderer_->Submit(second).ok());
  EXPECT_EQ(renderer_->in_flight(), 2);
  const Status third = renderer_->Submit(first);
  EXPECT_EQ(third.code(), StatusCode::kUnavailable);
  const Result<Image> one = renderer_->Poll(true);
  const Result<Image> two = renderer_->Poll(true);
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(one->token, 1u);
  EXPECT_EQ(two->token, 2u);
  EXPECT_EQ(two->width, 48);
  EXPECT_EQ(renderer_->in_flight(), 0);
  EXPECT_EQ(one->rgb, Render(first).rgb);
  EXPECT_EQ(two->rgb, Render(second).rgb);
  const Result<Image> none = renderer_->Poll(true);
  ASSERT_TRUE(none.ok());
  EXPECT_EQ(none->width, 0);
}

TEST_F(RendererTest, RenderReturnsTheNewestPicture) {
  FrameRequest request = Request(subject_);
  request.token = 1;
  ASSERT_TRUE(renderer_->Submit(request).ok());
  request.token = 2;
  EXPECT_EQ(Render(request).token, 2u);
  EXPECT_EQ(renderer_->in_flight(), 0);
}

TEST_F(RendererTest, ARejectedRequestDoesNotAffectTheRenderer) {
  FrameRequest bad = Request(subject_);
  bad.wrinkle_weights = bad.wrinkle_weights.first(1);
  const Status status = renderer_->Submit(bad);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(status.where(), "wrinkle_weights");
  bad = Request(subject_);
  bad.width = 0;
  EXPECT_EQ(renderer_->Submit(bad).where(), "width");
  EXPECT_EQ(renderer_->in_flight(), 0);
  EXPECT_EQ(Render(Request(subject_)).width, kSize);
}

TEST_F(RendererTest, TwoRenderersOfOneThreadAreIndependent) {
  const Image before = Render(Request(subject_));
  {
    auto other = Renderer::Create(head_);
    ASSERT_TRUE(other.ok());
    ASSERT_TRUE((*other)->Submit(Request(subject_, View::kNormal)).ok());
    EXPECT_EQ(Render(Request(subject_)).rgb, before.rgb);
  }
  EXPECT_EQ(Render(Request(subject_)).rgb, before.rgb);
}

TEST_F(RendererTest, ALostContextIsReportedAndANewRendererDrawsTheSame) {
  const FrameRequest request = Request(subject_);
  const Image before = Render(request);
  ASSERT_TRUE(renderer_->Submit(request).ok());
  test::DestroyCurrentContext();
  for (const Status& status : {renderer_->Submit(request), renderer_->Poll(true).status()}) {
    EXPECT_EQ(status.code(), StatusCode::kUnavailable) << status.ToString();
    EXPECT_NE(status.ToString().find("create a new renderer"), std::string::npos);
  }
  renderer_.reset();
  auto recreated = Renderer::Create(head_);
  ASSERT_TRUE(recreated.ok()) << recreated.status().ToString();
  renderer_ = std::move(*recreated);
  EXPECT_EQ(Render(request).rgb, before.rgb);
}

// In the other renderer's context, the lost renderer's names belong to other objects.
TEST_F(RendererTest, ARendererWithALostContextDeletesNothingOfAnother) {
  auto lost = Renderer::Create(head_);
  ASSERT_TRUE(lost.ok());
  ASSERT_TRUE((*lost)->Render(Request(subject_)).ok());
  test::DestroyCurrentContext();
  const Image before = Render(Request(subject_));
  (*lost).reset();
  EXPECT_EQ(Render(Request(subject_)).rgb, before.rgb);
}

// A rig may name pictures that the character does not have. Their maps are not drawn, and
// everything else is.
TEST_F(RendererTest, MapsWithMissingPicturesAreNotDrawn) {
  subject_.Set("l_squash", 1.0f);
  subject_.Solve();
  FrameRequest request = Request(subject_);
  const Image folded = Render(request);
  request.settings.wrinkles = false;
  const Image smooth = Render(request);
  ASSERT_NE(folded.rgb, smooth.rgb);
  request.settings.wrinkles = true;
  for (const char* lacking : {"masks.png", "squash.png"}) {
    character::Character head = test::MakeHead();
    ASSERT_EQ(std::erase_if(head.rig_pictures,
                            [&](const auto& picture) { return picture.first == lacking; }),
              1u)
        << lacking;
    const auto renderer = Renderer::Create(head);
    ASSERT_TRUE(renderer.ok()) << renderer.status().ToString();
    const Result<Image> image = (*renderer)->Render(request);
    ASSERT_TRUE(image.ok()) << image.status().ToString();
    EXPECT_EQ(image->rgb, smooth.rgb) << lacking;
  }
}

TEST(RendererCreate, RejectsMeshesWithInvalidIndices) {
  character::Character head = test::MakeHead();
  head.meshes[0].indices[5] = 1u << 30;
  EXPECT_EQ(Renderer::Create(head).status().code(), StatusCode::kInvalidArgument);
  head = test::MakeHead();
  head.meshes[0].vertices[3].joints[1] = 77;
  EXPECT_EQ(Renderer::Create(head).status().code(), StatusCode::kInvalidArgument);
  head = test::MakeHead();
  head.meshes[0].material = 4;
  EXPECT_EQ(Renderer::Create(head).status().code(), StatusCode::kInvalidArgument);
  head = test::MakeHead();
  head.pictures[0].width = 9999;
  EXPECT_EQ(Renderer::Create(head).status().code(), StatusCode::kInvalidArgument);
}

TEST(RendererCreate, ReportsARigWithMoreMapsThanTheDriverSupports) {
  character::Character head = test::MakeHead();
  for (int i = 0; i < 4000; ++i) {
    head.rig.wrinkle_maps.emplace_back().name = "m" + std::to_string(i);
  }
  const Status status = Renderer::Create(head).status();
  EXPECT_EQ(status.code(), StatusCode::kLimit);
  EXPECT_NE(status.what().find("4003 wrinkle maps"), std::string::npos) << status.ToString();
}

}  // namespace
}  // namespace furrow::render
