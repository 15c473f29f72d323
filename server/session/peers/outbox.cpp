// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/outbox.h"

#include <algorithm>
#include <iterator>

#include "server/session/peers/peer.h"

namespace furrow::server {
namespace {

// Pictures vary in size, so the memory of large messages is not kept.
constexpr std::size_t kMaxSpareBuffer = 16 * 1024;
constexpr std::size_t kMaxSpareBuffers = 64;

std::size_t LargePart(std::size_t frame_bytes) {
  return frame_bytes > Outbox::kSmallFrame ? frame_bytes : 0;
}

}  // namespace

std::size_t Outbox::Counted() const {
  return reply_bytes_ - std::min(reply_bytes_, kFreeReplies) + large_frame_bytes_ +
         ordered_frame_bytes_ + popped_bytes_;
}

void Outbox::CountFrame(std::size_t bytes) {
  frame_bytes_ += bytes;
  large_frame_bytes_ += LargePart(bytes);
}

void Outbox::UncountFrame(std::size_t bytes) {
  frame_bytes_ -= bytes;
  large_frame_bytes_ -= LargePart(bytes);
}

int Outbox::NoRoom() {
  Settle();
  account_->CountRefusal();
  return Link::kNoRoom;
}

void Outbox::Append(Queue& queue, std::uint64_t key, bool is_reply,
                    std::span<const std::uint8_t> bytes) {
  if (spare_.empty()) spare_.emplace_back();
  // splice() moves the list node itself, so a steady stream allocates neither nodes nor bytes.
  Item& item = spare_.front();
  const std::size_t capacity = item.bytes.capacity();
  item.key = key;
  item.is_reply = is_reply;
  item.bytes.assign(bytes.begin(), bytes.end());
  spare_bytes_ -= capacity;  // if memory is short, the item has stayed
  queue.splice(queue.end(), spare_, spare_.begin());
}

Outbox::Queue::iterator Outbox::Recycle(Queue& queue, Queue::iterator item) {
  const std::size_t capacity = item->bytes.capacity();
  if (spare_.size() >= kMaxSpareBuffers || capacity > kMaxSpareBuffer ||
      spare_bytes_ + capacity > kMaxSpareBytes) {
    return queue.erase(item);
  }
  spare_bytes_ += capacity;
  const auto next = std::next(item);
  spare_.splice(spare_.begin(), queue, item);
  return next;
}

void Outbox::Uncount(const Item& item) {
  if (item.is_reply) {
    --num_replies_;
    reply_bytes_ -= item.bytes.size();
  } else {
    ordered_frame_bytes_ -= item.bytes.size();
  }
}

bool Outbox::PushReply(std::span<const std::uint8_t> bytes) {
  if (num_replies_ >= max_replies_) return false;
  // One reply always fits, whatever its size. Otherwise a large skeleton could never be sent.
  if (num_replies_ > 0 && reply_bytes_ + bytes.size() > max_reply_bytes_) return false;
  const bool is_free = reply_bytes_ + bytes.size() <= kFreeReplies;
  // A client that reads its replies gets them, whatever waits for others of its host.
  if (!is_free && !Hold(Counted() + bytes.size()) && num_replies_ > 0) {
    account_->CountRefusal();
    return false;
  }
  Append(ordered_, 0, true, bytes);  // first, because memory may be short
  ++num_replies_;
  reply_bytes_ += bytes.size();
  if (!is_free) Settle();
  return true;
}

int Outbox::PushFrame(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep) {
  if (keep == kKeepAll) return PushOrdered(key, bytes);
  const int dropped = PushReplaceable(key, bytes, keep);
  if (dropped > 0) Settle();
  return dropped;
}

// A client of every frame wants no gaps in what it already has, so the new frame is the one to
// drop. The limit is in bytes, because such a client may be far behind on purpose (a recorder).
int Outbox::PushOrdered(std::uint64_t key, std::span<const std::uint8_t> bytes) {
  if (ordered_frame_bytes_ + bytes.size() > protocol::kMaxWaitingFrameBytes) return 1;
  if (!Hold(Counted() + bytes.size())) return NoRoom();
  Append(ordered_, key, false, bytes);
  ordered_frame_bytes_ += bytes.size();
  return 0;
}

int Outbox::PushReplaceable(std::uint64_t key, std::span<const std::uint8_t> bytes,
                            std::size_t keep) {
  const auto is_same = [key](const Item& frame) { return frame.key == key; };
  if (LargePart(bytes.size()) > 0) {
    // Older frames of the key may all be replaced. Those of others must not: a viewer that never
    // learns of a picture waits for it.
    std::size_t replaceable = 0;
    for (const Item& frame : frames_) {
      if (is_same(frame)) replaceable += LargePart(frame.bytes.size());
    }
    if (!Hold(Counted() - replaceable + bytes.size())) return NoRoom();
  }
  int dropped = 0;
  std::size_t& count = num_of_key_[key];  // spares a search through the queue in the usual case
  if (count >= keep) {
    const auto oldest = std::ranges::find_if(frames_, is_same);
    if (keep == 1) {
      const std::size_t before = oldest->bytes.size();
      // A small frame does not keep the memory of a large one.
      if (oldest->bytes.capacity() > 2 * bytes.size() + kMaxSpareBuffer) {
        std::vector<std::uint8_t>(bytes.begin(), bytes.end()).swap(oldest->bytes);
      } else {
        oldest->bytes.assign(bytes.begin(), bytes.end());  // keeps its place in the queue
      }
      UncountFrame(before);
      CountFrame(bytes.size());
      return 1 + DropUntilFit(oldest) + DropUntilRoom(oldest);
    }
    DropFrame(oldest);
    dropped = 1;
  } else if (frames_.size() >= max_frames_) {
    // Many subscriptions of one slow peer share this limit. The front has waited longest.
    DropFrame(frames_.begin());
    dropped = 1;
  }
  Append(frames_, key, false, bytes);
  ++count;
  CountFrame(bytes.size());
  const auto newest = std::prev(frames_.end());
  return dropped + DropUntilFit(newest) + DropUntilRoom(newest);
}

int Outbox::DropUntilFit(Queue::iterator newest) {
  int dropped = 0;
  for (auto frame = frames_.begin(); frame_bytes_ > max_frame_bytes_ && frame != frames_.end();) {
    const auto next = std::next(frame);
    if (frame != newest) {
      DropFrame(frame);
      ++dropped;
    }
    frame = next;
  }
  return dropped;
}

int Outbox::DropUntilRoom(Queue::iterator newest) {
  if (LargePart(newest->bytes.size()) == 0) return 0;
  int dropped = 0;
  for (auto frame = frames_.begin(); frame != frames_.end() && !Hold(Counted());) {
    const auto next = std::next(frame);
    if (frame != newest && frame->key == newest->key) {
      DropFrame(frame);
      ++dropped;
    }
    frame = next;
  }
  return dropped;
}

void Outbox::DropFrame(Queue::iterator frame) {
  --num_of_key_[frame->key];
  UncountFrame(frame->bytes.size());
  Recycle(frames_, frame);
}

bool Outbox::Pop(std::vector<std::uint8_t>* out) {
  popped_bytes_ = 0;
  if (empty()) {
    Settle();
    return false;
  }
  // Replies go before replaceable frames. A frame must not arrive before the reply that explains
  // its names.
  Queue& queue = ordered_.empty() ? frames_ : ordered_;
  if (&queue == &ordered_) {
    Uncount(ordered_.front());
  } else {
    --num_of_key_[frames_.front().key];
    UncountFrame(frames_.front().bytes.size());
  }
  // The caller's old buffer takes the place of the message and is recycled with the item.
  out->swap(queue.front().bytes);
  Recycle(queue, queue.begin());
  popped_bytes_ = out->size();
  Settle();
  return true;
}

void Outbox::DropReplaceableFrames() {
  while (!frames_.empty()) DropFrame(frames_.begin());
  Settle();
}

void Outbox::DropFrames(std::uint64_t key) {
  for (auto item = frames_.begin(); item != frames_.end();) {
    const auto next = std::next(item);
    if (item->key == key) DropFrame(item);
    item = next;
  }
  // Subscription uids never repeat, so counts of ended subscriptions would accumulate.
  num_of_key_.erase(key);
  for (auto item = ordered_.begin(); item != ordered_.end();) {
    if (item->is_reply || item->key != key) {
      ++item;
      continue;
    }
    Uncount(*item);
    item = Recycle(ordered_, item);
  }
  Settle();
}

}  // namespace furrow::server
