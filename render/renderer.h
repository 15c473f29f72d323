// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"
#include "character/character.h"
#include "render/settings/settings.h"
#include "wrinkle/solver/solver.h"

namespace furrow::render {

enum class ImageFormat { kJpeg, kPng };

// Where the camera stands: metres, model space of the character's rest pose, degrees.
struct Camera {
  glm::vec3 position{0.0f, 1.6f, 0.8f};
  glm::vec3 target{0.0f, 1.6f, 0.0f};
  float fov_y_degrees = 24.0f;  // [1, 150]
  // The angle counts across where the picture is higher than wide, so that a portrait format cuts
  // no ears off. Presets do.
  bool fit_shorter_side = false;
  // Carries the camera (and the lights, which stand around it) with the subject: to where this
  // joint of the character went from its rest pose, turned about +Y as its root turned. -1: stands
  // still.
  int follow_joint = -1;
};

inline constexpr int kMaxSubjects = 256;  // of one picture

// One who is drawn: the character in a pose, with wrinkles of its own.
struct PosedSubject {
  // In the character's skeleton, model space; num_joints long. What blend shapes move is moved
  // already (wrinkle::BlendShapePose).
  std::span<const glm::mat4> model;
  // The binding whose values these are (its rig names the regions), weights, and filtered values.
  const wrinkle::RigBinding* binding = nullptr;  // null: no wrinkles
  std::span<const float> wrinkle_weights;
  std::span<const float> filtered_values;
  // Takes model space to where the subject stands in the picture: rotation, uniform scale,
  // translation in metres.
  glm::mat4 placement{1.0f};
};

// The subject that it is itself, whom the camera follows, and `others` beside it: kMaxSubjects in
// all. However many they are, each mesh is one draw call in every pass.
struct FrameRequest : PosedSubject {
  std::span<const PosedSubject> others;
  Settings settings;
  Camera camera;
  int width = 640;  // [16, 4096]
  int height = 640;
  std::uint64_t token = 0;  // comes back with the picture
};

// 8-bit sRGB RGB, rows from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::uint64_t token = 0;
};

class FrameGraphObserver;  // render/graph/frame_graph.h

struct RendererOptions {
  std::string device;  // EGL device index, "surfaceless", or empty: the first that gives GL 4.5
};

// Draws one character, once or many times in a picture, headless. Owns its EGL context: one thread,
// the one that created it. Keeps nothing of the character given to Create().
//
// Two ways to a picture: Render() waits; Submit() then Poll() keeps up to two read-backs in flight.
class Renderer {
 public:
  // Errors: kUnavailable (no EGL device gives OpenGL 4.5: says which were tried), kInternal (a
  // shader does not compile here: the driver's log), kInvalidArgument and kLimit (the character's
  // meshes and pictures). A mask or wrinkle map whose picture nobody has is not drawn
  // (Character::missing_rig_pictures).
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> Create(
      const character::Character& character, const RendererOptions& options = {});
  virtual ~Renderer() = default;

  // Draws; what the request points at may go when it returns. Errors: kInvalidArgument and
  // kNonFinite (`where` is the field, "others[3].model"), kLimit (more subjects than kMaxSubjects,
  // or than memory is set aside for), kUnavailable (two in flight, or the context was lost: create
  // anew), kInternal (a shader).
  [[nodiscard]] virtual Status Submit(const FrameRequest& request) = 0;
  // The oldest picture that is ready; `wait`: blocks for it. An image of width 0: none yet.
  [[nodiscard]] virtual Result<Image> Poll(bool wait) = 0;
  [[nodiscard]] virtual int in_flight() const = 0;
  // Submit and wait. Pictures still in flight are dropped.
  [[nodiscard]] Result<Image> Render(const FrameRequest& request);

  // Told of every pass of the frames submitted from now on (render/gl/pass_timer.h times them),
  // with the renderer's context current; null: nobody. Outlives the renderer or is taken back.
  virtual void SetObserver(FrameGraphObserver* observer) = 0;

  // Vendor, renderer and version of the context, for the log.
  [[nodiscard]] virtual std::string description() const = 0;

  // A camera preset for this character, one of CameraPresetNames(); the error lists them. Works for
  // any character: from its bounds and its anchor joint.
  [[nodiscard]] virtual Result<Camera> Preset(std::string_view name) const = 0;
};

// face, three_quarter, profile (from the subject's left), eyes, mouth; body, body_three_quarter,
// body_side (from the subject's left) and body_back.
[[nodiscard]] std::span<const std::string_view> CameraPresetNames();
[[nodiscard]] std::string ListCameraPresets();  // "face, three_quarter, ...": for help texts

// `quality` in [1, 100], for JPEG alone (TurboJPEG, 4:2:0 below 90, 4:4:4 from there).
[[nodiscard]] Result<std::vector<std::uint8_t>> EncodeImage(const Image& image, ImageFormat format,
                                                            int quality = 85);

}  // namespace furrow::render
