// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "character/character.h"
#include "render/renderer.h"
#include "tests/observer/fold_cases.h"
#include "tests/observer/fold_visibility.h"
#include "tests/unit/render/test_character.h"

namespace furrow::observer {

// Relative luminance of an sRGB picture (IEC 61966-2-1, Rec. 709 primaries), linear, [0, 1].
[[nodiscard]] Plane LuminanceOf(const render::Image& image);

// Takes the pictures that the observer compares: the skin pipeline with the default settings, at
// one sample per pixel on every device. Aborts if OpenGL is unavailable.
class FoldSitter {
 public:
  explicit FoldSitter(character::Character character);

  [[nodiscard]] const character::Character& character() const { return character_; }

  // Holds the case's pose for the pictures that follow. `fold_case` must outlive them.
  void Hold(const FoldCase& fold_case);

  // A square picture of `size` pixels from a camera preset. Presets from the side look from the
  // side that the case's joints are on.
  struct Shot {
    std::string camera;
    int size = 512;
  };
  // The held pose with the weights of its case, and with all weights 0. `control` is any surface
  // that is far enough from the masks of the case's regions.
  [[nodiscard]] FoldPictures Draw(const Shot& shot);
  // The luminance of the held pose with wrinkles turned off in the settings.
  [[nodiscard]] Plane DrawWithoutWrinkles(const Shot& shot);
  // Millimetres per pixel of a shot, at the distance of the camera's target.
  [[nodiscard]] double MillimetresPerPixel(const Shot& shot) const;

 private:
  [[nodiscard]] render::Camera CameraOf(const Shot& shot) const;
  [[nodiscard]] render::FrameRequest RequestOf(const Shot& shot,
                                               const std::vector<float>& weights) const;
  void DrawMasks(const Shot& shot, FoldPictures* pictures);

  character::Character character_;
  render::test::Subject subject_;
  const FoldCase* held_ = nullptr;
  std::vector<float> no_weights_;
  std::unique_ptr<render::Renderer> renderer_;
  // Draws white surfaces that every wrinkle map turns green. Its albedo is therefore a picture of
  // the masks, with the outlines and the hidden parts of the real picture.
  std::unique_ptr<render::Renderer> mask_renderer_;
};

}  // namespace furrow::observer
