// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::render {

// An OpenGL 4.5 core context with no window and no surface:
// all drawing goes to framebuffer objects.
//
// The EGL display it sits on belongs to the process and is never terminated: eglTerminate() would
// take it from every other context of the same device.
class EglContext {
 public:
  // `device`: an index into EGL's device list, "surfaceless" (Mesa's platform without a device), or
  // empty: every device in EGL's order, those that render in software last, then surfaceless.
  // Errors: kInvalidArgument (not such a name), kUnavailable (lists each candidate and why it
  // failed).
  [[nodiscard]] static Result<std::unique_ptr<EglContext>> Create(std::string_view device);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  // Binds the context to this thread, if it is not. kUnavailable when the context was lost (a reset
  // of the device, a driver's restart): nothing in it can be saved; make a new one. Where it cannot
  // be bound, no context is current afterwards.
  [[nodiscard]] Status MakeCurrent();

  // "device 0: Mesa, llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
  [[nodiscard]] const std::string& description() const { return description_; }
  // Whether a processor draws.
  [[nodiscard]] bool is_software() const { return is_software_; }

 private:
  EglContext(void* display, void* context) : display_(display), context_(context) {}

  void* display_;  // EGLDisplay
  void* context_;  // EGLContext
  std::string description_;
  bool is_software_ = false;
};

}  // namespace furrow::render
