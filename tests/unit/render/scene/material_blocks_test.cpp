// SPDX-License-Identifier: Apache-2.0
// Shapes that change materials, compared with materials that have the changed values.
#include "render/scene/material_blocks.h"

#include <cmath>
#include <memory>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/picture_difference.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

using character::Character;

constexpr int kBlockSize = 96;
enum BlockShape : std::uint32_t { kBlush, kGlow, kSlide };

// A sheet with a picture of bright columns, 8 texels of 32 each, and three shapes that move
// nothing.
Character Sheet() {
  Character sheet = test::MakeSheet(4, 4);
  sheet.pictures.push_back(test::MakePicture("columns", 32, [](float u, float) {
    return glm::vec4(glm::vec3(u < 0.5f ? 1.0f : 0.25f), 1.0f);
  }));
  character::Material& material = sheet.materials[0];
  material.base_colour = {0.5f, 0.5f, 0.5f, 1.0f};
  material.base_colour_texture = static_cast<int>(sheet.pictures.size()) - 1;
  sheet.shapes = {"blush", "glow", "slide"};
  return sheet;
}

Character SheetWithBinds() {
  Character sheet = Sheet();
  sheet.material_binds = {
      {.shape = kBlush, .material = 0, .base_colour = {0.5f, -0.25f, -0.25f, 0.0f}},
      {.shape = kGlow, .material = 0, .emission = {0.0f, 0.5f, 0.25f}},
      {.shape = kSlide, .material = 0, .uv_scale = {1.0f, 0.0f}, .uv_offset = {0.25f, 0.0f}}};
  return sheet;
}

// The sheet with the values that SheetWithBinds() should have at these weights.
Character SheetWith(const std::vector<float>& shapes) {
  const Character binds = SheetWithBinds();
  Character sheet = Sheet();
  character::Material& material = sheet.materials[0];
  const character::MaterialLook look = character::LookOf(material, binds.material_binds, shapes);
  material.base_colour = look.base_colour;
  material.emission = look.emission;
  material.texture_scale = look.texture_scale;
  material.texture_offset = look.texture_offset;
  return sheet;
}

struct DrawnSheet {
  explicit DrawnSheet(Character made)
      : character(std::move(made)),
        renderer(test::Expect(Renderer::Create(character))),
        subject(character) {
    request.model = subject.model;
    request.binding = &subject.binding;
    request.wrinkle_weights = subject.weights;
    request.filtered_values = subject.driver_values;
    request.camera = *renderer->Preset("face");
    request.width = request.height = kBlockSize;
  }
  Image Draw(const std::vector<float>& shapes) {
    request.shapes = shapes;
    return test::Expect(renderer->Render(request));
  }
  Character character;
  std::unique_ptr<Renderer> renderer;
  test::Subject subject;
  FrameRequest request;
};

// The mean of a colour channel in the middle quarter of a picture.
double Mean(const Image& image, std::size_t channel) {
  double sum = 0.0;
  int count = 0;
  for (int y = kBlockSize / 4; y < 3 * kBlockSize / 4; ++y) {
    for (int x = kBlockSize / 4; x < 3 * kBlockSize / 4; ++x) {
      sum += image.rgb[3 * static_cast<std::size_t>(y * kBlockSize + x) + channel];
      ++count;
    }
  }
  return sum / count;
}

// How a scene is drawn; each has its own shaders.
struct Way {
  const char* name;
  Shading shading;
  int samples;
};

class MaterialBlocksTest : public testing::TestWithParam<Way> {
 protected:
  void Prepare(DrawnSheet* drawn) const {
    drawn->request.settings.shading = GetParam().shading;
    drawn->request.settings.anti_aliasing.samples = GetParam().samples;
  }
};

TEST_P(MaterialBlocksTest, ShapesDrawWhatTheChangedMaterialWould) {
  DrawnSheet binds(SheetWithBinds());
  Prepare(&binds);
  for (const std::vector<float>& shapes :
       {std::vector<float>{0, 0, 0}, std::vector<float>{1, 0, 0}, std::vector<float>{0, 1, 0},
        std::vector<float>{0, 0, 1}, std::vector<float>{0.5f, 0.25f, 0.75f}}) {
    DrawnSheet expected(SheetWith(shapes));
    Prepare(&expected);
    EXPECT_LE(test::LargestDifference(binds.Draw(shapes), expected.Draw({})), 1)
        << shapes[0] << " " << shapes[1] << " " << shapes[2];
  }
}

