// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <string>

#include "render/renderer.h"
#include "test_character.h"

// Pictures against expected pictures. Drivers differ at edges and in the last bit of a texture
// filter, so a pixel may differ by little, and few may differ by much.
namespace furrow::render::golden {

// One picture. Its name is that of a file in images/ without ".png".
struct Shot {
  const char* name;
  View view;
  const char* camera;
  NormalBlend blend = NormalBlend::kPartialDerivative;
  Shading shading = Shading::kDiffuse;
  int samples = 4;  // on every device
};
void PrintTo(const Shot& shot, std::ostream* out);

// A character that holds a pose while pictures are taken. Aborts where there is no OpenGL.
class Sitter {
 public:
  explicit Sitter(character::Character character);
  // To be solved before pictures are taken.
  [[nodiscard]] test::Subject& subject() { return subject_; }
  [[nodiscard]] const character::Character& character() const { return character_; }
  [[nodiscard]] Image Draw(const Shot& shot);

 private:
  character::Character character_;
  test::Subject subject_;
  std::unique_ptr<Renderer> renderer_;
};

// Expects the picture to look like images/<name>.png; one that does not is written to the build
// folder. With the environment variable FURROW_UPDATE_GOLDEN it is the expected one from now on,
// and the test SKIPPED.
void ExpectLooksLike(Image drawn, const std::string& name);

}  // namespace furrow::render::golden
