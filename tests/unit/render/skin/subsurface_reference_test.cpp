// SPDX-License-Identifier: Apache-2.0
// Every subsurface method of the renderer compared with exact diffusion on the CPU: a card under
// even light, a straight edge, the corner of a card, a sphere.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/scene/lighting.h"
#include "render/skin/skin_profile.h"
#include "render/skin/subsurface_kernel.h"
#include "tests/unit/render/reference/diffusion.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/reference/target_reader.h"

namespace furrow::render {
namespace {

using character::Material;
using test::FloatPicture;
using test::PictureError;

constexpr float kMmPerPixel = 0.125f;
constexpr int kWidth = 240;
constexpr int kHeight = 200;
constexpr float kNoSkin = 30000.0f;  // the irradiance's alpha is larger without skin
constexpr test::CardHalf kWhite{Material::Kind::kSkin, 1.0f};
constexpr test::CardHalf kBlack{Material::Kind::kSkin, 0.0f};

struct Method {
  std::string name;
  SubsurfaceMethod method;
  int taps = 17;
};

const std::vector<Method>& AllMethods() {
  static const std::vector<Method> methods = {
      {"gaussians", SubsurfaceMethod::kGaussians},
      {"separable, 25 taps", SubsurfaceMethod::kSeparable, 25},
      {"separable, 17 taps", SubsurfaceMethod::kSeparable, 17},
      {"separable, 11 taps", SubsurfaceMethod::kSeparable, 11},
      {"burley", SubsurfaceMethod::kBurley},
      {"preintegrated", SubsurfaceMethod::kPreintegrated},
      {"off", SubsurfaceMethod::kOff}};
  return methods;
}

// Light on skin before and after scattering. Alpha is 1 on skin and 0 elsewhere.
struct SkinLight {
  FloatPicture before;
  FloatPicture after;
};

FloatPicture SkinOf(FloatPicture picture) {
  for (glm::vec4& texel : picture.texels) {
    texel = texel.a < kNoSkin ? glm::vec4(glm::vec3(texel), 1.0f) : glm::vec4(0.0f);
  }
  return picture;
}

// Only diffuse light of directional lamps, all of which scatters, as the references assume.
FrameRequest DiffusionRequest(const character::Character& scene, const Camera& camera, int width,
                              int height, const Method& method) {
  FrameRequest request = test::SceneRequest(scene, camera, width, height);
  Settings& settings = request.settings;
  settings.lights.preset = LightPreset::kThesis;
  settings.lights.ambient = 0.0f;
  settings.shadow.filter = ShadowFilter::kOff;
  settings.occlusion.method = OcclusionMethod::kOff;
  settings.translucency.enabled = false;
  settings.specular.conserve_energy = false;
  settings.bloom.strength = 0.0f;
  settings.subsurface.method = method.method;
  settings.subsurface.taps = method.taps;
  settings.subsurface.mix = 1.0f;  // includes the albedo in the light, so that a card can be
                                   // painted lit
  return request;
}

SkinLight Draw(Renderer* renderer, const FrameRequest& request) {
  test::TargetReader reader;
  renderer->SetObserver(&reader);
  const Result<Image> image = renderer->Render(request);
  renderer->SetObserver(nullptr);
  EXPECT_TRUE(image.ok()) << image.status().ToString();
  const FloatPicture before = SkinOf(reader.Target("scene irradiance"));
  return {before, reader.Has("scattered") ? SkinOf(reader.Target("scattered")) : before};
}

class SubsurfaceReference : public testing::Test {
 protected:
  SkinLight DrawCard(const test::CardHalf& left, const test::CardHalf& right, float width_mm,
                     const Method& method, int width = kWidth, int height = kHeight) {
    const character::Character card =
        test::MakeCard(width_mm * 1e-3f, 0.8e-3f * width_mm, left, right);
    auto renderer = Renderer::Create(card);
    EXPECT_TRUE(renderer.ok()) << renderer.status().ToString();
    const Camera camera = test::CardCamera(kMmPerPixel, height);
    return Draw(renderer->get(), DiffusionRequest(card, camera, width, height, method));
  }
};

// RMSE over all three channels.
double WholeRmse(const PictureError& error) { return glm::length(error.rmse) / std::sqrt(3.0); }

void Print(const char* scene, const std::string& method, const PictureError& error) {
  std::printf("%-7s %-20s RMSE %.5f %.5f %.5f, all %.5f; worst %.4f %.4f %.4f\n", scene,
              method.c_str(), error.rmse.r, error.rmse.g, error.rmse.b, WholeRmse(error),
              error.worst.r, error.worst.g, error.worst.b);
}

// Divides by the light on a white surface, so that errors are relative.
void Normalise(const glm::vec4& white, FloatPicture* picture) {
  for (glm::vec4& texel : picture->texels) {
    texel = glm::vec4(glm::vec3(texel) / glm::vec3(white), texel.a);
  }
}

TEST_F(SubsurfaceReference, UniformLightStaysUniform) {
  for (const Method& method : AllMethods()) {
    // One card larger than the picture, and one with all its edges in the picture.
    for (const float width_mm : {100.0f, 20.0f}) {
      const SkinLight light = DrawCard(kWhite, kWhite, width_mm, method);
      double worst = 0.0;
      int texels = 0;
      for (std::size_t i = 0; i < light.before.texels.size(); ++i) {
        if (light.before.texels[i].a == 0.0f) continue;
        ++texels;
        for (int channel = 0; channel < 3; ++channel) {
          const double before = light.before.texels[i][channel];
          ASSERT_GT(before, 0.1);
          worst = std::max(worst, std::abs(light.after.texels[i][channel] / before - 1.0));
        }
      }
      EXPECT_GT(texels, 5000);
      EXPECT_LT(worst, 1e-3) << method.name << ", card of " << width_mm << " mm";
    }
  }
}

// Light at `mm` to the right of an edge, relative to the light on the lit right side.
glm::vec3 AcrossEdge(const SkinLight& light, double mm) {
  const double x = kWidth / 2 + mm / kMmPerPixel - 0.5;
  const int left = static_cast<int>(std::floor(x));
  const float share = static_cast<float>(x - left);
  const glm::vec4 white = light.before.At(kWidth - 1, kHeight / 2);
  return glm::mix(glm::vec3(light.after.At(left, kHeight / 2)),
                  glm::vec3(light.after.At(left + 1, kHeight / 2)), share) /
         glm::vec3(white);
}

TEST_F(SubsurfaceReference, GaussiansMatchTheStepResponse) {
  const SkinLight light = DrawCard(kBlack, kWhite, 100.0f, AllMethods()[0]);
  EXPECT_NEAR(AcrossEdge(light, 1.0).r, 0.875, 0.01);
  for (const double mm : {-4.0, -2.0, -1.0, -0.5, 0.5, 2.0, 4.0}) {
    const glm::vec3 exact = StepResponse(HumanSkin(), mm);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(AcrossEdge(light, mm)[channel], exact[channel], 0.01) << mm << " " << channel;
    }
  }
}

FloatPicture ExactEdge() {
  FloatPicture exact(kWidth, kHeight, glm::vec4(1.0f));
  for (int x = 0; x < kWidth; ++x) {
    const glm::vec3 light = StepResponse(HumanSkin(), (x + 0.5 - kWidth / 2) * kMmPerPixel);
    for (int y = 0; y < kHeight; ++y) exact.At(x, y) = glm::vec4(light, 1.0f);
  }
  return exact;
}

// Allowed errors of a method (RMSE of red, which travels farthest) at an edge, on a card with its
// own edges, and on a sphere of 8 mm: 1.25 times the measured errors.
struct Limits {
  double edge;
  double card;
  double sphere;
};

Limits LimitsOf(SubsurfaceMethod method) {
  switch (method) {
    case SubsurfaceMethod::kGaussians: return {0.0025, 0.006, 0.006};
    case SubsurfaceMethod::kSeparable: return {0.008, 0.011, 0.0046};
    case SubsurfaceMethod::kBurley: return {0.018, 0.022, 0.007};
    case SubsurfaceMethod::kPreintegrated: return {0.085, 0.1, 0.001};
    case SubsurfaceMethod::kOff: break;
  }
  return {0.085, 0.1, 0.015};
}

// With any number of taps, the error of the separable kernel is at most twice that of the six
// Gaussians, which take more than twice the time. `errors`: of AllMethods(), in that order.
void ExpectSeparableWithinTwice(const std::vector<double>& errors) {
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LE(errors[i], 2.0 * errors[0]) << AllMethods()[i].name;
  }
  // More taps give a smaller error.
  EXPECT_TRUE(std::is_sorted(errors.begin() + 1, errors.begin() + 4));
}

