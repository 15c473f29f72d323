// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "base/status.h"
#include "character/character.h"
#include "render/request/camera_preset.h"
#include "render/request/frame_request.h"
#include "render/request/image.h"
#include "render/request/image_codec.h"

namespace furrow::render {

class FrameGraphObserver;  // render/graph/frame_graph.h

struct RendererOptions {
  // EGL device index, or "surfaceless". Empty: the first device that provides OpenGL 4.5.
  std::string device;
  // The most memory of the textures that one picture is drawn into, and of those that are kept for
  // the next pictures, in bytes. 0: no limit. The former pictures of streams need up to 128 MiB
  // more (Histories::kMaxBytes), on the CPU only.
  std::size_t max_texture_bytes = 0;
};

// Draws pictures of one character without a window, with one or more subjects per picture. Owns its
// EGL context, so every call must come from the thread that created the renderer, or, after
// Release(), from the next thread that uses it. Copies what it needs of the character given to
// Create().
//
// There are two ways to draw. Render() blocks until the picture is ready. Submit() and Poll() keep
// up to two pictures in flight, so that the next frame is drawn while the last one is read back.
class Renderer {
 public:
  // Errors: kUnavailable (no EGL device provides OpenGL 4.5; the message lists the devices),
  // kInternal (a shader does not compile; the message holds the driver's log), kInvalidArgument and
  // kLimit (the character's meshes or pictures). Masks and wrinkle maps whose picture is missing
  // (Character::missing_rig_pictures) are not drawn.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> Create(
      const character::Character& character, const RendererOptions& options = {});
  struct Device {
    bool is_software = false;  // the driver draws on the processor
  };
  // Looks for the device that Create() would use. Error: kUnavailable, as of Create().
  [[nodiscard]] static Result<Device> FindDevice(const std::string& device);
  virtual ~Renderer() = default;

  // Starts to draw a picture. The request's spans may be freed when the call returns. Errors:
  // kInvalidArgument and kNonFinite (`where` is the field, "others[3].model"), kLimit (more than
  // kMaxSubjects, more than the vertex buffers hold, or more than
  // RendererOptions::max_texture_bytes), kUnavailable (two pictures are in flight, the observer
  // ended the frame, or the context is lost; create a new renderer), kInternal (a shader).
  [[nodiscard]] virtual Status Submit(const FrameRequest& request) = 0;
  // Returns the oldest picture in flight if it is ready; otherwise an image of width 0. `wait`:
  // blocks until it is ready. Error: kUnavailable (the context is lost; create a new renderer).
  [[nodiscard]] virtual Result<Image> Poll(bool wait) = 0;
  // The number of pictures that were submitted and not yet returned, in [0, 2].
  [[nodiscard]] virtual int in_flight() const = 0;
  // Submits a request and waits for its picture. Discards the pictures that are still in flight.
  // Errors: those of Submit() and Poll().
  [[nodiscard]] Result<Image> Render(const FrameRequest& request);

  // The last call of this thread: another thread may use the renderer from now on.
  virtual void Release() {}

  // Calls `observer` before and after every pass of later frames, with the renderer's context
  // current (PassTimer measures times this way). The caller owns the observer, which must live
  // until it is removed with null or the renderer ends.
  virtual void SetObserver(FrameGraphObserver* observer) = 0;

  // True if the driver draws on the processor.
  [[nodiscard]] virtual bool is_software() const { return false; }
  // Vendor, renderer and version of the OpenGL context, for the log.
  [[nodiscard]] virtual std::string description() const = 0;

  // The camera of a preset for this character. kInvalidArgument: the name is not one of
  // CameraPresetNames(); the error lists them.
  [[nodiscard]] virtual Result<Camera> Preset(std::string_view name) const = 0;
};

}  // namespace furrow::render
