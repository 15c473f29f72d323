// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/messages/messages.h"
#include "server/core/metrics.h"
#include "server/session/peers/peer.h"

namespace furrow::server {

// Writes messages to peers: one encoder, one buffer, the daemon's session number. What an unproven
// UDP address has no credit for is dropped and counted. `lane`: as Link::SendFrame() takes it.
class Postman {
 public:
  Postman(std::uint64_t session, Metrics* metrics, int lane = 0)
      : session_(session), metrics_(metrics), lane_(lane) {}

  template <class Message>
  void Reply(Peer& peer, protocol::Header header, const Message& message) {
    if (!Encode(peer, header, message)) return;
    peer.link->SendReply(buffer_);
  }
  // Counts what the frame pushes out as `dropped` and returns it; `keep` as in Link::SendFrame().
  template <class Message>
  std::uint64_t Frame(Peer& peer, std::uint64_t key, protocol::Header header,
                      const Message& message, Counter sent, Counter dropped, std::size_t keep) {
    if (!Encode(peer, header, message)) return 0;
    return Post(peer, key, sent, dropped, keep);
  }
  // The same for a payload that is encoded already.
  std::uint64_t Forward(Peer& peer, std::uint64_t key, protocol::Header header,
                        std::span<const std::uint8_t> payload, Counter sent, Counter dropped,
                        std::size_t keep) {
    header.session = session_;
    protocol::WriteMessage(header, payload, buffer_);
    return MaySend(peer) ? Post(peer, key, sent, dropped, keep) : 0;
  }
  // A message of ours for nobody in particular yet.
  template <class Message>
  void Encode(const Message& message, std::vector<std::uint8_t>& out) {
    encoder_.Encode({.session = session_}, message, out);
  }
  // An error about the request that `request` heads.
  void Error(Peer& peer, const protocol::Header& request, protocol::ErrorCode code,
             std::string text) {
    metrics_->Add(Counter::kMessagesRefused);
    Reply(peer, Answering(request), protocol::ErrorMessage{code, Clip(std::move(text))});
  }

  // The header of an answer: the request's stream and sequence.
  [[nodiscard]] static protocol::Header Answering(const protocol::Header& request) {
    return {.session = 0, .stream = request.stream, .sequence = request.sequence};
  }
  // At most as long as the wire carries, cut between characters.
  [[nodiscard]] static std::string Clip(std::string text) {
    if (text.size() <= protocol::kMaxTextBytes) return text;
    std::size_t size = protocol::kMaxTextBytes;
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80) --size;
    text.resize(size);
    return text;
  }

 private:
  template <class Message>
  bool Encode(Peer& peer, protocol::Header& header, const Message& message) {
    header.session = session_;
    encoder_.Encode(header, message, buffer_);
    return MaySend(peer);
  }
  std::uint64_t Post(Peer& peer, std::uint64_t key, Counter sent, Counter dropped,
                     std::size_t keep) {
    metrics_->Add(sent);
    const auto count = static_cast<std::uint64_t>(peer.link->SendFrame(key, buffer_, keep, lane_));
    metrics_->Add(dropped, count);
    return count;
  }
  bool MaySend(Peer& peer) {
    if (peer.transport != Transport::kUdp || peer.credit.Spend(buffer_.size())) return true;
    metrics_->Add(Counter::kDatagramsUnproven);
    return false;
  }

  std::uint64_t session_;
  Metrics* metrics_;
  int lane_;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace furrow::server
