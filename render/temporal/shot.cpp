// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/shot.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

constexpr float kMostMove = 0.25f;  // of the distance between camera and target
constexpr float kMostZoom = 0.1f;   // of the field of view

bool MovesOn(const Camera& former, const Camera& next) {
  const float most = kMostMove * glm::distance(former.position, former.target);
  return former.fit_shorter_side == next.fit_shorter_side &&
         former.follow_joint == next.follow_joint && former.turn_joint == next.turn_joint &&
         glm::distance(former.position, next.position) <= most &&
         glm::distance(former.target, next.target) <= most &&
         std::abs(next.fov_y_degrees - former.fov_y_degrees) <= kMostZoom * former.fov_y_degrees;
}

}  // namespace

bool CanBeCompleted(const FrameRequest& request, bool is_software) {
  const Settings& settings = request.settings;
  return is_software && request.is_moving && request.others.empty() &&
         settings.view == View::kFinal && settings.shading == Shading::kSkin &&
         settings.anti_aliasing.samples == 0 && !settings.displacement.enabled &&
         settings.strip.views.empty();
}

bool IsCompleted(const FrameRequest& request, bool is_software) {
  return request.stream != 0 && request.scale < 1.0f && CanBeCompleted(request, is_software);
}

bool Continues(const Shot& former, const Shot& next) {
  return former.width == next.width && former.height == next.height &&
         former.settings == next.settings && MovesOn(former.camera, next.camera);
}

}  // namespace furrow::render
