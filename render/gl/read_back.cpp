// SPDX-License-Identifier: Apache-2.0
#include "render/gl/read_back.h"

namespace furrow::render {
namespace {

constexpr GLuint64 kLongestWait = 60'000'000'000;  // nanoseconds; enough for 4096 x 4096 pixels on
                                                   // a busy CPU

// RGBA to RGB.
std::vector<std::uint8_t> DropAlpha(const std::uint8_t* rgba, std::size_t num_pixels) {
  std::vector<std::uint8_t> rgb(num_pixels * 3);
  std::uint8_t* out = rgb.data();
  for (std::size_t i = 0; i < num_pixels; ++i) {
    out[3 * i] = rgba[4 * i];
    out[3 * i + 1] = rgba[4 * i + 1];
    out[3 * i + 2] = rgba[4 * i + 2];
  }
  return rgb;
}

}  // namespace

ReadBack::~ReadBack() {
  for (const Slot& slot : slots_) {
    // A lost context has already freed its fences.
    if (slot.fence != nullptr && gl::HasContext()) glDeleteSync(slot.fence);
  }
}

void ReadBack::Start(GLuint framebuffer, int width, int height, const Label& label) {
  Slot& slot = slots_[static_cast<std::size_t>((oldest_ + count_) % kCapacity)];
  const std::size_t bytes = static_cast<std::size_t>(width) * height * 4;
  // Storage is immutable, so a larger picture needs a new buffer. Smaller pictures reuse it. Client
  // storage asks the driver for memory that the CPU reads fast.
  if (slot.capacity < bytes) {
    slot.pixels = gl::MakeBuffer();
    glNamedBufferStorage(slot.pixels.name(), static_cast<GLsizeiptr>(bytes), nullptr,
                         GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    slot.capacity = bytes;
  }
  slot.width = width;
  slot.height = height;
  slot.label = label;
  // With a bound pack buffer, glReadPixels() only queues the copy and returns. The last argument is
  // an offset then, not a pointer. The buffer is unbound again because other reads expect a
  // pointer.
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.pixels.name());
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  slot.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  // Submits the fence. Take() without waiting does not flush, so an unsubmitted fence would never
  // signal.
  glFlush();
  ++count_;
}

Result<std::optional<Image>> ReadBack::Take(bool wait) {
  if (count_ == 0) return std::optional<Image>();
  Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
  const GLenum state = glClientWaitSync(slot.fence, 0, wait ? kLongestWait : 0);
  if (state == GL_TIMEOUT_EXPIRED && !wait) return std::optional<Image>();
  // The slot is free from here on, whether the picture arrived or not. Otherwise a lost context
  // would block the ring forever.
  glDeleteSync(slot.fence);
  slot.fence = nullptr;
  oldest_ = (oldest_ + 1) % kCapacity;
  --count_;
  const std::size_t num_pixels = static_cast<std::size_t>(slot.width) * slot.height;
  const void* pixels = nullptr;
  if (state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) {
    pixels = glMapNamedBufferRange(slot.pixels.name(), 0, static_cast<GLsizeiptr>(num_pixels * 4),
                                   GL_MAP_READ_BIT);
  }
  if (pixels == nullptr) {
    return Status(StatusCode::kUnavailable, "the GPU did not return the picture", "read-back",
                  "create a new renderer");
  }
  Image image{slot.width, slot.height, {}, slot.label.token, slot.label.drawn_percent};
  image.rgb = DropAlpha(static_cast<const std::uint8_t*>(pixels), num_pixels);
  glUnmapNamedBuffer(slot.pixels.name());
  return std::optional<Image>(std::move(image));
}

}  // namespace furrow::render
