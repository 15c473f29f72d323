// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/http/request/hub_door.h"

namespace furrow::server {

// A peer of the hub whose connection lives on the web's thread: messages cross by value, and what
// goes out waits in a bounded outbox where the newest frame wins.
//
// All of it is for the web's thread but for Link, which the hub calls on its own; it keeps that
// link until it has heard of the end, however this side ended.
class WebPeer {
 public:
  static constexpr int kMaxWaiting = 64;  // messages on their way to the hub

  // A peer of the hub from here on. `wake` is called on the hub's thread when something waits to be
  // sent that did not before, or the peer is overrun; it must hand over to the web's thread.
  WebPeer(PostToHub post_to_hub, std::string name, std::function<void()> wake);
  ~WebPeer();  // nothing comes or goes from here on
  WebPeer(const WebPeer&) = delete;
  WebPeer& operator=(const WebPeer&) = delete;

  // A whole message of the client's. False: it sends faster than the daemon reads; cut it off.
  [[nodiscard]] bool Send(std::vector<std::uint8_t> message);

  // The next message for the client. False: none waits.
  [[nodiscard]] bool Pop(std::vector<std::uint8_t>* out);
  // The client does not read its replies: cut it off.
  [[nodiscard]] bool overrun() const;

 private:
  class Connection;

  const PostToHub post_to_hub_;
  const std::shared_ptr<Connection> connection_;
};

}  // namespace furrow::server
