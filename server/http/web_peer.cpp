// SPDX-License-Identifier: Apache-2.0
#include "server/http/web_peer.h"

#include <utility>

#include "server/session/hub.h"

namespace furrow::server {

void WebPeer::Open() {
  post_to_hub_([self = shared_from_this()](Hub& hub, Time now) {
    self->id_ = hub.AddPeer(Transport::kWeb, self->name_, self.get(), now);
  });
}

void WebPeer::Close() {
  post_to_hub_([self = shared_from_this()](Hub& hub, Time) { hub.RemovePeer(self->id_); });
}

bool WebPeer::Send(std::vector<std::uint8_t> message) {
  if (waiting_.fetch_add(1, std::memory_order_relaxed) >= kMaxWaiting) return false;
  post_to_hub_([self = shared_from_this(), message = std::move(message)](Hub& hub, Time now) {
    self->waiting_.fetch_sub(1, std::memory_order_relaxed);
    hub.OnMessage(self->id_, message, now);
  });
  return true;
}

bool WebPeer::Pop(std::vector<std::uint8_t>* out) {
  const std::lock_guard lock(mutex_);
  return outbox_.Pop(out);
}

void WebPeer::SendReply(std::span<const std::uint8_t> message) {
  bool is_first = false;
  {
    const std::lock_guard lock(mutex_);
    is_first = outbox_.empty();
    if (!outbox_.PushReply(message)) overrun_ = true;
  }
  if (is_first || overrun_) wake_();
}

int WebPeer::SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep) {
  int dropped = 0;
  bool is_first = false;
  {
    const std::lock_guard lock(mutex_);
    is_first = outbox_.empty();
    dropped = outbox_.PushFrame(key, message, keep);
  }
  if (is_first) wake_();
  return dropped;
}

void WebPeer::DropFrames(std::uint64_t key) {
  const std::lock_guard lock(mutex_);
  outbox_.DropFrames(key);
}

}  // namespace furrow::server
