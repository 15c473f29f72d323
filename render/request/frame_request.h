// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <glm/mat4x4.hpp>

#include "render/request/camera.h"
#include "render/settings/settings.h"
#include "wrinkle/solver/solver.h"

namespace furrow::render {

inline constexpr int kMaxSubjects = 256;  // of one picture, including the first
inline constexpr int kMinSize = 16;       // width and height of a picture, pixels
inline constexpr int kMaxSize = 4096;
inline constexpr float kMinScale = 0.5f;  // of a picture of a stream (FrameRequest::scale)

// One subject of a picture: the character in a pose, with wrinkles. The caller owns what spans and
// pointers refer to.
struct PosedSubject {
  // Joint matrices in model space, one per joint of the character's skeleton. Joints that blend
  // shapes move must be moved already (wrinkle::BlendShapePose).
  std::span<const glm::mat4> model;
  // Weights of the character's shapes (wrinkle::ShapeProgram): one per shape, or empty: all 0.
  // Weights outside [0, 1] are drawn, limited to [-2, 2].
  std::span<const float> shapes{};
  // The binding that computed the values below. Its rig names the regions. Null: no wrinkles.
  const wrinkle::RigBinding* binding = nullptr;
  std::span<const float> wrinkle_weights;  // one per weight of the binding, [0, 1]
  std::span<const float> filtered_values;  // one per driver value of the binding, [0, 1]
  // Maps the subject's model space to the model space that the camera and the lights use: rotation,
  // uniform scale and translation (metres).
  glm::mat4 placement{1.0f};
};

// One picture to draw. The request is itself the first subject, which the camera follows; `others`
// are drawn beside it, up to kMaxSubjects in total. Each mesh is one draw call per pass, whatever
// the number of subjects.
struct FrameRequest : PosedSubject {
  std::span<const PosedSubject> others;
  Settings settings;
  Camera camera;
  int width = 640;  // pixels, [kMinSize, kMaxSize]
  int height = 640;
  std::uint64_t token = 0;  // returned unchanged in Image::token
  // Seen in motion and compressed, so that it may differ a little from the exact picture, at most
  // by a root mean square of 1/255 on the face: coarser shadow maps (shadow.fit), hair with fewer
  // triangles, and fewer samples of the scattered light. Saves about a tenth of the work of a
  // renderer on the CPU.
  bool is_moving = false;
  // The stream of pictures of one subject and one viewer that a moving picture continues; 0: none.
  // A renderer on the CPU draws such a picture with skin shading at `scale` of its width and
  // height, and completes it from the former pictures of the stream (render/temporal/).
  std::uint64_t stream = 0;
  float scale = 1.0f;  // [kMinScale, 1]
};

}  // namespace furrow::render