TEST_F(SubsurfaceReference, ErrorsAtAStraightEdge) {
  const FloatPicture exact = ExactEdge();
  std::vector<double> errors;
  for (const Method& method : AllMethods()) {
    SkinLight light = DrawCard(kBlack, kWhite, 100.0f, method);
    Normalise(light.before.At(kWidth - 1, kHeight / 2), &light.after);
    const PictureError error = Compare(light.after, exact, 0);
    Print("edge", method.name, error);
    EXPECT_LT(error.rmse.r, LimitsOf(method.method).edge) << method.name;
    errors.push_back(WholeRmse(error));
  }
  // The screen-space methods are better than no scattering.
  const double off = errors.back();
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT(errors[i], 0.25 * off) << AllMethods()[i].name;
  ExpectSeparableWithinTwice(errors);
}

// Edges of both light and skin: a card of 20 x 16 mm with a lit right half.
TEST_F(SubsurfaceReference, ErrorsOnACardWithEdges) {
  std::vector<double> errors;
  for (const Method& method : AllMethods()) {
    SkinLight light = DrawCard(kBlack, kWhite, 20.0f, method);
    const glm::vec4 white = light.before.At(kWidth / 2 + 40, kHeight / 2);
    Normalise(white, &light.before);
    Normalise(white, &light.after);
    const FloatPicture exact = Diffuse(HumanSkin(), light.before, kMmPerPixel);
    const PictureError error = Compare(light.after, exact, 0);
    EXPECT_GT(error.texels, 15000u);
    Print("card", method.name, error);
    EXPECT_LT(error.rmse.r, LimitsOf(method.method).card) << method.name;
    errors.push_back(WholeRmse(error));
  }
  ExpectSeparableWithinTwice(errors);
}

