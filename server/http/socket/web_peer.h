// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/http/request/thread_handoff.h"
#include "server/session/peers/peer.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// A peer of the hub with a connection on the web thread. Messages cross between the threads by
// value; outgoing ones wait in a bounded outbox in which the newest frame wins.
//
// The web thread calls all functions. The hub's thread keeps its Link alive until it has processed
// the end of the peer.
class WebPeer {
 public:
  static constexpr int kMaxWaiting = 64;  // messages queued for the hub

  // Adds the peer to the hub. `wake` is called on the hub's thread when the outbox is no longer
  // empty or the peer is overrun; it must post to the web thread.
  // `access`: what the client may do. `waiting`: limits what waits for it; null: nothing does.
  WebPeer(PostToHub post_to_hub, PeerLabel label, Access access, WaitingBytes* waiting,
          std::function<void()> wake);
  ~WebPeer();  // removes the peer from the hub
  WebPeer(const WebPeer&) = delete;
  WebPeer& operator=(const WebPeer&) = delete;

  // Passes a message from the client to the hub. False: the client sends faster than the hub reads;
  // close the connection.
  [[nodiscard]] bool Send(std::vector<std::uint8_t> message);

  // Takes the next message for the client. False: there is none.
  [[nodiscard]] bool Pop(std::vector<std::uint8_t>* out);
  // True if the client does not read its replies; close the connection.
  [[nodiscard]] bool overrun() const;

 private:
  class Connection;

  const PostToHub post_to_hub_;
  const std::shared_ptr<Connection> connection_;
};

}  // namespace furrow::server
