// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/request/frame_request.h"

namespace furrow::render {

// True if the picture may belong to a stream, whatever its scale. Others stand alone: stills, views
// of data, diffuse shading, several subjects, displaced surfaces, strips, settings with a number of
// samples, and all pictures of a GPU.
[[nodiscard]] bool CanBeCompleted(const FrameRequest& request, bool is_software);

// True if the picture belongs to a stream, and is drawn with fewer pixels and completed from former
// ones. At the full size that would cost a fifth more, and errors would be larger in motion.
[[nodiscard]] bool IsCompleted(const FrameRequest& request, bool is_software);

// What the pictures of a stream have in common.
struct Shot {
  int width = 0;  // pixels
  int height = 0;
  Settings settings;
  Camera camera;
};

[[nodiscard]] inline Shot ShotOf(const FrameRequest& request) {
  return {request.width, request.height, request.settings, request.camera};
}

// True if a picture of `next` may continue one of `former`: nothing differs except the camera,
// which has moved less than a quarter of its distance to the target, or zoomed by less than a
// tenth. A jump of the camera is a cut, and so is any change of size or settings.
[[nodiscard]] bool Continues(const Shot& former, const Shot& next);

}  // namespace furrow::render
