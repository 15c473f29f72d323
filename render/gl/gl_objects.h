// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include <epoxy/gl.h>

// OpenGL names with automatic deletion. Private to render/: no public header includes this file.
namespace furrow::render::gl {

// Returns true if an OpenGL context is current on this thread.
[[nodiscard]] bool HasContext();

// Owns one OpenGL name. Destroy it while its context is current. Without a current context nothing
// is deleted, because a lost context has already freed its objects.
template <class Kind>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0 && HasContext()) Kind::Destroy(name_);
  }
  [[nodiscard]] GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

struct BufferKind {
  static void Destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureKind {
  static void Destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct FramebufferKind {
  static void Destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct VertexArrayKind {
  static void Destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct ShaderKind {
  static void Destroy(GLuint name) { glDeleteShader(name); }
};
struct ProgramKind {
  static void Destroy(GLuint name) { glDeleteProgram(name); }
};

struct SamplerKind {
  static void Destroy(GLuint name) { glDeleteSamplers(1, &name); }
};

using Buffer = Object<BufferKind>;
using Texture = Object<TextureKind>;
using Framebuffer = Object<FramebufferKind>;
using VertexArray = Object<VertexArrayKind>;
using Shader = Object<ShaderKind>;
using Program = Object<ProgramKind>;
using Sampler = Object<SamplerKind>;

// Create empty objects. These functions and Upload() need a current context.
[[nodiscard]] Buffer MakeBuffer();
// Creates a buffer with a copy of `bytes` bytes at `data`, which cannot be changed later.
[[nodiscard]] Buffer MakeStaticBuffer(const void* data, std::size_t bytes);
[[nodiscard]] Texture MakeTexture(GLenum target);
[[nodiscard]] Framebuffer MakeFramebuffer();
[[nodiscard]] VertexArray MakeVertexArray();
[[nodiscard]] Sampler MakeSampler();

// Replaces a buffer's storage by a copy of `bytes` bytes at `data`. A frame in flight keeps the old
// storage, so the call does not wait for it. 0 bytes become 16 zero bytes, because a uniform block
// must have storage.
void Upload(const Buffer& buffer, const void* data, std::size_t bytes);

}  // namespace furrow::render::gl
