// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <unordered_map>
#include <vector>

#include "protocol/messages/limits.h"

namespace furrow::server {

// What waits for one peer's socket. Bounded: a slow peer loses old frames and slows nobody.
//
// - A reply is never dropped; when `max_replies` wait, or `max_reply_bytes` of them, the peer does
//   not read and is to be closed.
// - A frame has a key (its subscription), of which at most `keep` wait: beyond it the oldest of the
//   key goes and the newest wins. 1 for pictures; a few for weights, so that poses that came in one
//   burst are not lost to a peer that keeps up.
// - Frames of different keys together are at most `max_frames`; then the longest waiting one goes.
// - A frame with kKeepAll stands in line with the replies, so that nothing overtakes anything. Of
//   those at most kMaxWaitingFrameBytes wait; what comes then is left out.
// - The memory of what was sent serves what comes next: nothing is allocated in the long run.
class Outbox {
 public:
  Outbox(std::size_t max_replies, std::size_t max_frames,
         std::size_t max_reply_bytes = std::size_t{4} << 20)
      : max_replies_(max_replies), max_frames_(max_frames), max_reply_bytes_(max_reply_bytes) {}

  // False: full, close the peer.
  [[nodiscard]] bool PushReply(std::span<const std::uint8_t> bytes);
  // The number of frames that were dropped, of this key or another or the new one: 0 or 1.
  int PushFrame(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep = 1);

  // Swaps the next bytes into `out`: the line of replies first, in order; then the longest waiting
  // frame. False: nothing waits.
  bool Pop(std::vector<std::uint8_t>* out);

  // A subscription ended: what still waits of it is of no use.
  void DropFrames(std::uint64_t key);
  // The peer is leaving: nothing goes out behind the line, its goodbye.
  void DropAllBehindTheLine();

  [[nodiscard]] bool empty() const { return line_.empty() && frames_.empty(); }
  [[nodiscard]] std::size_t num_frames() const { return frames_.size(); }

 private:
  struct Waiting {
    std::uint64_t key = 0;
    bool is_reply = false;
    std::vector<std::uint8_t> bytes;
  };
  using Queue = std::list<Waiting>;

  void Append(Queue& queue, std::uint64_t key, bool is_reply, std::span<const std::uint8_t> bytes);
  // Out of `queue`, its memory for the next one.
  Queue::iterator Recycle(Queue& queue, Queue::iterator item);
  void Uncount(const Waiting& item);
  void DropFrame(Queue::iterator frame);

  std::size_t max_replies_;
  std::size_t max_frames_;
  std::size_t max_reply_bytes_;
  std::size_t num_replies_ = 0;  // that wait
  std::size_t reply_bytes_ = 0;
  std::size_t line_frame_bytes_ = 0;  // of frames that stand in line
  Queue line_;                        // replies, and frames that are all kept
  Queue frames_;
  std::unordered_map<std::uint64_t, std::size_t> of_key_;  // in frames_
  Queue spare_;
};

}  // namespace furrow::server
