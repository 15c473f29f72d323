// SPDX-License-Identifier: Apache-2.0
// No material reflects more light than it receives: balls of every kind, under the sky and under
// lamps, with the full lighting.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/scene/lighting.h"
#include "tests/unit/render/reference/float_picture.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/reference/target_reader.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

using Kind = character::Material::Kind;
using test::FloatPicture;
using test::SphereOnPlane;

constexpr int kFurnaceSize = 96;
constexpr SphereOnPlane kBall{{0.0, 0.0, 0.0}, 0.06};

struct Surface {
  Kind kind = Kind::kSkin;
  float albedo = 1.0f;
  float roughness = 0.6f;
};

// Far away, so that rays are nearly parallel. The ball fills two thirds of the picture.
Camera From(const glm::vec3& direction) {
  Camera camera;
  camera.position = 4.0f * direction;
  camera.target = glm::vec3(0.0f);
  camera.fov_y_degrees = 2.6f;
  return camera;
}

class Furnace {
 public:
  explicit Furnace(const Surface& surface) {
    ball_.meshes.erase(ball_.meshes.begin());  // the plane
    for (character::Material& material : ball_.materials) {
      material.kind = surface.kind;
      material.base_colour = glm::vec4(glm::vec3(surface.albedo), 1.0f);
      material.roughness = surface.roughness;
    }
    renderer_ = test::Expect(Renderer::Create(ball_));
    renderer_->SetObserver(&reader_);
  }

  [[nodiscard]] FrameRequest Request(const glm::vec3& from) const {
    FrameRequest request = test::SceneRequest(ball_, From(from), kFurnaceSize, kFurnaceSize);
    Settings& settings = request.settings;
    settings.background = glm::vec3(0.0f);
    settings.lights.preset = LightPreset::kThesis;
    settings.shadow.filter = ShadowFilter::kOff;
    settings.occlusion.method = OcclusionMethod::kOff;
    settings.translucency.enabled = false;
    return request;
  }
  // Linear light, before bloom and tone map.
  [[nodiscard]] const FloatPicture& Draw(const FrameRequest& request) {
    (void)test::Expect(renderer_->Render(request));
    return reader_.Target("combined");
  }

 private:
  character::Character ball_ = test::MakeSphereOnPlane(kBall, 1e-4f);
  std::unique_ptr<Renderer> renderer_;
  test::TargetReader reader_;
};

class FurnaceTest : public testing::TestWithParam<Kind> {};

// Sky only. Every pixel is at most as bright as the larger of its diffuse sky light and the sky in
// its mirror direction.
TEST_P(FurnaceTest, NoPixelIsBrighterThanItsSky) {
  for (const Surface& surface : {Surface{GetParam(), 1.0f, 0.6f},
                                 {GetParam(), 1.0f, 0.3f},
                                 {GetParam(), 0.5f, 0.3f},
                                 {GetParam(), 0.02f, 0.6f}}) {
    Furnace furnace(surface);
    FrameRequest request = furnace.Request({0.0f, 0.0f, 1.0f});
    request.settings.lights.intensity = 0.0f;
    request.settings.lights.ambient = 8.0f;
    const GradientSky sky = MakeLighting(request.settings.lights, {}).sky;
    const SphericalHarmonics ambient =
        AmbientPolynomial(ProjectRadiance([&](const glm::vec3& d) { return SkyRadiance(sky, d); }));
    const FloatPicture& drawn = furnace.Draw(request);
    double most = 0.0;
    int pixels = 0;
    for (int y = 0; y < kFurnaceSize; ++y) {
      for (int x = 0; x < kFurnaceSize; ++x) {
        const test::Ray ray = test::PixelRay(request.camera, x, y, kFurnaceSize, kFurnaceSize);
        const auto hit = test::FirstHit(kBall, 0.0, ray);
        if (!hit || glm::dot(hit->normal, ray.direction) > -0.05)
          continue;  // the rim of the
                     // facets
        const glm::vec3 mirrored(glm::reflect(ray.direction, hit->normal));
        const float arrives = std::max(EvaluateAmbient(ambient, glm::vec3(hit->normal)).g,
                                       SkyRadiance(sky, mirrored).g);
        most = std::max(most, static_cast<double>(drawn.At(x, y).g / arrives));
        ++pixels;
      }
    }
    std::printf("under the sky, albedo %.2f, roughness %.1f: at most %.4f of what arrives\n",
                static_cast<double>(surface.albedo), static_cast<double>(surface.roughness), most);
    EXPECT_GT(pixels, 2000);
    EXPECT_GT(most, 0.5 * static_cast<double>(surface.albedo));
    EXPECT_LT(most, 1.005) << "albedo " << surface.albedo << ", roughness " << surface.roughness;
  }
}

// The light that a ball reflects under fixed lamps, over all directions: the mean over cameras all
// around.
double SentOut(const Surface& surface, float strength) {
  constexpr int kCameras = 12;
  const double golden_angle = glm::pi<double>() * (3.0 - std::sqrt(5.0));
  Furnace furnace(surface);
  double sum = 0.0;
  for (int i = 0; i < kCameras; ++i) {
    const double y = 1.0 - 2.0 * (i + 0.5) / kCameras;
    const double azimuth = std::remainder(golden_angle * i, glm::two_pi<double>());
    const double radius = std::sqrt(1.0 - y * y);
    FrameRequest request =
        furnace.Request(glm::vec3(radius * std::sin(azimuth), y, radius * std::cos(azimuth)));
    request.settings.lights.turn_degrees = static_cast<float>(-glm::degrees(azimuth));
    request.settings.lights.ambient = 0.0f;
    request.settings.specular.strength = strength;
    for (const glm::vec4& texel : furnace.Draw(request).texels) sum += static_cast<double>(texel.g);
  }
  return sum / kCameras;
}

// Lamps only, from the side and from behind. Over all directions, no ball reflects more light than
// a white diffuse ball, which reflects all of it.
TEST_P(FurnaceTest, NoBallReflectsMoreThanTheLampsGive) {
  const double all = SentOut({.kind = Kind::kOther}, 0.0f);
  for (const float strength : {0.0f, 1.0f}) {
    const double white = SentOut({.kind = GetParam()}, strength) / all;
    const double grey = SentOut({.kind = GetParam(), .albedo = 0.5f}, strength) / all;
    const double black = SentOut({.kind = GetParam(), .albedo = 0.02f}, strength) / all;
    std::printf("under lamps, specular %.0f: white sends out %.4f, grey %.4f, black %.4f of all\n",
                static_cast<double>(strength), white, grey, black);
    EXPECT_LT(white, 1.002);
    EXPECT_GT(white, 0.75);
    EXPECT_LT(grey, white);
    EXPECT_LT(black, 0.5 * grey);
  }
}

std::string Name(const testing::TestParamInfo<Kind>& kind) {
  switch (kind.param) {
    case Kind::kSkin: return "skin";
    case Kind::kCloth: return "cloth";
    case Kind::kEye: return "eye";
    case Kind::kHair: return "hair";
    case Kind::kOther: return "other";
    case Kind::kShade: return "shade";
  }
  return {};
}

INSTANTIATE_TEST_SUITE_P(Kinds, FurnaceTest,
                         testing::Values(Kind::kSkin, Kind::kCloth, Kind::kEye, Kind::kHair,
                                         Kind::kOther),
                         Name);

}  // namespace
}  // namespace furrow::render
