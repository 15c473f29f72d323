// SPDX-License-Identifier: Apache-2.0
// Surfaces moved by height maps, compared with formulas: depth, outline, seam, shadow and normals.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "render/gl/gl_objects.h"
#include "render/graph/frame_graph.h"
#include "render/mesh/displacement_patches.h"
#include "render/renderer.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kSheetPixels = 192;
constexpr int kCells = 20;  // per side of the sheet
constexpr float kTwoPi = glm::two_pi<float>();
constexpr float kNothing = 1e5f;  // metres; anything farther is background

float Waves(float u, float) { return 40.0f * std::sin(2.0f * kTwoPi * u); }  // millimetres

void SetHeights(const std::function<float(float, float)>& millimetres,
                character::Character* character) {
  constexpr int kTexels = 256;
  character::Picture picture{"heights", kTexels, kTexels, 1, {}, {}};
  for (int y = 0; y < kTexels; ++y) {
    for (int x = 0; x < kTexels; ++x) {
      picture.pixels_float.push_back(millimetres((x + 0.5f) / kTexels, (y + 0.5f) / kTexels));
    }
  }
  character->rig_pictures.emplace_back("heights", static_cast<int>(character->pictures.size()));
  character->pictures.push_back(picture);
  for (wrinkle::WrinkleMap& map : character->rig.wrinkle_maps) map.height = "heights";
}

