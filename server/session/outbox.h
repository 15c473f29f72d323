// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace furrow::server {

// What waits for one peer's socket. Bounded: a slow peer loses old frames and slows nobody.
//
// - A reply is never dropped; when `max_replies` wait, or `max_reply_bytes` of them, the peer does
//   not read and is to be closed.
// - A frame has a key (its subscription), of which at most `keep` wait: beyond it the oldest of the
//   key goes and the newest wins. 1 for pictures; a few for weights, so that poses that came in one
//   burst are not lost to a peer that keeps up.
// - Frames of different keys together are at most `max_frames`; then the longest waiting one goes.
class Outbox {
 public:
  Outbox(std::size_t max_replies, std::size_t max_frames,
         std::size_t max_reply_bytes = std::size_t{4} << 20)
      : max_replies_(max_replies), max_frames_(max_frames), max_reply_bytes_(max_reply_bytes) {}

  // False: full, close the peer.
  [[nodiscard]] bool PushReply(std::span<const std::uint8_t> bytes);
  // The number of frames that were dropped for it: 0 or 1.
  int PushFrame(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep = 1);

  // Swaps the next bytes into `out`: replies first, in order; then the longest waiting frame.
  // False: nothing waits.
  bool Pop(std::vector<std::uint8_t>* out);

  // A subscription ended: what still waits of it is of no use.
  void DropFrames(std::uint64_t key);

  [[nodiscard]] bool empty() const { return replies_.empty() && frames_.empty(); }
  [[nodiscard]] std::size_t num_frames() const { return frames_.size(); }

 private:
  struct Frame {
    std::uint64_t key = 0;
    std::vector<std::uint8_t> bytes;
  };
  std::size_t max_replies_;
  std::size_t max_frames_;
  std::size_t max_reply_bytes_;
  std::size_t reply_bytes_ = 0;  // that wait
  std::deque<std::vector<std::uint8_t>> replies_;
  std::deque<Frame> frames_;
};

}  // namespace furrow::server
