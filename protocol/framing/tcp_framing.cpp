// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/tcp_framing.h"

#include <algorithm>

#include "protocol/framing/envelope.h"
#include "protocol/messages/bytes.h"

namespace furrow::protocol {

std::array<std::uint8_t, kFramePrefixBytes> FramePrefix(std::size_t message_bytes) {
  std::array<std::uint8_t, kFramePrefixBytes> prefix;
  StoreLittle(static_cast<std::uint32_t>(message_bytes), prefix.data());
  return prefix;
}

FrameReader::FrameReader(std::size_t max_frame_bytes) : max_frame_bytes_(max_frame_bytes) {}

FrameStatus FrameReader::Push(std::span<const std::uint8_t>& bytes,
                              std::span<const std::uint8_t>& frame) {
  if (bad_) return FrameStatus::kBadLength;
  if (prefix_bytes_ < kFramePrefixBytes) {
    const std::size_t take = std::min(kFramePrefixBytes - prefix_bytes_, bytes.size());
    std::copy_n(bytes.begin(), take, prefix_.begin() + static_cast<std::ptrdiff_t>(prefix_bytes_));
    bytes = bytes.subspan(take);
    prefix_bytes_ += take;
    if (prefix_bytes_ < kFramePrefixBytes) return FrameStatus::kNeedMore;
    frame_bytes_ = LoadLittle<std::uint32_t>(prefix_.data());
    frame_.clear();
    // After a bad length the stream has no boundaries any more, so the error is final.
    if (frame_bytes_ < kEnvelopeBytes || frame_bytes_ > max_frame_bytes_) {
      bad_ = true;
      return FrameStatus::kBadLength;
    }
  }
  const std::size_t take = std::min(frame_bytes_ - frame_.size(), bytes.size());
  const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(take);
  // Memory grows with the bytes that arrive, not with the length that the peer claims.
  frame_.insert(frame_.end(), bytes.begin(), end);
  bytes = bytes.subspan(take);
  if (frame_.size() < frame_bytes_) return FrameStatus::kNeedMore;
  prefix_bytes_ = 0;
  frame = frame_;
  return FrameStatus::kFrame;
}

std::vector<std::uint8_t> FrameReader::unfinished() const {
  std::vector<std::uint8_t> bytes(prefix_.begin(),
                                  prefix_.begin() + static_cast<std::ptrdiff_t>(prefix_bytes_));
  // Between two frames, frame_ still has the last one.
  if (prefix_bytes_ == kFramePrefixBytes) bytes.insert(bytes.end(), frame_.begin(), frame_.end());
  return bytes;
}

}  // namespace furrow::protocol
