// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/status.h"
#include "render/gl/gl_objects.h"
#include "render/request/image.h"

namespace furrow::render {

// Copies pictures from the GPU to memory through a ring of pixel buffers, each with a fence, so
// that drawing the next frame does not wait for the pixels of the last one. Needs a current
// context.
class ReadBack {
 public:
  static constexpr int kCapacity = 2;  // one picture is read while the next one is drawn

  ReadBack() = default;
  ~ReadBack();
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;

  [[nodiscard]] int in_flight() const { return count_; }

  // What the image states besides its pixels.
  struct Label {
    std::uint64_t token = 0;
    int drawn_percent = 100;
  };
  // Starts to copy the 8-bit RGBA colour of `framebuffer`, `width` x `height` pixels. Precondition:
  // in_flight() < kCapacity.
  void Start(GLuint framebuffer, int width, int height, const Label& label);

  // Returns the oldest picture in flight, without alpha, and ends its flight. nullopt if there is
  // none, or if its copy is not complete; `wait` blocks until it is. Row 0 of the framebuffer,
  // where composite.frag.glsl puts the top of the picture, comes first. Error: kUnavailable (the
  // context was lost); the picture is then discarded.
  [[nodiscard]] Result<std::optional<Image>> Take(bool wait);

 private:
  struct Slot {
    gl::Buffer pixels;
    std::size_t capacity = 0;  // bytes
    GLsync fence = nullptr;
    int width = 0;
    int height = 0;
    Label label;
  };
  std::array<Slot, kCapacity> slots_;
  int oldest_ = 0;
  int count_ = 0;
};

}  // namespace furrow::render
