// SPDX-License-Identifier: Apache-2.0
#include "render/settings/view.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/joined.h"

namespace furrow::render {
namespace {

constexpr std::array<std::string_view, kNumViews> kViewNames = {
    "final",  "normal",     "mask_dynamic", "mask_texture", "weights",      "wireframe",
    "shadow", "irradiance", "scattered",    "specular",     "translucency", "albedo",
    "depth",  "material",   "occlusion",    "bloom",        "shadow_maps"};

}  // namespace

std::span<const std::string_view> ViewNames() { return kViewNames; }

std::string_view ViewName(View view) { return kViewNames[static_cast<std::size_t>(view)]; }

Result<View> ParseView(std::string_view name) {
  const auto found = std::ranges::find(kViewNames, name);
  if (found != kViewNames.end()) return static_cast<View>(found - kViewNames.begin());
  return Status(StatusCode::kInvalidArgument, "no view '" + std::string(name) + "'", "view",
                "one of " + Joined(kViewNames));
}

}  // namespace furrow::render
