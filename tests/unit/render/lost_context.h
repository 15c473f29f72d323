// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/egl.h>

namespace furrow::render::test {

// Destroys the thread's OpenGL context, as a driver restart does.
inline void DestroyCurrentContext() {
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext context = eglGetCurrentContext();
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
}

}  // namespace furrow::render::test