TEST_P(MaterialBlocksTest, BlushesAndGlows) {
  DrawnSheet drawn(SheetWithBinds());
  Prepare(&drawn);
  const Image rest = drawn.Draw({0, 0, 0});
  const Image blush = drawn.Draw({1, 0, 0});
  EXPECT_GT(Mean(blush, 0), Mean(rest, 0) + 10.0);
  EXPECT_LT(Mean(blush, 1), Mean(rest, 1) - 10.0);
  const Image glow = drawn.Draw({0, 1, 0});
  EXPECT_GT(Mean(glow, 1), Mean(rest, 1) + 10.0);
  EXPECT_NEAR(Mean(glow, 0), Mean(rest, 0), 8.0) << "tone mapping mixes a little";
  EXPECT_EQ(test::LargestDifference(drawn.Draw({0, 0, 0}), rest), 0) << "and back";
}

// A crowd draws subjects of one mesh together, each with its own look.
TEST_P(MaterialBlocksTest, EachSubjectHasItsOwnLook) {
  const auto draw = [&](Character made, const std::vector<float>& first,
                        const std::vector<float>& second) {
    DrawnSheet drawn(std::move(made));
    Prepare(&drawn);
    std::vector<PosedSubject> others(2, drawn.request);
    others[0].placement = glm::translate(glm::mat4(1.0f), glm::vec3(-0.9f, 0.0f, -0.5f));
    others[1].placement = glm::translate(glm::mat4(1.0f), glm::vec3(0.9f, 0.0f, -0.5f));
    others[0].shapes = first;
    others[1].shapes = second;
    drawn.request.others = others;
    drawn.request.camera.position.z += 3.0f;
    return drawn.Draw({0, 0, 0});
  };
  const Image rest = draw(SheetWithBinds(), {0, 0, 0}, {0, 0, 0});
  const Image left = draw(SheetWithBinds(), {1, 0, 0}, {0, 0, 0});
  const Image right = draw(SheetWithBinds(), {0, 0, 0}, {1, 0, 0});
  const Image both = draw(SheetWithBinds(), {1, 0, 0}, {1, 0, 0});
  EXPECT_GT(test::LargestDifference(rest, left), 20);
  // A pixel changes with the subject that it shows.
  for (std::size_t i = 0; i < rest.rgb.size(); ++i) {
    const int change = int{left.rgb[i]} - int{rest.rgb[i]} + int{right.rgb[i]} - int{rest.rgb[i]};
    ASSERT_NEAR(int{both.rgb[i]} - int{rest.rgb[i]}, change, 6) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, MaterialBlocksTest,
                         testing::Values(Way{"plain", Shading::kDiffuse, 1},
                                         Way{"facets", Shading::kSkin, 1},
                                         Way{"samples", Shading::kSkin, 4}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(MaterialBlocks, EmissionFollowsItsTexture) {
  Character sheet = Sheet();
  sheet.materials[0].emission = glm::vec3(0.5f);
  sheet.materials[0].emission_texture = sheet.materials[0].base_colour_texture;
  Character dark = sheet;
  dark.materials[0].emission = glm::vec3(0.0f);
  DrawnSheet with(sheet);
  DrawnSheet without(dark);
  const Image glows = with.Draw({});
  const Image rests = without.Draw({});
  // Bright columns glow more than dark ones.
  const auto gain = [&](int x) {
    const std::size_t i = 3 * static_cast<std::size_t>(kBlockSize / 2 * kBlockSize + x);
    return int{glows.rgb[i]} - int{rests.rgb[i]};
  };
  EXPECT_GT(gain(kBlockSize * 3 / 8), gain(kBlockSize * 5 / 8));
  EXPECT_GT(gain(kBlockSize * 3 / 8), 10);
}

TEST(MaterialBlocks, BindsOfWhatDoesNotExistAreRefused) {
  for (const character::MaterialBind& bind : {character::MaterialBind{.shape = 9, .material = 0},
                                              character::MaterialBind{.shape = 0, .material = 9}}) {
    Character sheet = Sheet();
    sheet.material_binds = {bind};
    EXPECT_EQ(Renderer::Create(sheet).status().code(), StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace furrow::render
