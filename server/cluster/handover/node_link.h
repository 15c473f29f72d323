// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "protocol/codec/codec.h"
#include "protocol/framing/fragment.h"
#include "protocol/secure/session/secure_client.h"
#include "server/cluster/node/node_address.h"
#include "server/core/time.h"

namespace furrow::server {

// A conversation with another node of the cluster over its UDP port, by which subjects are handed
// over. This node is a client there like any other one: with a token that it has made itself,
// because all nodes have the same keys, or without one where nobody needs a token. Used on the
// thread of its event loop; the datagrams of the node may be forged or damaged.
class NodeLink : public std::enable_shared_from_this<NodeLink> {
 public:
  struct Options {
    NodeAddress node;
    std::uint64_t session = 0;                           // random, not 0
    std::optional<protocol::secure::ClientToken> token;  // none: the node needs none
    // Finds the addresses of the node's host. Empty: the system does, which cannot be interrupted.
    using Found = std::function<void(const asio::error_code& error,
                                     const asio::ip::udp::resolver::results_type& results)>;
    std::function<void(const NodeAddress& node, Found found)> look_up = {};
    // An answer of the node to the message with this number; `why`: the reason if it refuses.
    std::function<void(std::uint32_t number, bool accepted, const std::string& why)> on_answer;
  };
  NodeLink(asio::io_context& io, Options options);

  // Connects, for at most `patience`. Errors (kUnavailable): the node does not answer, or refuses
  // this one.
  [[nodiscard]] asio::awaitable<Status> Connect(Time patience);
  // Sends a message that Encode() has written, at once. May be lost: the caller repeats it until
  // it is answered.
  void Send(std::span<const std::uint8_t> message);
  // True after an error of the node, which may answer nothing more: begin another conversation.
  [[nodiscard]] bool failed() const { return failed_; }
  // Ends the conversation. Nothing is called afterwards.
  void Close();

 private:
  asio::awaitable<Status> Open(Time patience);
  static asio::awaitable<void> Read(std::shared_ptr<NodeLink> self);
  [[nodiscard]] Status Fault(const std::string& why) const;
  [[nodiscard]] protocol::secure::Now At() const;
  void Maintain();
  void SendHello();
  void SendDatagram(std::span<const std::uint8_t> datagram);
  void OnDatagram(std::span<std::uint8_t> datagram);
  void OnMessage(std::span<const std::uint8_t> message);

  asio::ip::udp::socket socket_;
  const Options options_;
  std::optional<protocol::secure::SecureClient> secure_;
  bool connected_ = false;
  bool failed_ = false;
  std::string refusal_;
  std::uint64_t token_ = 0;         // of the node's Welcome
  std::uint64_t node_session_ = 0;  // of the node; its later messages carry it
  std::uint32_t next_message_id_ = 0;
  protocol::Encoder encoder_;
  protocol::Reassembler reassembler_;
  std::vector<std::uint8_t> message_;
  std::array<std::uint8_t, protocol::secure::kMaxPacketBytes + 1> in_{};
  std::array<std::uint8_t, protocol::secure::kMaxPacketBytes> out_{};
};

}  // namespace furrow::server
