// SPDX-License-Identifier: Apache-2.0
#include "server/http/socket/web_peer.h"

#include <atomic>
#include <mutex>
#include <span>
#include <utility>

#include "server/session/hub.h"
#include "server/session/peers/outbox.h"

namespace furrow::server {

// The state that both threads share. The hub's thread uses the Link functions.
class WebPeer::Connection : public Link {
 public:
  explicit Connection(std::function<void()> wake) : wake_(std::move(wake)) {}

  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                int shard) override;
  void DropFrames(std::uint64_t key) override;
  bool Pop(std::vector<std::uint8_t>* out);

  PeerId id = 0;  // used by the hub's thread only
  std::atomic<int> waiting = 0;
  std::atomic<bool> overrun = false;

 private:
  static constexpr std::size_t kMaxReplies = 256;
  static constexpr std::size_t kMaxFrames = 64;

  const std::function<void()> wake_;
  std::mutex mutex_;
  Outbox outbox_{kMaxReplies, kMaxFrames};
};

void WebPeer::Connection::SendReply(std::span<const std::uint8_t> message) {
  bool is_first = false;
  {
    const std::lock_guard lock(mutex_);
    is_first = outbox_.empty();
    if (!outbox_.PushReply(message)) overrun = true;
  }
  if (is_first || overrun) wake_();
}

int WebPeer::Connection::SendFrame(std::uint64_t key, std::span<const std::uint8_t> message,
                                   std::size_t keep, int /*shard*/) {
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

void WebPeer::Connection::DropFrames(std::uint64_t key) {
  const std::lock_guard lock(mutex_);
  outbox_.DropFrames(key);
}

bool WebPeer::Connection::Pop(std::vector<std::uint8_t>* out) {
  const std::lock_guard lock(mutex_);
  return outbox_.Pop(out);
}

WebPeer::WebPeer(PostToHub post_to_hub, std::string name, std::function<void()> wake)
    : post_to_hub_(std::move(post_to_hub)),
      connection_(std::make_shared<Connection>(std::move(wake))) {
  post_to_hub_([connection = connection_, name = std::move(name)](Hub& hub, Time now) {
    connection->id = hub.AddPeer(Transport::kWeb, name, connection.get(), now);
  });
}

WebPeer::~WebPeer() {
  post_to_hub_([connection = connection_](Hub& hub, Time) { hub.RemovePeer(connection->id); });
}

bool WebPeer::Send(std::vector<std::uint8_t> message) {
  if (connection_->waiting.fetch_add(1, std::memory_order_relaxed) >= kMaxWaiting) return false;
  post_to_hub_([connection = connection_, message = std::move(message)](Hub& hub, Time now) {
    connection->waiting.fetch_sub(1, std::memory_order_relaxed);
    hub.OnMessage(connection->id, message, now);
  });
  return true;
}

bool WebPeer::Pop(std::vector<std::uint8_t>* out) { return connection_->Pop(out); }

bool WebPeer::overrun() const { return connection_->overrun; }

}  // namespace furrow::server
