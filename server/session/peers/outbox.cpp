// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/outbox.h"

#include <algorithm>
#include <iterator>

#include "server/session/peers/peer.h"

namespace furrow::server {
namespace {

// Pictures do not come back at the same size: their memory is not kept.
constexpr std::size_t kMaxSpareBytes = 16 * 1024;
constexpr std::size_t kMaxSpare = 64;

}  // namespace

void Outbox::Append(Queue& queue, std::uint64_t key, bool is_reply,
                    std::span<const std::uint8_t> bytes) {
  if (spare_.empty()) spare_.emplace_back();
  Waiting& item = spare_.front();
  item.key = key;
  item.is_reply = is_reply;
  item.bytes.assign(bytes.begin(), bytes.end());
  queue.splice(queue.end(), spare_, spare_.begin());
}

Outbox::Queue::iterator Outbox::Recycle(Queue& queue, Queue::iterator item) {
  if (spare_.size() >= kMaxSpare || item->bytes.capacity() > kMaxSpareBytes) {
    return queue.erase(item);
  }
  const auto next = std::next(item);
  spare_.splice(spare_.begin(), queue, item);
  return next;
}

void Outbox::Uncount(const Waiting& item) {
  if (item.is_reply) {
    --num_replies_;
    reply_bytes_ -= item.bytes.size();
  } else {
    line_frame_bytes_ -= item.bytes.size();
  }
}

bool Outbox::PushReply(std::span<const std::uint8_t> bytes) {
  if (num_replies_ >= max_replies_) return false;
  if (num_replies_ > 0 && reply_bytes_ + bytes.size() > max_reply_bytes_) return false;
  ++num_replies_;
  reply_bytes_ += bytes.size();
  Append(line_, 0, true, bytes);
  return true;
}

int Outbox::PushFrame(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep) {
  if (keep == kKeepAll) {
    if (line_frame_bytes_ + bytes.size() > protocol::kMaxWaitingFrameBytes) return 1;
    line_frame_bytes_ += bytes.size();
    Append(line_, key, false, bytes);
    return 0;
  }
  const auto is_same = [key](const Waiting& frame) { return frame.key == key; };
  int dropped = 0;
  if (const auto found = of_key_.find(key); found != of_key_.end() && found->second >= keep) {
    const auto oldest = std::ranges::find_if(frames_, is_same);
    if (keep == 1) {
      oldest->bytes.assign(bytes.begin(), bytes.end());  // keeps its place in the line
      return 1;
    }
    DropFrame(oldest);
    dropped = 1;
  } else if (frames_.size() >= max_frames_) {
    DropFrame(frames_.begin());
    dropped = 1;
  }
  ++of_key_[key];
  Append(frames_, key, false, bytes);
  return dropped;
}

void Outbox::DropFrame(Queue::iterator frame) {
  --of_key_[frame->key];
  Recycle(frames_, frame);
}

bool Outbox::Pop(std::vector<std::uint8_t>* out) {
  if (empty()) return false;
  Queue& queue = line_.empty() ? frames_ : line_;
  if (&queue == &line_) {
    Uncount(line_.front());
  } else {
    --of_key_[frames_.front().key];
  }
  out->swap(queue.front().bytes);
  Recycle(queue, queue.begin());
  return true;
}

void Outbox::DropAllBehindTheLine() {
  while (!frames_.empty()) DropFrame(frames_.begin());
}

void Outbox::DropFrames(std::uint64_t key) {
  for (auto item = frames_.begin(); item != frames_.end();) {
    item = item->key == key ? Recycle(frames_, item) : std::next(item);
  }
  of_key_.erase(key);
  for (auto item = line_.begin(); item != line_.end();) {
    if (item->is_reply || item->key != key) {
      ++item;
      continue;
    }
    Uncount(*item);
    item = Recycle(line_, item);
  }
}

}  // namespace furrow::server