// A square of 1 x 1 m in the plane z = 0 of kCells x kCells quads; u along +X, v along -Y. It has
// one map with the given heights and no slopes, masked everywhere, driven by the blend shape r0.
character::Character MakeSheet(const std::function<float(float, float)>& millimetres) {
  const auto flat = [](float, float) { return 0.0f; };
  character::Character sheet = test::MakePlane(4, flat, {flat});
  character::Mesh mesh;
  mesh.material = 0;
  for (int y = 0; y <= kCells; ++y) {
    for (int x = 0; x <= kCells; ++x) {
      character::Vertex vertex;
      vertex.uv = glm::vec2(x, y) / static_cast<float>(kCells);
      vertex.position = {vertex.uv.x - 0.5f, 0.5f - vertex.uv.y, 0.0f};
      mesh.vertices.push_back(vertex);
    }
  }
  for (std::uint32_t y = 0; y < kCells; ++y) {
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t a = y * (kCells + 1) + x;
      const std::uint32_t b = a + kCells + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
  sheet.meshes = {mesh};
  sheet.materials[0].double_sided = true;
  SetHeights(millimetres, &sheet);
  return sheet;
}

// The tests' egg with bit-identical positions along its seam and at its poles, as in an artist's
// mesh.
character::Character MakeEgg() {
  constexpr std::size_t kColumns = 49;
  character::Character egg = test::MakeHead();
  std::vector<character::Vertex>& vertices = egg.meshes[0].vertices;
  const auto close = [&](std::size_t vertex, std::size_t onto) {
    vertices[vertex].position = vertices[onto].position;
    vertices[vertex].normal = vertices[onto].normal;
  };
  for (std::size_t row = 0; row < vertices.size(); row += kColumns) close(row + 48, row);
  for (std::size_t i = 1; i < kColumns; ++i) {
    close(i, 0);
    close(vertices.size() - i, vertices.size() - kColumns);
  }
  return egg;
}

// Keeps the depth of the scene pass: metres along the camera's axis, rows from the bottom.
class DepthWatcher : public FrameGraphObserver {
 public:
  void BeforePass(std::string_view) override {}
  void AfterPass(std::string_view, const std::vector<Written>& written) override {
    for (const Written& target : written) {
      if (target.name != "scene depth") continue;
      depth.resize(static_cast<std::size_t>(target.desc.width) * target.desc.height);
      glGetTextureImage(target.texture, 0, GL_RED, GL_FLOAT,
                        static_cast<GLsizei>(depth.size() * sizeof(float)), depth.data());
    }
  }
  [[nodiscard]] float At(int x, int y) const {
    return depth[static_cast<std::size_t>(y * kSheetPixels + x)];
  }

  std::vector<float> depth;
};

class Displacement : public testing::Test {
 protected:
  void Make(character::Character character) {
    character_ = std::move(character);
    auto renderer = Renderer::Create(character_);
    ASSERT_TRUE(renderer.ok()) << renderer.status().ToString();
    renderer_ = std::move(*renderer);
    renderer_->SetObserver(&watcher_);
    subject_ = std::make_unique<test::Subject>(character_);
    request_.model = subject_->model;
    request_.binding = &subject_->binding;
    request_.width = request_.height = kSheetPixels;
    request_.settings.shading = Shading::kSkin;
    request_.settings.anti_aliasing.samples = 1;
    request_.settings.displacement = {.enabled = true, .edge_pixels = 2.0f, .max_level = 64};
  }
  Image Draw(const char* blend_shape, float weight) {
    subject_->Set(blend_shape, weight);
    subject_->Solve();
    request_.wrinkle_weights = subject_->weights;
    request_.filtered_values = subject_->driver_values;
    const Result<Image> image = renderer_->Render(request_);
    EXPECT_TRUE(image.ok()) << image.status().ToString();
    return image.ok() ? *image : Image();
  }
  void LookFrom(const glm::vec3& position, const glm::vec3& target, float fov) {
    request_.camera.position = position;
    request_.camera.target = target;
    request_.camera.fov_y_degrees = fov;
  }
  // Tangent of the angle between the camera's axis and the centre of a pixel.
  [[nodiscard]] float Slope(int pixel) const {
    const float half = std::tan(glm::radians(0.5f * request_.camera.fov_y_degrees));
    return (2.0f * (static_cast<float>(pixel) + 0.5f) / kSheetPixels - 1.0f) * half;
  }

  character::Character character_;
  DepthWatcher watcher_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<test::Subject> subject_;
  FrameRequest request_;
};

// Depth where a ray from (0, 0, 2) along (slope, ., -1) hits the waves.
float ExpectedDepth(float slope, float weight) {
  float depth = 2.0f;
  for (int i = 0; i < 50; ++i) {
    depth = 2.0f - 0.001f * weight * Waves(slope * depth + 0.5f, 0.0f);
  }
  return depth;
}

TEST_F(Displacement, TheSurfaceIsWhereTheHeightsSay) {
  Make(MakeSheet(Waves));
  LookFrom({0.0f, 0.0f, 2.0f}, glm::vec3(0.0f), 24.0f);
  for (const float weight : {1.0f, 0.5f, 0.0f}) {
    (void)Draw("r0", weight);
    float worst = 0.0f;
    for (int y = 20; y < kSheetPixels - 20; ++y) {
      for (int x = 20; x < kSheetPixels - 20; ++x) {
        worst = std::max(worst, std::abs(watcher_.At(x, y) - ExpectedDepth(Slope(x), weight)));
      }
    }
    EXPECT_LT(worst, 1.5e-3f) << weight;
  }
  request_.settings.displacement.strength = 0.25f;
  (void)Draw("r0", 1.0f);
  EXPECT_NEAR(watcher_.At(130, 90), ExpectedDepth(Slope(130), 0.25f), 1e-3f);
  request_.settings.displacement.enabled = false;
  (void)Draw("r0", 1.0f);
  EXPECT_NEAR(watcher_.At(130, 90), 2.0f, 1e-5f);
}

// Seen along the sheet from below, the outline has the profile of the waves.
TEST_F(Displacement, TheOutlineShowsTheFolds) {
  Make(MakeSheet(Waves));
  LookFrom({0.0f, -6.0f, 0.0f}, glm::vec3(0.0f, 0.0f, 0.0f), 8.0f);
  const auto thickness = [&](int x) {
    int pixels = 0;
    for (int y = 0; y < kSheetPixels; ++y) pixels += watcher_.At(x, y) < kNothing ? 1 : 0;
    return pixels;
  };
  request_.settings.displacement.enabled = false;
  (void)Draw("r0", 1.0f);
  for (int x = 0; x < kSheetPixels; ++x) EXPECT_LE(thickness(x), 1);
  request_.settings.displacement.enabled = true;
  (void)Draw("r0", 1.0f);
  int compared = 0;
  for (int x = 30; x < kSheetPixels - 30; ++x) {
    // The visible outline is the highest and lowest point over all rows of the sheet.
    float high = 0.0f;
    float low = 0.0f;
    for (float away = 5.55f; away < 6.46f; away += 0.05f) {
      const float slope = 0.001f * Waves(0.5f + away * Slope(x), 0.0f) / away;
      high = std::max(high, slope);
      low = std::min(low, slope);
    }
    const float pixels_per_slope = 0.5f * kSheetPixels / std::tan(glm::radians(4.0f));
    EXPECT_NEAR(thickness(x), (high - low) * pixels_per_slope, 2.0f) << x;
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

// The egg's texture ends at its back, where the heights change by 8 mm. There must be no gap.
TEST_F(Displacement, ASeamStaysClosed) {
  character::Character egg = MakeEgg();
  for (character::Picture& picture : egg.pictures) {
    if (picture.name == "masks.png") picture.pixels16.assign(picture.pixels16.size(), 65535);
  }
  SetHeights([](float u, float) { return 8.0f * u; }, &egg);
  Make(std::move(egg));
  const glm::vec3 middle(0.0f, 1.6f, 0.0f);
  for (const float degrees : {110.0f, 130.0f, 180.0f, 230.0f, 250.0f}) {
    const float angle = glm::radians(degrees);
    LookFrom(middle + glm::vec3(std::sin(angle), 0.0f, std::cos(angle)), middle, 18.0f);
    (void)Draw("l_squash", 1.0f);
    int covered = 0;
    for (int y = 0; y < kSheetPixels; ++y) {
      int first = kSheetPixels;
      int last = -1;
      int pixels = 0;
      for (int x = 0; x < kSheetPixels; ++x) {
        if (!(watcher_.At(x, y) < kNothing)) continue;
        first = std::min(first, x);
        last = x;
        ++pixels;
      }
      EXPECT_EQ(pixels, std::max(last - first + 1, 0)) << degrees << ", row " << y;
      covered += pixels;
    }
    EXPECT_GT(covered, kSheetPixels * kSheetPixels / 4);
  }
}

TEST_F(Displacement, RidgesCastShadows) {
  Make(MakeSheet([](float u, float) { return std::abs(u - 0.5f) < 0.04f ? 80.0f : 0.0f; }));
  LookFrom({0.0f, 0.0f, 2.0f}, glm::vec3(0.0f), 24.0f);
  request_.settings.view = View::kShadow;
  request_.settings.lights.preset = LightPreset::kHard;
  const auto dark = [&] {
    const Image image = Draw("r0", 1.0f);
    int pixels = 0;
    for (int y = 40; y < kSheetPixels - 40; ++y) {
      for (int x = 40; x < kSheetPixels - 40; ++x) {
        pixels += image.rgb[static_cast<std::size_t>(3 * (y * kSheetPixels + x))] < 40 ? 1 : 0;
      }
    }
    return pixels;
  };
  request_.settings.displacement.enabled = false;
  EXPECT_EQ(dark(), 0);
  request_.settings.displacement.enabled = true;
  EXPECT_GT(dark(), 500);
}

// Derivative maps tilt the normals of the undisplaced surface. Heights without slopes tilt nothing.
TEST_F(Displacement, NormalsComeFromTheDerivativeMaps) {
  Make(MakeSheet(Waves));
  LookFrom({0.0f, 0.0f, 2.0f}, glm::vec3(0.0f), 24.0f);
  request_.settings.view = View::kNormal;
  const Image moved = Draw("r0", 1.0f);
  request_.settings.displacement.enabled = false;
  const Image still = Draw("r0", 1.0f);
  for (int y = 20; y < kSheetPixels - 20; ++y) {
    for (int x = 20; x < kSheetPixels - 20; ++x) {
      const std::size_t at = static_cast<std::size_t>(3 * (y * kSheetPixels + x));
      ASSERT_TRUE(std::equal(&moved.rgb[at], &moved.rgb[at + 3], &still.rgb[at])) << x << ", " << y;
    }
  }
}

// Both sides of a seam use the UV of one side, and borders are not displaced.
TEST(DisplacementPatches, EveryEdgeAndCornerHasOneOwnerAndBordersAreNotDisplaced) {
  const character::Mesh egg = MakeEgg().meshes[0];
  const DisplacementPatches patches = MakeDisplacementPatches(egg);
  constexpr int kCorners = DisplacementPatches::kCorners;
  ASSERT_EQ(patches.indices.size(), egg.indices.size() / 3 * kCorners);
  const auto place = [&](std::uint32_t vertex) {
    const glm::vec3& p = egg.vertices[vertex].position;
    return std::array{p.x, p.y, p.z};
  };
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, std::set<std::uint32_t>> owners;  // per edge, keyed by its
                                                                      // start and end
  std::map<Place, std::set<std::uint32_t>> corners;
  int borrowed = 0;
  for (std::size_t i = 0; i < patches.indices.size(); i += kCorners) {
    const std::uint32_t* patch = &patches.indices[i];
    for (int edge = 0; edge < 3; ++edge) {
      const std::uint32_t start = patch[3 + 2 * edge];
      const std::uint32_t end = patch[4 + 2 * edge];
      ASSERT_EQ(place(start), place(patch[edge]));
      ASSERT_EQ(place(end), place(patch[(edge + 1) % 3]));
      ASSERT_EQ(place(patch[9 + edge]), place(patch[edge]));
      owners[{place(start), place(end)}].insert(start);
      owners[{place(end), place(start)}].insert(end);
      corners[place(start)].insert(patch[9 + edge]);
      borrowed += start != patch[edge] ? 1 : 0;
    }
  }
  EXPECT_GT(borrowed, 20);
  for (const auto& [edge, vertices] : owners) {
    if (edge.first != edge.second)
      EXPECT_EQ(vertices.size(), 1u);  // edges at a pole have no
                                       // length
  }
  for (const auto& [corner, vertices] : corners) EXPECT_EQ(vertices.size(), 1u);
  EXPECT_EQ(std::ranges::count(patches.shares, 0.0f), 0);
  character::Mesh open = egg;
  open.indices.resize(open.indices.size() / 2);  // the upper half, with a border
  EXPECT_EQ(std::ranges::count(MakeDisplacementPatches(open).shares, 0.0f), 49);
}

}  // namespace
}  // namespace furrow::render
