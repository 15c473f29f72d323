// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <string>

#include "render/renderer.h"
#include "test_character.h"

// Compares pictures with expected pictures. Drivers differ at edges and in the last bit of texture
// filtering, so every pixel may differ slightly, and a few may differ a lot.
namespace furrow::render::golden {

// The default of Shot.
inline constexpr auto kBlend = NormalBlend::kPartialDerivative;
// Under the default threshold of bloom only the brightest highlights glow.
inline constexpr float kGlow = 0.3f;

// One picture. `name` is the name of a file in images/ without ".png".
struct Shot {
  const char* name;
  View view;
  const char* camera;
  NormalBlend blend = kBlend;
  Shading shading = Shading::kDiffuse;
  int samples = 4;  // on every device
  float bloom_threshold = BloomSettings().threshold;
};
void PrintTo(const Shot& shot, std::ostream* out);

// A character that holds a pose while pictures are taken. Aborts if OpenGL is unavailable.
class Sitter {
 public:
  explicit Sitter(character::Character character);
  // Call Solve() on it before taking pictures.
  [[nodiscard]] test::Subject& subject() { return subject_; }
  [[nodiscard]] const character::Character& character() const { return character_; }
  [[nodiscard]] Image Draw(const Shot& shot);

 private:
  character::Character character_;
  test::Subject subject_;
  std::unique_ptr<Renderer> renderer_;
};

// Expects the picture to look like images/<name>.png. A picture that does not is written to the
// build folder. If the environment variable FURROW_UPDATE_GOLDEN is set, the picture becomes the
// expected one and the test is SKIPPED.
void ExpectLooksLike(Image drawn, const std::string& name);

}  // namespace furrow::render::golden
