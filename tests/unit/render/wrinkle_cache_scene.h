// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "render/graph/frame_graph.h"
#include "render/renderer.h"
#include "test_character.h"

// Shared by the tests of WrinkleCache, which compare composed wrinkles with wrinkles evaluated per
// fragment.
namespace furrow::render::test {

inline constexpr const char* kShapes[] = {"l_stretch", "l_squash", "r_stretch", "r_squash"};

// Counts how often each pass ran.
class PassCounter final : public FrameGraphObserver {
 public:
  void BeforePass(std::string_view pass) override { ++runs_[std::string(pass)]; }
  void AfterPass(std::string_view, const std::vector<Written>&) override {}
  [[nodiscard]] int Take(const std::string& pass) { return std::exchange(runs_[pass], 0); }

 private:
  std::map<std::string, int> runs_;
};

// The egg with a base normal map, and wrinkle maps with colours and cavities.
[[nodiscard]] character::Character HeadWithLooks();

[[nodiscard]] FrameRequest RequestOf(const Subject& subject, const Camera& camera, View view,
                                     int size);

struct Difference {
  double mean = 0.0;
  double share = 0.0;  // share of values that differ by more than `much`
};

template <class Value>
[[nodiscard]] Difference Compare(const std::vector<Value>& a, const std::vector<Value>& b,
                                 double much) {
  Difference difference;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double error = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    difference.mean += error / static_cast<double>(a.size());
    if (error > much) difference.share += 1.0 / static_cast<double>(a.size());
  }
  return difference;
}

[[nodiscard]] std::vector<float> Numbers(const std::vector<glm::vec4>& pixels);

class WrinkleCacheTest : public testing::Test {
 protected:
  // Draws new random weights: of all blend shapes, or of some, as in a live face.
  void Randomise(bool all) {
    std::uniform_real_distribution<float> weight(0.0f, 1.0f);
    for (const char* shape : kShapes) {
      if (all || random_() % 2 == 0) subject_.Set(shape, weight(random_));
    }
    subject_.Solve();
  }
  [[nodiscard]] Image Draw(bool cache, View view = View::kFinal) {
    FrameRequest request = RequestOf(subject_, camera_, view, 160);
    request.settings.shading = Shading::kSkin;
    request.settings.anti_aliasing.samples = 1;
    request.settings.bloom.strength = 0.0f;
    request.settings.wrinkle_maps.cache = cache;
    return Expect(renderer_->Render(request));
  }

  character::Character head_ = HeadWithLooks();
  Subject subject_{head_};
  std::unique_ptr<Renderer> renderer_ = Expect(Renderer::Create(head_));
  Camera camera_ = Expect(renderer_->Preset("face"));
  std::mt19937 random_{11};
};

}  // namespace furrow::render::test
