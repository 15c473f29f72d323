// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/gtc/quaternion.hpp>

namespace furrow::motion {
namespace {

using wrinkle::Transform;

// Interpolates translation and scale linearly, and the rotation along the shorter arc.
Transform Mix(const Transform& a, const Transform& b, float t) {
  Transform mixed;
  mixed.translation = glm::mix(a.translation, b.translation, t);
  mixed.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, t));
  mixed.scale = glm::mix(a.scale, b.scale, t);
  return mixed;
}

}  // namespace

double MeanFrameTime(const Clip& clip) {
  return clip.num_frames() < 2 ? 0.0 : clip.duration() / (clip.num_frames() - 1);
}

bool IsEvenlySpaced(const Clip& clip) {
  const double step = MeanFrameTime(clip);
  for (std::size_t i = 0; i < clip.times.size(); ++i) {
    // 1% of a frame: recorders round their times.
    const double even = clip.times.front() + static_cast<double>(i) * step;
    if (std::abs(clip.times[i] - even) > 0.01 * step) return false;
  }
  return true;
}

Clip Resample(const Clip& clip, double rate) {
  if (clip.num_frames() < 2) return clip;
  Clip result;
  result.name = clip.name;
  result.skeleton = clip.skeleton;
  result.blend_shape_names = clip.blend_shape_names;
  const std::size_t joints = static_cast<std::size_t>(clip.skeleton.num_joints());
  const std::size_t shapes = clip.blend_shape_names.size();
  const auto count = static_cast<std::size_t>(std::lround(clip.duration() * rate)) + 1;
  std::size_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time =
        std::min(clip.times.front() + static_cast<double>(i) / rate, clip.times.back());
    // Times increase, so the search goes on from the last frame.
    while (before + 2 < clip.times.size() && clip.times[before + 1] <= time) ++before;
    const double span = clip.times[before + 1] - clip.times[before];
    const auto t = static_cast<float>((time - clip.times[before]) / span);
    for (std::size_t j = 0; j < joints; ++j) {
      result.locals.push_back(
          Mix(clip.locals[before * joints + j], clip.locals[(before + 1) * joints + j], t));
    }
    for (std::size_t s = 0; s < shapes; ++s) {
      result.blend_shapes.push_back(std::lerp(clip.blend_shapes[before * shapes + s],
                                              clip.blend_shapes[(before + 1) * shapes + s], t));
    }
    result.times.push_back(clip.times.front() + static_cast<double>(i) / rate);
  }
  return result;
}

}  // namespace furrow::motion