// Light on a sphere by its normal: the sum of all lamps' responses.
class LitSphere {
 public:
  LitSphere(double radius_mm, const Lighting& lighting) : lighting_(lighting) {
    for (int i = 0; i <= kSteps; ++i) {
      responses_[static_cast<std::size_t>(i)] =
          SphereResponse(HumanSkin(), 2.0 * i / kSteps - 1.0, 1.0 / radius_mm);
    }
  }
  [[nodiscard]] glm::vec3 At(const glm::dvec3& normal) const {
    glm::vec3 light(0.0f);
    for (const LightSource& lamp : lighting_.lights) {
      const double place = (glm::dot(normal, glm::dvec3(lamp.direction)) + 1.0) * 0.5 * kSteps;
      const auto step = static_cast<std::size_t>(std::clamp(place, 0.0, kSteps - 1.0));
      const auto share = static_cast<float>(place - static_cast<double>(step));
      light += lamp.radiance * glm::mix(responses_[step], responses_[step + 1], share);
    }
    return light;
  }

 private:
  static constexpr int kSteps = 1024;
  const Lighting& lighting_;
  std::array<glm::vec3, kSteps + 1> responses_;
};

// A sphere of 8 mm without its rim, where the picture shows less than a millimetre of the surface
// that lights it.
FloatPicture ExactSphere(const test::SphereOnPlane& scene, const Camera& camera,
                         const Lighting& lighting) {
  const LitSphere sphere(1e3 * scene.radius, lighting);
  FloatPicture exact(kHeight, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kHeight; ++x) {
      const test::Ray ray = test::PixelRay(camera, x, y, kHeight, kHeight);
      const std::optional<test::Hit> hit = test::FirstHit(scene, 0.0, ray);
      if (!hit || glm::dot(hit->normal, ray.direction) > -0.45) continue;
      exact.At(x, y) = glm::vec4(sphere.At(hit->normal), 1.0f);
    }
  }
  return exact;
}

