// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "base/status.h"

namespace furrow::render {

// What a picture shows: the finished picture, data of the surface, or the target of one stage of
// the pipeline. The skin pipeline draws kShadow and everything after it, whatever Settings::shading
// says.
enum class View {
  kFinal,
  kNormal,       // 0.5 n + 0.5 in red, green and blue
  kMaskDynamic,  // masks by skin weight, in the colours of the wrinkle maps
  kMaskTexture,  // painted masks, in one colour per region
  kWeights,      // wrinkle weight times mask, in the colours of the wrinkle maps
  kWireframe,
  kShadow,        // light that reaches the surface: the three lights in red, green and blue
  kIrradiance,    // diffuse light on skin before scattering, times albedo^mix
  kScattered,     // the same after scattering
  kSpecular,      // specular light only
  kTranslucency,  // light through thin parts only
  kAlbedo,
  kDepth,      // linear, white (near) to black over the picture's width, the target in the middle
  kMaterial,   // skin red, cloth blue, eyes white, hair green, others grey
  kOcclusion,  // white: open, black: fully occluded
  kBloom,
  kShadowMaps,  // the lamps' depth maps side by side: white is near, black is empty
};
inline constexpr int kNumViews = 17;

// All names in the order of View: "final", "normal", "mask_dynamic", ...
[[nodiscard]] std::span<const std::string_view> ViewNames();
[[nodiscard]] std::string_view ViewName(View view);
// kInvalidArgument: unknown name; the error lists the valid ones.
[[nodiscard]] Result<View> ParseView(std::string_view name);

}  // namespace furrow::render
