// SPDX-License-Identifier: Apache-2.0
#include "server/session/outbox.h"

#include <algorithm>
#include <utility>

namespace furrow::server {

bool Outbox::PushReply(std::span<const std::uint8_t> bytes) {
  if (replies_.size() >= max_replies_) return false;
  if (!replies_.empty() && reply_bytes_ + bytes.size() > max_reply_bytes_) return false;
  reply_bytes_ += bytes.size();
  replies_.emplace_back(bytes.begin(), bytes.end());
  return true;
}

int Outbox::PushFrame(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep) {
  const auto is_same = [key](const Frame& frame) { return frame.key == key; };
  const auto of_key = static_cast<std::size_t>(std::ranges::count_if(frames_, is_same));
  int dropped = 0;
  if (of_key > 0 && of_key >= keep) {
    const auto oldest = std::ranges::find_if(frames_, is_same);
    if (keep == 1) {
      oldest->bytes.assign(bytes.begin(), bytes.end());  // keeps its place in the line
      return 1;
    }
    frames_.erase(oldest);
    dropped = 1;
  } else if (frames_.size() >= max_frames_) {
    frames_.pop_front();
    dropped = 1;
  }
  frames_.push_back({key, {bytes.begin(), bytes.end()}});
  return dropped;
}

bool Outbox::Pop(std::vector<std::uint8_t>* out) {
  if (!replies_.empty()) {
    out->swap(replies_.front());
    replies_.pop_front();
    reply_bytes_ -= out->size();
    return true;
  }
  if (frames_.empty()) return false;
  out->swap(frames_.front().bytes);
  frames_.pop_front();
  return true;
}

void Outbox::DropFrames(std::uint64_t key) {
  std::erase_if(frames_, [key](const Frame& frame) { return frame.key == key; });
}

}  // namespace furrow::server