TEST_F(SubsurfaceReference, ErrorsOnASphere) {
  // The plane is far below and not drawn.
  const test::SphereOnPlane scene{{0.0, 0.0, 0.0}, 0.008};
  character::Character ball = test::MakeSphereOnPlane(scene, 1e-4f);
  ball.meshes.erase(ball.meshes.begin());
  auto renderer = Renderer::Create(ball);
  ASSERT_TRUE(renderer.ok()) << renderer.status().ToString();
  const Camera camera = test::CardCamera(0.1f, kHeight);
  FloatPicture exact;
  for (const Method& method : AllMethods()) {
    const FrameRequest request = DiffusionRequest(ball, camera, kHeight, kHeight, method);
    if (exact.width == 0) {
      exact = ExactSphere(scene, camera, MakeLighting(request.settings.lights, {}));
    }
    const SkinLight light = Draw(renderer->get(), request);
    const PictureError error = Compare(light.after, exact, 0);
    EXPECT_GT(error.texels, 10000u);
    Print("sphere", method.name, error);
    EXPECT_LT(error.rmse.r, LimitsOf(method.method).sphere) << method.name;
  }
}

// A wide picture shows the same pixels as a square one, and more at its sides.
TEST_F(SubsurfaceReference, IsIndependentOfThePictureFormat) {
  constexpr int kWide = 256;
  constexpr int kTall = 144;  // 16:9
  for (const Method& method : AllMethods()) {
    const SkinLight wide = DrawCard(kBlack, kWhite, 18.0f, method, kWide, kTall);
    const SkinLight square = DrawCard(kBlack, kWhite, 18.0f, method, kTall, kTall);
    double worst = 0.0;
    for (int y = 0; y < kTall; ++y) {
      for (int x = 0; x < kTall; ++x) {
        const glm::vec4 difference =
            wide.after.At(x + (kWide - kTall) / 2, y) - square.after.At(x, y);
        for (int channel = 0; channel < 3; ++channel) {
          worst = std::max(worst, static_cast<double>(std::abs(difference[channel])));
        }
      }
    }
    EXPECT_LT(worst, 2e-3) << method.name;
  }
}

TEST_F(SubsurfaceReference, NoLightCrossesTheEdgeOfTheSkin) {
  const test::CardHalf cloth{Material::Kind::kCloth, 1.0f};
  const test::CardHalf dark_cloth{Material::Kind::kCloth, 0.0f};
  for (const Method& method : AllMethods()) {
    // Bright cloth adds no light to dark skin and takes none from bright skin.
    const SkinLight dark = DrawCard(kBlack, cloth, 100.0f, method);
    for (const glm::vec4& texel : dark.after.texels) ASSERT_LE(texel.r, 2e-4f) << method.name;
    const SkinLight bright = DrawCard(kWhite, dark_cloth, 100.0f, method);
    const float white = bright.before.At(2, kHeight / 2).r;
    for (int x = 0; x < kWidth / 2; ++x) {
      ASSERT_NEAR(bright.after.At(x, kHeight / 2).r, white, 1e-3f * white) << method.name;
    }
    for (int x = kWidth / 2; x < kWidth; ++x) {
      ASSERT_EQ(bright.after.At(x, kHeight / 2), glm::vec4(0.0f)) << method.name;
    }
  }
}

}  // namespace
}  // namespace furrow::render
