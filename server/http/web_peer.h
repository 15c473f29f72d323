// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "server/http/hub_door.h"
#include "server/session/outbox.h"
#include "server/session/peer.h"

namespace furrow::server {

// A peer of the hub whose connection lives on the web's thread: messages cross by value, and what
// goes out waits in a bounded outbox where the newest frame wins.
//
// All of it is for the web's thread but for Link, which the hub calls on its own. Made by
// std::make_shared; lives until both sides have let go.
class WebPeer : public Link, public std::enable_shared_from_this<WebPeer> {
 public:
  static constexpr int kMaxWaiting = 64;  // messages on their way to the hub

  // `wake` is called on the hub's thread when something waits to be sent that did not before, or
  // the peer is overrun; it must hand over to the web's thread.
  WebPeer(PostToHub post_to_hub, std::string name, std::function<void()> wake)
      : post_to_hub_(std::move(post_to_hub)), name_(std::move(name)), wake_(std::move(wake)) {}

  void Open();
  void Close();  // nothing comes or goes from here on

  // A whole message of the client's. False: it sends faster than the daemon reads; cut it off.
  [[nodiscard]] bool Send(std::vector<std::uint8_t> message);

  // The next message for the client. False: none waits.
  [[nodiscard]] bool Pop(std::vector<std::uint8_t>* out);
  // The client does not read its replies: cut it off.
  [[nodiscard]] bool overrun() const { return overrun_; }

  // Link: the hub's thread.
  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message,
                std::size_t keep) override;
  void DropFrames(std::uint64_t key) override;

 private:
  static constexpr std::size_t kMaxReplies = 256;
  static constexpr std::size_t kMaxFrames = 64;

  const PostToHub post_to_hub_;
  const std::string name_;
  const std::function<void()> wake_;
  PeerId id_ = 0;  // the hub's thread
  std::atomic<int> waiting_ = 0;
  std::atomic<bool> overrun_ = false;
  std::mutex mutex_;
  Outbox outbox_{kMaxReplies, kMaxFrames};
};

}  // namespace furrow::server
