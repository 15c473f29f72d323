// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/status.h"
#include "render/gl/gl_objects.h"
#include "render/request/image.h"

namespace furrow::render {

// Copies pictures from the GPU to memory through a ring of pixel buffers, each with a fence.
// Drawing the next frame does not wait for the pixels of the last one. First in, first out.
class ReadBack {
 public:
  static constexpr int kCapacity = 2;

  ReadBack() = default;
  ~ReadBack();
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;

  [[nodiscard]] int in_flight() const { return count_; }

  // Starts to copy the 8-bit RGBA colour of `framebuffer`. Precondition: in_flight() < kCapacity.
  void Start(GLuint framebuffer, int width, int height, std::uint64_t token);

  // Returns the oldest picture if its copy is complete. `wait`: blocks until it is. Rows keep the
  // order in which OpenGL stores them, from y = 0 upwards; post/composite.frag.glsl has flipped the
  // picture. kUnavailable: the driver gave up waiting because the context was lost.
  [[nodiscard]] Result<std::optional<Image>> Take(bool wait);

 private:
  struct Slot {
    gl::Buffer pixels;
    std::size_t capacity = 0;  // bytes
    GLsync fence = nullptr;
    int width = 0;
    int height = 0;
    std::uint64_t token = 0;
  };
  std::array<Slot, kCapacity> slots_;
  int oldest_ = 0;
  int count_ = 0;
};

}  // namespace furrow::render
