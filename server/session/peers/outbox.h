// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "protocol/messages/limits.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// The bounded send queue of one peer. A slow peer loses old frames and delays nobody else.
//
// - Replies are never dropped. A peer with `max_replies` or `max_reply_bytes` of queued replies is
//   not reading; the caller closes it.
// - Frames have a key, which is their subscription. At most `keep` frames of a key are queued; a
//   new frame then replaces the oldest. Pictures keep 1; weights keep a few, so that a burst of
//   poses is not lost to a peer that keeps up.
// - At most `max_frames` frames of all keys, and `max_frame_bytes` of them, are queued; a new frame
//   then replaces the oldest ones. One frame always fits.
// - Frames with kKeepAll queue behind the replies, in order. At most kMaxWaitingFrameBytes of them
//   are queued; further frames are dropped.
// - What waits, and the last message that Pop() returned, needs room in the account of the peer's
//   host. Free are kFreeReplies of replies, every frame of at most kSmallFrame without kKeepAll,
//   and what the account does not count. A new frame first replaces older ones of its key; without
//   room even then, it is dropped. A reply without room closes the peer, unless no other one waits.
// - New messages reuse the memory of sent ones, at most kMaxSpareBytes, so the outbox of a peer
//   that keeps up stops allocating after a while. Not thread-safe.
class Outbox {
 public:
  Outbox(std::size_t max_replies, std::size_t max_frames,
         std::size_t max_reply_bytes = std::size_t{4} << 20,
         std::size_t max_frame_bytes = std::size_t{8} << 20)
      : max_replies_(max_replies),
        max_frames_(max_frames),
        max_reply_bytes_(max_reply_bytes),
        max_frame_bytes_(max_frame_bytes) {}

  static constexpr std::size_t kMaxSpareBytes = std::size_t{64} << 10;
  static constexpr std::size_t kFreeReplies = std::size_t{256} << 10;
  static constexpr std::size_t kSmallFrame = std::size_t{4} << 10;

  // Once, before anything is queued. Without an account, there is always room.
  void SetAccount(WaitingBytes::Account account) { account_.emplace(std::move(account)); }

  // False: the queue is full; close the peer.
  [[nodiscard]] bool PushReply(std::span<const std::uint8_t> bytes);
  // Returns the number of frames that this call dropped, the new frame included; Link::kNoRoom: the
  // host has no room for the new frame, and no other one was dropped.
  int PushFrame(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep = 1);

  // Swaps the next message into `out`: replies and kKeepAll frames first, in order, then the oldest
  // frame. False: the queue is empty.
  bool Pop(std::vector<std::uint8_t>* out);

  // Drops the queued frames of a key, kKeepAll frames included.
  void DropFrames(std::uint64_t key);
  // Drops all frames except kKeepAll frames. For a peer that leaves after its queued replies.
  void DropReplaceableFrames();

  [[nodiscard]] bool empty() const { return ordered_.empty() && frames_.empty(); }
  // Of all queued messages.
  [[nodiscard]] std::size_t bytes() const {
    return reply_bytes_ + ordered_frame_bytes_ + frame_bytes_;
  }
  // True if kKeepAll frames are queued.
  [[nodiscard]] bool owes_frames() const { return ordered_frame_bytes_ > 0; }
  [[nodiscard]] std::size_t num_frames() const { return frames_.size(); }

 private:
  struct Item {
    std::uint64_t key = 0;
    bool is_reply = false;
    std::vector<std::uint8_t> bytes;
  };
  using Queue = std::list<Item>;

  // What needs room.
  [[nodiscard]] std::size_t Counted() const;
  // States to the account what waits. False: there is no room for more than before.
  [[nodiscard]] bool Hold(std::size_t bytes) { return !account_ || account_->Hold(bytes); }
  // The same after a message has left the queue.
  void Settle() { (void)Hold(Counted()); }
  int PushOrdered(std::uint64_t key, std::span<const std::uint8_t> bytes);
  int PushReplaceable(std::uint64_t key, std::span<const std::uint8_t> bytes, std::size_t keep);
  int NoRoom();
  void Append(Queue& queue, std::uint64_t key, bool is_reply, std::span<const std::uint8_t> bytes);
  // Removes an item and keeps its memory for a new one. Returns the next item.
  Queue::iterator Recycle(Queue& queue, Queue::iterator item);
  void Uncount(const Item& item);
  void DropFrame(Queue::iterator frame);
  // Drops the oldest frames, but not `newest`, until the rest fits. Returns their number.
  int DropUntilFit(Queue::iterator newest);
  // Drops older frames of the key of `newest` until there is room. Returns their number.
  int DropUntilRoom(Queue::iterator newest);
  void CountFrame(std::size_t bytes);
  void UncountFrame(std::size_t bytes);

  std::size_t max_replies_;
  std::size_t max_frames_;
  std::size_t max_reply_bytes_;
  std::size_t max_frame_bytes_;
  std::size_t num_replies_ = 0;  // queued in ordered_
  std::size_t reply_bytes_ = 0;
  std::size_t ordered_frame_bytes_ = 0;  // of kKeepAll frames
  std::size_t frame_bytes_ = 0;          // in frames_
  std::size_t large_frame_bytes_ = 0;    // of those above kSmallFrame
  Queue ordered_;                        // replies and kKeepAll frames
  Queue frames_;
  std::unordered_map<std::uint64_t, std::size_t> num_of_key_;  // in frames_
  Queue spare_;
  std::size_t spare_bytes_ = 0;   // the capacity of spare_
  std::size_t popped_bytes_ = 0;  // of the message that is being sent
  std::optional<WaitingBytes::Account> account_;
};

}  // namespace furrow::server
