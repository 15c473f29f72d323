// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_sitter.h"

#include <algorithm>
#include <array>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/srgb.h"

namespace furrow::observer {
namespace {

using character::Character;
using character::Material;

constexpr char kMaskColour[] = "observer_mask_colour";
constexpr float kLeastRegionHeight = 0.5f;  // of a region, where its folds have half their height
constexpr float kLeastAlbedo = 1e-3f;       // linear; the background of data views is black

float LinearOf(std::uint8_t value) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = LinearFromSrgb(static_cast<float>(i) / 255.0f);
    }
    return values;
  }();
  return table[value];
}

// Calls `function(red, green, blue)`, linear, for every pixel.
template <class Function>
Plane Mapped(const render::Image& image, const Function& function) {
  Plane plane{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    plane.values.push_back(
        function(LinearOf(image.rgb[i]), LinearOf(image.rgb[i + 1]), LinearOf(image.rgb[i + 2])));
  }
  return plane;
}

// The largest value within `reach` pixels of each pixel along x, as the transpose.
Plane WidenedTranspose(const Plane& plane, int reach) {
  Plane out{plane.height, plane.width, {}};
  for (int x = 0; x < plane.width; ++x) {
    const int first = std::max(0, x - reach);
    const int count = std::min(plane.width - 1, x + reach) - first + 1;
    for (int y = 0; y < plane.height; ++y) {
      const float* const row = &plane.values[static_cast<std::size_t>(y * plane.width + first)];
      out.values.push_back(*std::max_element(row, row + count));
    }
  }
  return out;
}

Plane Widened(const Plane& plane, int reach) {
  return WidenedTranspose(WidenedTranspose(plane, reach), reach);
}

// The character of FoldSitter::mask_renderer_. Cut-out surfaces (hair) keep their textures.
Character MaskCharacterOf(const Character& character) {
  Character mask = character;
  for (Material& material : mask.materials) {
    if (material.alpha_cutoff > 0.0f) continue;
    material.base_colour = glm::vec4(1.0f);
    material.base_colour_texture = -1;
  }
  mask.rig_pictures.emplace_back(kMaskColour, static_cast<int>(mask.pictures.size()));
  character::Picture green{.name = kMaskColour, .width = 1, .height = 1, .channels = 3};
  green.pixels = {0, 255, 0};
  mask.pictures.push_back(std::move(green));
  for (wrinkle::WrinkleMap& map : mask.rig.wrinkle_maps) {
    map.colour = kMaskColour;
    map.colour_scale = 1.0f;
  }
  return mask;
}

// Nothing but the albedo counts, so everything that takes time is off.
render::Settings MaskSettings() {
  render::Settings settings;
  settings.view = render::View::kAlbedo;
  settings.shading = render::Shading::kSkin;
  settings.shadow.lamps = 0;
  settings.shadow.filter = render::ShadowFilter::kOff;
  settings.occlusion.method = render::OcclusionMethod::kOff;
  settings.subsurface.method = render::SubsurfaceMethod::kOff;
  settings.anti_aliasing.samples = 1;
  return settings;
}

}  // namespace

Plane LuminanceOf(const render::Image& image) {
  return Mapped(image,
                [](float r, float g, float b) { return 0.2126f * r + 0.7152f * g + 0.0722f * b; });
}

FoldSitter::FoldSitter(Character character)
    : character_(std::move(character)),
      subject_(character_),
      no_weights_(subject_.weights.size()),
      renderer_(render::test::Expect(render::Renderer::Create(character_))),
      mask_renderer_(render::test::Expect(render::Renderer::Create(MaskCharacterOf(character_)))) {}

void FoldSitter::Hold(const FoldCase& fold_case) {
  held_ = &fold_case;
  subject_.pose.joints = fold_case.pose.joints;
  subject_.Solve();
}

render::Camera FoldSitter::CameraOf(const Shot& shot) const {
  render::Camera camera = render::test::Expect(renderer_->Preset(shot.camera));
  // Presets look from the subject's left.
  if (held_->side < 0) camera.position.x = 2.0f * camera.target.x - camera.position.x;
  return camera;
}

render::FrameRequest FoldSitter::RequestOf(const Shot& shot,
                                           const std::vector<float>& weights) const {
  render::FrameRequest request;
  request.model = subject_.model;
  request.shapes = held_->shapes;
  request.binding = &subject_.binding;
  request.wrinkle_weights = weights;
  request.filtered_values = subject_.driver_values;
  request.settings.shading = render::Shading::kSkin;
  request.settings.anti_aliasing.samples = 1;
  request.camera = CameraOf(shot);
  request.width = request.height = shot.size;
  return request;
}

double FoldSitter::MillimetresPerPixel(const Shot& shot) const {
  const render::Camera camera = CameraOf(shot);
  const double distance = glm::distance(camera.position, camera.target);
  const double half = std::tan(0.5 * glm::radians(double{camera.fov_y_degrees}));
  return 1000.0 * 2.0 * half * distance / shot.size;
}

void FoldSitter::DrawMasks(const Shot& shot, FoldPictures* pictures) {
  // One map per region shows the region's mask.
  std::vector<float> weights = no_weights_;
  std::size_t first = 0;
  for (std::size_t region = 0; region < character_.rig.regions.size(); ++region) {
    if (std::ranges::count(held_->regions, region) > 0) weights[first] = 1.0f;
    first += character_.rig.regions[region].feeds.size();
  }
  render::FrameRequest request = RequestOf(shot, weights);
  request.settings = MaskSettings();
  const render::Image image = render::test::Expect(mask_renderer_->Render(request));
  pictures->region = Mapped(image, [](float r, float g, float) {
    return g > kLeastAlbedo && r / g <= 1.0f - kLeastRegionHeight ? 1.0f : 0.0f;
  });
  pictures->subject =
      Mapped(image, [](float, float g, float) { return g > kLeastAlbedo ? 1.0f : 0.0f; });
  const Plane folded = Widened(
      Mapped(image,
             [](float r, float g, float) { return g > kLeastAlbedo && r < g ? 1.0f : 0.0f; }),
      kFoldReach);
  pictures->control = pictures->subject;
  for (std::size_t i = 0; i < folded.values.size(); ++i) {
    if (folded.values[i] > 0.0f) pictures->control.values[i] = 0.0f;
  }
}

FoldPictures FoldSitter::Draw(const Shot& shot) {
  FoldPictures pictures;
  const auto draw = [&](const std::vector<float>& weights) {
    return LuminanceOf(render::test::Expect(renderer_->Render(RequestOf(shot, weights))));
  };
  pictures.on = draw(held_->wrinkle_weights);
  pictures.off = draw(no_weights_);
  DrawMasks(shot, &pictures);
  return pictures;
}

Plane FoldSitter::DrawWithoutWrinkles(const Shot& shot) {
  render::FrameRequest request = RequestOf(shot, no_weights_);
  request.settings.wrinkles = false;
  return LuminanceOf(render::test::Expect(renderer_->Render(request)));
}

}  // namespace furrow::observer
