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
  Connection(WaitingBytes::Account account, std::function<void()> wake) : wake_(std::move(wake)) {
    outbox_.SetAccount(std::move(account));
  }

  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                int shard) override;
  void DropFrames(std::uint64_t key) override;
  bool Pop(std::vector<std::uint8_t>* out);

  PeerId id = 0;  // used by the hub's thread only
  // Messages posted to the hub and not yet handled. Counted up on the web thread, down on the
  // hub's.
  std::atomic<int> waiting = 0;
  std::atomic<bool> overrun = false;

 private:
  // A client that leaves this many replies unread is disconnected.
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
    // The hub is using this peer, so only a flag is set; the writer on the web thread closes.
    if (!outbox_.PushReply(message)) overrun = true;
  }
  // Outside of the mutex. One wake-up is enough: the writer empties the outbox before it sleeps.
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

WebPeer::WebPeer(PostToHub post_to_hub, PeerLabel label, Access access, WaitingBytes* waiting,
                 std::function<void()> wake)
    : post_to_hub_(std::move(post_to_hub)),
      connection_(std::make_shared<Connection>(WaitingBytes::Account(waiting, label.host),
                                               std::move(wake))) {
  post_to_hub_([connection = connection_, label = std::move(label), access = std::move(access)](
                   Hub& hub, Time now) {
    // The id is set before any message of the peer is handled, because tasks run in the order of
    // posting.
    connection->id = hub.AddPeer(Transport::kWeb, label, connection.get(), now, 0, access);
  });
}

WebPeer::~WebPeer() {
  // The task holds the connection, so the hub's pointer to the Link is valid until it has run.
  post_to_hub_([connection = connection_](Hub& hub, Time) { hub.RemovePeer(connection->id); });
}

bool WebPeer::Send(std::vector<std::uint8_t> message) {
  // Bounds the hub's task queue per client. The count is not taken back on failure, because the
  // caller then closes the connection.
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
