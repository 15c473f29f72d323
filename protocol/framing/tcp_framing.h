// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace furrow::protocol {

// On TCP every message follows its length in bytes, u32 little-endian.
inline constexpr std::size_t kFramePrefixBytes = 4;

[[nodiscard]] std::array<std::uint8_t, kFramePrefixBytes> FramePrefix(std::size_t message_bytes);

enum class FrameStatus : std::uint8_t {
  kNeedMore = 0,  // all bytes were taken; no frame yet
  kFrame,         // `frame` is whole; there may be bytes left
  kBadLength,     // shorter than an envelope or above the cap: close the connection
};

// Cuts a byte stream into frames. Memory grows with the bytes that came, never with a claimed
// length, and is at most the cap.
//
//   while (!bytes.empty()) switch (reader.Push(bytes, frame)) { ... }
class FrameReader {
 public:
  explicit FrameReader(std::size_t max_frame_bytes);

  // Takes from the front of `bytes` until a frame is whole or nothing is left. `frame` is valid
  // until the next call and 8-byte aligned. After kBadLength every call says so.
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
