// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "render/renderer.h"
#include "rig/shapes/shape_match.h"
#include "rig/skeleton_match.h"

namespace furrow::bench {

// What moves in the pictures of a preview. All scenes play the same recording of a face.
// - kFace: the face alone.
// - kTurningFace: the head also turns 35 degrees to both sides, once in four seconds.
// - kTurningCamera: the camera also circles the head, once in eight seconds, so that the background
//   and the light move, too.
enum class Scene { kFace, kTurningFace, kTurningCamera };

[[nodiscard]] std::string NameOf(Scene scene);

// Changes a request before it is drawn; may be empty.
using Adjust = std::function<void(render::FrameRequest*)>;

// Draws pictures of the default character in a scene, with skin shading, 30 per second of the
// recording.
class SceneDrawer {
 public:
  // Errors: no data, no OpenGL.
  [[nodiscard]] static Result<std::unique_ptr<SceneDrawer>> Create();
  // The first `count` pictures of the scene.
  [[nodiscard]] Result<std::vector<render::Image>> Draw(Scene scene, int width, int height,
                                                        int count, const Adjust& adjust = {});

 private:
  SceneDrawer(character::Character character, rig::SkeletonMatcher matcher,
              rig::ShapeMatcher shapes, std::unique_ptr<render::Renderer> renderer);

  const character::Character character_;
  const rig::SkeletonMatcher matcher_;
  const rig::ShapeMatcher shapes_;
  const std::unique_ptr<render::Renderer> renderer_;
};

}  // namespace furrow::bench
