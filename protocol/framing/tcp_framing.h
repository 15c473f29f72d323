// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace furrow::protocol {

// On TCP, a frame is a message after its length in bytes (u32, little-endian). The length does not
// count itself.
inline constexpr std::size_t kFramePrefixBytes = 4;

// The name of this protocol in TLS (ALPN), as TLS sends it: with its length in front.
inline constexpr std::string_view kTlsProtocols =
    "\x08"
    "furrow/1";

// The length prefix of a message of `message_bytes`, envelope included.
[[nodiscard]] std::array<std::uint8_t, kFramePrefixBytes> FramePrefix(std::size_t message_bytes);

enum class FrameStatus : std::uint8_t {
  kNeedMore = 0,  // all bytes were consumed; the frame is incomplete
  kFrame,         // `frame` is complete; bytes may be left
  kBadLength,     // shorter than an envelope or above the limit: close the connection
};

// Splits a byte stream into the messages of its frames. Memory grows with the bytes received, not
// with the stated length. A message has at most `max_frame_bytes`.
//
//   while (!bytes.empty()) switch (reader.Push(bytes, frame)) { ... }
class FrameReader {
 public:
  explicit FrameReader(std::size_t max_frame_bytes);

  // Changes the limit, for frames whose length has not been read yet.
  void SetMaxFrameBytes(std::size_t bytes) { max_frame_bytes_ = bytes; }

  // Removes bytes from the front of `bytes` until a frame is complete or no bytes are left. On
  // kFrame, `frame` is the message without its length: 8-byte aligned, valid until the next call.
  // Otherwise `frame` is unchanged. After kBadLength all calls return kBadLength.
  [[nodiscard]] FrameStatus Push(std::span<const std::uint8_t>& bytes,
                                 std::span<const std::uint8_t>& frame);

  // The bytes of the frame that is not complete yet, its length included. Another reader that gets
  // them goes on in this one's place.
  [[nodiscard]] std::vector<std::uint8_t> unfinished() const;

 private:
  std::size_t max_frame_bytes_;
  std::array<std::uint8_t, kFramePrefixBytes> prefix_{};
  std::size_t prefix_bytes_ = 0;
  std::size_t frame_bytes_ = 0;
  std::vector<std::uint8_t> frame_;
  bool bad_ = false;
};

}  // namespace furrow::protocol
