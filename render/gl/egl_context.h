// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::render {

// An OpenGL 4.5 core context without a window or surface. All drawing goes to framebuffer objects.
//
// The EGL display belongs to the process and is never terminated, because eglTerminate() would also
// end every other context of the same device.
class EglContext {
 public:
  // `device` is an index into EGL's device list, "surfaceless" (Mesa's platform without a device),
  // or empty. Empty tries every GPU in EGL's order, a GPU without a device, software devices, and
  // then surfaceless.
  // Errors: kInvalidArgument (no such device), kUnavailable (the message lists each candidate and
  // why it failed).
  [[nodiscard]] static Result<std::unique_ptr<EglContext>> Create(std::string_view device);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  // Makes the context current on this thread. kUnavailable: the context was lost, for example after
  // a device reset or a driver restart. Its objects are gone, so create a new context. If the
  // context cannot be made current, no context is current afterwards.
  [[nodiscard]] Status MakeCurrent();

  // Makes no context current on this thread, if this one is. Another thread may use it then.
  void Release();

  // "device 0: Mesa, llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6". Better
  // devices that failed follow, with the reasons: "; not on device 0: eglInitialize failed, ...".
  [[nodiscard]] const std::string& description() const { return description_; }
  // True if the driver renders on the CPU.
  [[nodiscard]] bool is_software() const { return is_software_; }

 private:
  EglContext(void* display, void* context) : display_(display), context_(context) {}

  void* display_;  // EGLDisplay
  void* context_;  // EGLContext
  std::string description_;
  bool is_software_ = false;
};

}  // namespace furrow::render
