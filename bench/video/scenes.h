// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/status.h"
#include "render/request/image.h"

namespace furrow::bench {

// What moves in the pictures of a preview. All scenes play the same recording of a face.
// - kFace: the face alone.
// - kTurningFace: the head also turns 35 degrees to both sides, once in four seconds.
// - kTurningCamera: the camera also circles the head, once in eight seconds, so that the background
//   and the light move, too.
enum class Scene { kFace, kTurningFace, kTurningCamera };

[[nodiscard]] std::string NameOf(Scene scene);

// Draws `count` pictures of the default character with skin shading, 30 per second of the
// recording, as the daemon draws moving pictures. Errors: no data, no OpenGL.
[[nodiscard]] Result<std::vector<render::Image>> DrawScene(Scene scene, int width, int height,
                                                           int count);

}  // namespace furrow::bench
