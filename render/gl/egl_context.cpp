// SPDX-License-Identifier: Apache-2.0
#include "render/gl/egl_context.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "base/status.h"

namespace furrow::render {
namespace {

struct Candidate {
  std::string name;
  EGLenum platform = EGL_NONE;
  void* native = nullptr;    // EGLDeviceEXT for the device platform
  bool software = false;     // known before a context exists
  bool only_if_gpu = false;  // skip it if its context draws on the CPU
};

// eglGetError() clears the error, so this must be the first EGL call after the failed one.
std::string EglError(std::string_view call) {
  std::array<char, 16> code{};
  const auto end = std::to_chars(code.data(), code.data() + code.size(), eglGetError(), 16).ptr;
  return std::string(call) + " failed, EGL error 0x" + std::string(code.data(), end);
}

// Software renderers by GL_RENDERER. A device's extensions do not tell for platforms without one,
// and a driver may run on top of a software renderer: "zink Vulkan 1.3 (llvmpipe ...)".
bool DrawsOnCpu(std::string_view renderer) {
  constexpr std::string_view kNames[] = {"llvmpipe", "softpipe", "swrast", "Software Rasterizer",
                                         "SwiftShader"};
  return std::ranges::any_of(kNames, [renderer](std::string_view name) {
    return renderer.find(name) != std::string_view::npos;
  });
}

// All devices in EGL's order; none if the driver cannot enumerate them. Client extensions are
// queried without a display.
std::vector<Candidate> EnumerateDevices() {
  std::vector<Candidate> candidates;
  // EGL_EXT_device_base is the older extension that the other two were split from.
  const bool can_enumerate =
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base") ||
      (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
       epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_query"));
  if (!can_enumerate || !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
    return candidates;
  }
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) count = 0;
  for (EGLint i = 0; i < count; ++i) {
    const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    const bool software =
        extensions != nullptr &&
        std::string_view(extensions).find("EGL_MESA_device_software") != std::string::npos;
    candidates.push_back(
        {"device " + std::to_string(i), EGL_PLATFORM_DEVICE_EXT, devices[i], software});
  }
  return candidates;
}

// The devices to try, best first; EGL's order within hardware and software devices. In a virtual
// machine or a container, a GPU may be reachable without a device, but not through its device.
std::vector<Candidate> InOrderOfPreference(std::vector<Candidate> devices, Candidate surfaceless) {
  const auto software = std::stable_partition(devices.begin(), devices.end(),
                                              [](const Candidate& c) { return !c.software; });
  const Candidate last = surfaceless;
  surfaceless.only_if_gpu = software != devices.end();
  const bool twice = surfaceless.only_if_gpu;
  devices.insert(software, std::move(surfaceless));
  if (twice) devices.push_back(last);
  return devices;
}

Result<std::vector<Candidate>> ChooseCandidates(std::string_view device) {
  const Candidate surfaceless{"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY};
  if (device == "surfaceless") return std::vector<Candidate>{surfaceless};
  std::vector<Candidate> candidates = EnumerateDevices();
  if (device.empty()) return InOrderOfPreference(std::move(candidates), surfaceless);
  std::size_t index = 0;
  const auto parsed = std::from_chars(device.data(), device.data() + device.size(), index);
  if (parsed.ec != std::errc() || parsed.ptr != device.data() + device.size() ||
      index >= candidates.size()) {
    return Status(StatusCode::kInvalidArgument,
                  "no EGL device '" + std::string(device) +
                      "'; number of devices: " + std::to_string(candidates.size()),
                  "device", "use an index from 0, \"surfaceless\", or an empty name");
  }
  return std::vector<Candidate>{candidates[index]};
}

EGLContext CreateCoreContext(EGLDisplay display, bool reset_notification) {
  const EGLint attributes[] = {
      // OpenGL 4.5 core provides direct state access, storage buffers and clip control.
      EGL_CONTEXT_MAJOR_VERSION, 4,  //
      EGL_CONTEXT_MINOR_VERSION, 5,  //
      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
      // Asks the driver to report a device reset through glGetGraphicsResetStatus() instead of
      // killing the process. The second attempt leaves this out because some drivers reject it.
      reset_notification ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY : EGL_NONE,
      EGL_LOSE_CONTEXT_ON_RESET,  //
      EGL_NONE};
  // A config describes a surface, and this context has none (EGL_KHR_no_config_context).
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
}

// An initialised display that allows contexts without config and surface. It stays initialised on
// failure; see the class comment.
Result<EGLDisplay> OpenDisplay(const Candidate& candidate) {
  // epoxy ends the process when it calls a function that no driver provides, so check first.
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    return Status(StatusCode::kUnavailable, "no EGL driver is installed");
  }
  // The platform and the device need no further display attributes.
  const EGLDisplay display =
      eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
  if (display == EGL_NO_DISPLAY) {
    return Status(StatusCode::kUnavailable, EglError("eglGetPlatformDisplay"));
  }
  if (!eglInitialize(display, nullptr, nullptr)) {
    return Status(StatusCode::kUnavailable, EglError("eglInitialize"));
  }
  for (const char* extension : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"}) {
    if (!epoxy_has_egl_extension(display, extension)) {
      return Status(StatusCode::kUnavailable, std::string("missing extension ") + extension);
    }
  }
  return display;
}

// Returns a context that is current on this thread. The bound API is state of the thread, and EGL's
// default is OpenGL ES.
Result<EGLContext> OpenContext(EGLDisplay display) {
  if (!eglBindAPI(EGL_OPENGL_API)) return Status(StatusCode::kUnavailable, EglError("eglBindAPI"));
  EGLContext context = CreateCoreContext(display, true);
  if (context == EGL_NO_CONTEXT) context = CreateCoreContext(display, false);
  if (context == EGL_NO_CONTEXT) {
    return Status(StatusCode::kUnavailable, EglError("eglCreateContext (OpenGL 4.5 core)"));
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    const Status status(StatusCode::kUnavailable, EglError("eglMakeCurrent"));
    eglDestroyContext(display, context);
    return status;
  }
  return context;
}

// Needs a current context.
std::string Text(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

std::string Describe(const Candidate& candidate) {
  return candidate.name + ": " + Text(GL_VENDOR) + ", " + Text(GL_RENDERER) + ", " +
         Text(GL_VERSION);
}

}  // namespace

Result<std::unique_ptr<EglContext>> EglContext::Create(std::string_view device) {
  Result<std::vector<Candidate>> candidates = ChooseCandidates(device);
  FURROW_RETURN_IF_ERROR(candidates);
  std::string tried;
  for (const Candidate& candidate : *candidates) {
    Status failure;
    if (const auto display = OpenDisplay(candidate); !display.ok()) {
      failure = display.status();
    } else if (const auto context = OpenContext(*display); !context.ok()) {
      failure = context.status();
    } else {
      std::unique_ptr<EglContext> result(new EglContext(*display, *context));
      result->is_software_ = candidate.software || DrawsOnCpu(Text(GL_RENDERER));
      if (candidate.only_if_gpu && result->is_software_) continue;
      result->description_ = Describe(candidate);
      if (!tried.empty()) result->description_ += "; not on " + tried;
      return result;
    }
    tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + failure.what();
  }
  return Status(StatusCode::kUnavailable, "no EGL device provides OpenGL 4.5 core; tried " + tried,
                "EGL",
                "install a driver (Debian: libgl1-mesa-dri, libegl1), or run without rendering");
}

EglContext::~EglContext() {
  // A current context would only be marked for destruction and live on.
  Release();
  eglDestroyContext(display_, context_);
}

void EglContext::Release() {
  if (eglGetCurrentContext() != context_) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

Status EglContext::MakeCurrent() {
  if (eglGetCurrentContext() != context_ &&
      !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
    Status lost(StatusCode::kUnavailable, EglError("eglMakeCurrent"), "EGL",
                "the context is lost or in use by another thread; create a new renderer");
    // No other renderer's context may stay current: the caller would use this context's object
    // names in it.
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    return lost;
  }
  // Needs a current context, so it follows eglMakeCurrent().
  if (glGetGraphicsResetStatus() != GL_NO_ERROR) {
    return {StatusCode::kUnavailable, "the OpenGL context was lost to a device reset", description_,
            "create a new renderer"};
  }
  return {};
}

}  // namespace furrow::render
