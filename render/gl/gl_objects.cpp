// SPDX-License-Identifier: Apache-2.0
#include "render/gl/gl_objects.h"

#include <epoxy/egl.h>

namespace furrow::render::gl {
namespace {

// Contents of empty buffers: OpenGL rejects immutable storage of 0 bytes, and a shader block needs
// storage behind it even if the shader never reads it.
constexpr float kZeros[4] = {0.0f, 0.0f, 0.0f, 0.0f};

}  // namespace

bool HasContext() { return eglGetCurrentContext() != EGL_NO_CONTEXT; }

Buffer MakeBuffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return Buffer(name);
}

Buffer MakeStaticBuffer(const void* data, std::size_t bytes) {
  Buffer buffer = MakeBuffer();
  const bool empty = bytes == 0;
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(empty ? sizeof(kZeros) : bytes),
                       empty ? kZeros : data, 0);
  return buffer;
}

Texture MakeTexture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return Texture(name);
}

Framebuffer MakeFramebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return Framebuffer(name);
}

VertexArray MakeVertexArray() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

Sampler MakeSampler() {
  GLuint name = 0;
  glCreateSamplers(1, &name);
  return Sampler(name);
}

void Upload(const Buffer& buffer, const void* data, std::size_t bytes) {
  const bool empty = bytes == 0;
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(empty ? sizeof(kZeros) : bytes),
                    empty ? kZeros : data, GL_STREAM_DRAW);
}

}  // namespace furrow::render::gl
