// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/egl.h>

namespace furrow::render::test {

// Takes the thread's OpenGL context away for good, as a driver's restart does.
inline void DestroyCurrentContext() {
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext context = eglGetCurrentContext();
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
}

}  // namespace furrow::render::test
