// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/messages/messages.h"
#include "server/cluster/place.h"
#include "server/core/metrics.h"
#include "server/session/peers/peer.h"

namespace furrow::server {

// Encodes messages and sends them to peers. It has one encoder and one buffer, so two threads must
// not share a sender. Every message carries the daemon's session number.
class MessageSender {
 public:
  // `session`: of the daemon. `metrics`: not null; outlives this object. `shard`: of the calling
  // thread, or Link::kExclusive; passed on to Link::SendFrame().
  MessageSender(std::uint64_t session, Metrics* metrics, int shard = 0)
      : session_(session), metrics_(metrics), shard_(shard) {}

  // Sends a reply. `header`: see ReplyHeader(); its session number is replaced by the daemon's.
  // Replies to a UDP peer that exceed its consent are dropped and counted.
  template <class Message>
  void SendReply(Peer& peer, protocol::Header header, const Message& message) {
    Encode(header, message);
    if (peer.transport == Transport::kUdp && !peer.consent.Spend(buffer_.size())) {
      metrics_->Add(Counter::kRepliesWithoutConsent);
      return;
    }
    peer.link->SendReply(buffer_);
  }
  // Sends a UDP peer a challenge (Consent), which its replies do not use up.
  void SendChallenge(Peer& peer, std::int64_t number) {
    protocol::Header header;
    Encode(header, protocol::Ping{number});
    peer.link->SendReply(buffer_);
  }
  // Of one frame.
  struct Sent {
    std::uint64_t dropped = 0;  // frames, this one included
    bool had_room = true;       // false: this one was dropped
  };
  // Sends one frame of the subscription `key`, counts it as `sent`, and counts the frames that were
  // dropped for it as `dropped`. `keep`: see Link::SendFrame().
  template <class Message>
  Sent SendFrame(Peer& peer, std::uint64_t key, protocol::Header header, const Message& message,
                 Counter sent, Counter dropped, std::size_t keep) {
    Encode(header, message);
    return Push(peer, key, sent, dropped, keep);
  }
  // Sends one frame as SendFrame() does, from a FlatBuffers payload that is already encoded.
  Sent SendEncodedFrame(Peer& peer, std::uint64_t key, protocol::Header header,
                        std::span<const std::uint8_t> payload, Counter sent, Counter dropped,
                        std::size_t keep) {
    header.session = session_;
    protocol::WriteMessage(header, payload, buffer_);
    return Push(peer, key, sent, dropped, keep);
  }
  // Encodes a message without an addressee into `out`, envelope included.
  template <class Message>
  void Encode(const Message& message, std::vector<std::uint8_t>& out) {
    encoder_.Encode({.session = session_}, message, out);
  }
  template <class Message>
  void Encode(protocol::Header header, const Message& message, std::vector<std::uint8_t>& out) {
    header.session = session_;
    encoder_.Encode(header, message, out);
  }
  // Answers `request` with an error and counts it.
  void SendError(Peer& peer, const protocol::Header& request, protocol::ErrorCode code,
                 std::string text) {
    metrics_->Add(Counter::kMessagesRefused);
    SendReply(peer, ReplyHeader(request), protocol::ErrorMessage{code, Truncate(std::move(text))});
  }

  // Answers `request` with the server that must be asked instead.
  void SendElsewhere(Peer& peer, const protocol::Header& request, protocol::ErrorCode code,
                     std::string text, const NodeAddress& node) {
    metrics_->Add(Counter::kRedirected);
    SendReply(peer, ReplyHeader(request),
              protocol::ErrorMessage{.code = code,
                                     .message = Truncate(std::move(text)),
                                     .host = node.host,
                                     .tcp = node.tcp,
                                     .udp = node.udp,
                                     .web = node.http,
                                     .web_tls = node.https});
  }

  // The header of a reply: the stream and sequence of the request.
  [[nodiscard]] static protocol::Header ReplyHeader(const protocol::Header& request) {
    return {.session = 0, .stream = request.stream, .sequence = request.sequence};
  }
  // Shortens UTF-8 text to the wire's limit without cutting a character in two.
  [[nodiscard]] static std::string Truncate(std::string text) {
    if (text.size() <= protocol::kMaxTextBytes) return text;
    std::size_t size = protocol::kMaxTextBytes;
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80) --size;
    text.resize(size);
    return text;
  }

 private:
  template <class Message>
  void Encode(const protocol::Header& header, const Message& message) {
    Encode(header, message, buffer_);
  }
  Sent Push(Peer& peer, std::uint64_t key, Counter sent, Counter dropped, std::size_t keep) {
    metrics_->Add(sent);
    const int count = peer.link->SendFrame(key, buffer_, keep, shard_);
    const bool had_room = count != Link::kNoRoom;
    const Sent result{had_room ? static_cast<std::uint64_t>(count) : 1, had_room};
    metrics_->Add(dropped, result.dropped);
    return result;
  }

  std::uint64_t session_;
  Metrics* metrics_;
  int shard_;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace furrow::server
