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

std::size_t BeyondFree(std::size_t bytes) { return bytes - std::min(bytes, WaitingBytes::kFree); }

}  // namespace

std::size_t Outbox::Counted(std::size_t reply_bytes, std::size_t frame_bytes) const {
  return BeyondFree(reply_bytes) + BeyondFree(frame_bytes) + ordered_frame_bytes_ + popped_bytes_;
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
  const std::size_t all = reply_bytes_ + bytes.size();
  const bool has_room = BeyondFree(all) == 0 || Hold(Counted(all, frame_bytes_));
  // A client that reads its replies gets them, whatever waits for others of its host.
  if (!has_room && num_replies_ > 0) {
    account_->CountRefusal();
    return false;
  }
  ++num_replies_;
  reply_bytes_ += bytes.size();
  Append(ordered_, 0, true, bytes);
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
  if (!Hold(Counted(reply_bytes_, frame_bytes_) + bytes.size())) return NoRoom();
  ordered_frame_bytes_ += bytes.size();
  Append(ordered_, key, false, bytes);
  return 0;
}

int Outbox::PushReplaceable(std::uint64_t key, std::span<const std::uint8_t> bytes,
                            std::size_t keep) {
  // Without the older frames, which may all be replaced.
  if (BeyondFree(bytes.size()) > 0 && !Hold(Counted(reply_bytes_, bytes.size()))) return NoRoom();
  const auto is_same = [key](const Item& frame) { return frame.key == key; };
  int dropped = 0;
  // The count per key avoids a search through the queue in the usual case.
  if (const auto found = num_of_key_.find(key);
      found != num_of_key_.end() && found->second >= keep) {
    const auto oldest = std::ranges::find_if(frames_, is_same);
    if (keep == 1) {
      frame_bytes_ += bytes.size() - oldest->bytes.size();
      // A small frame does not keep the memory of a large one.
      if (oldest->bytes.capacity() > 2 * bytes.size() + kMaxSpareBuffer) oldest->bytes = {};
      oldest->bytes.assign(bytes.begin(), bytes.end());  // keeps its place in the queue
      return 1 + DropUntilFit(oldest);
    }
    DropFrame(oldest);
    dropped = 1;
  } else if (frames_.size() >= max_frames_) {
    // Many subscriptions of one slow peer share this limit. The front has waited longest.
    DropFrame(frames_.begin());
    dropped = 1;
  }
  ++num_of_key_[key];
  frame_bytes_ += bytes.size();
  Append(frames_, key, false, bytes);
  return dropped + DropUntilFit(std::prev(frames_.end()));
}

int Outbox::DropUntilFit(Queue::iterator newest) {
  const auto fits = [this] {
    return frame_bytes_ <= max_frame_bytes_ &&
           (BeyondFree(frame_bytes_) == 0 || Hold(Counted(reply_bytes_, frame_bytes_)));
  };
  int dropped = 0;
  for (auto frame = frames_.begin(); !fits() && frame != frames_.end();) {
    const auto next = std::next(frame);
    if (frame != newest) {
      DropFrame(frame);
      ++dropped;
    }
    frame = next;
  }
  return dropped;
}

void Outbox::DropFrame(Queue::iterator frame) {
  --num_of_key_[frame->key];
  frame_bytes_ -= frame->bytes.size();
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
    frame_bytes_ -= frames_.front().bytes.size();
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
