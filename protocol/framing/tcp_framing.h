// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace furrow::protocol {

// On TCP the length in bytes, u32 little-endian, precedes every message.
inline constexpr std::size_t kFramePrefixBytes = 4;

[[nodiscard]] std::array<std::uint8_t, kFramePrefixBytes> FramePrefix(std::size_t message_bytes);

enum class FrameStatus : std::uint8_t {
  kNeedMore = 0,  // all bytes were consumed; the frame is incomplete
  kFrame,         // `frame` is complete; bytes may be left
  kBadLength,     // shorter than an envelope or above the limit: close the connection
};

// Splits a byte stream into frames. Memory grows with the bytes received, not with the claimed
// length, and never exceeds `max_frame_bytes`.
//
//   while (!bytes.empty()) switch (reader.Push(bytes, frame)) { ... }
class FrameReader {
 public:
  explicit FrameReader(std::size_t max_frame_bytes);

  // Consumes `bytes` from the front until a frame is complete or no bytes are left. `frame` is
  // 8-byte aligned and valid until the next call. After kBadLength all calls return kBadLength.
  [[nodiscard]] FrameStatus Push(std::span<const std::uint8_t>& bytes,
                                 std::span<const std::uint8_t>& frame);

 private:
  std::size_t max_frame_bytes_;
  std::array<std::uint8_t, kFramePrefixBytes> prefix_{};
  std::size_t prefix_bytes_ = 0;
  std::size_t frame_bytes_ = 0;
  std::vector<std::uint8_t> frame_;
  bool bad_ = false;
};

}  // namespace furrow::protocol
