// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/secure/session/channel.h"
#include "protocol/secure/session/now.h"

namespace furrow::protocol::secure {

// What a datagram from the server means.
struct ClientEvent {
  bool connected = false;  // a session began; state of a former session is lost
  bool renewed = false;    // the server accepted the token of Renew()
  ByteSpan inner;          // one datagram of the wire, inside of the datagram's buffer; or empty
  Refusal refusal = Refusal::kNone;
  OpenStatus open_status = OpenStatus::kOk;  // of data and control packets
};

// The client's side of a secure session, without sockets and clocks. It connects, answers retries,
// notices that the server is silent or was started again, connects again beside the old session,
// and proves new addresses. The program sends what Poll() writes and hands in what arrives.
class SecureClient {
 public:
  // `hello`: the datagram that opens every session, at most kMaxHelloBytes; usually a Hello. Keeps
  // a reference to `random`.
  SecureClient(const ClientToken& token, ByteView hello, RandomSource& random = SystemRandom());

  static constexpr std::int64_t kFirstRepeatMicroseconds = 200'000;
  static constexpr std::int64_t kLastRepeatMicroseconds = 400'000;
  // Least time between two retries that are answered.
  static constexpr std::int64_t kRetryMicroseconds = 20'000;
  // After a refusal that will last, such as an expired token.
  static constexpr std::int64_t kRefusedRepeatMicroseconds = 1'000'000;
  static constexpr std::int64_t kProbeMicroseconds = 500'000;
  static constexpr std::int64_t kProbeRepeatMicroseconds = 200'000;
  static constexpr std::int64_t kReconnectMicroseconds = 1'500'000;  // of silence
  static constexpr std::int64_t kLostMicroseconds = 10'000'000;      // of silence
  static constexpr std::int64_t kRenewRepeatMicroseconds = 500'000;

  // Writes the next packet that is due to `packet`, which has kMaxPacketBytes. Returns its size, 0
  // if nothing is due. Call it until it returns 0, and again after every datagram and every 50 ms.
  [[nodiscard]] std::size_t Poll(Now now, ByteSpan packet);

  // Handles a datagram of the server for which IsSecure() is true. Opens it in place.
  [[nodiscard]] ClientEvent OnDatagram(ByteSpan datagram, Now now);

  // Seals a packet for the server (PacketSealer::Seal).
  [[nodiscard]] SealStatus Seal(ByteSpan packet, Now now);

  // Shows a newer token to the server, without a new session, and uses it from now on.
  void Renew(const ClientToken& token);

  // Ends the session: writes the packet that tells the server so. Returns its size, 0 without one.
  [[nodiscard]] std::size_t Close(Now now, ByteSpan packet);

  [[nodiscard]] bool connected() const { return channel_.has_value(); }
  // The last hint why the server does not answer, for messages. Nothing proves it.
  [[nodiscard]] Refusal last_refusal() const { return last_refusal_; }

 private:
  // One initiation. Its bytes are sent again unchanged: another message with the same key pair
  // would encrypt two texts with one nonce.
  struct Attempt {
    Attempt(const Key& psk, ByteView prologue, RandomSource& random)
        : handshake(Handshake::Side::kInitiator, psk, prologue, random) {}
    Handshake handshake;
    std::uint32_t index = 0;
    InitiationBytes datagram{};
    std::int64_t due_us = 0;
    std::int64_t interval_us = kFirstRepeatMicroseconds;
  };

  void Begin(std::int64_t due_us);
  [[nodiscard]] bool ShouldReconnect(std::int64_t now_us) const;
  [[nodiscard]] std::size_t SendControl(Now now, ByteSpan packet);
  void OnRetry(ByteView datagram, Now now, ClientEvent& event);
  void OnResponse(ByteView datagram, Now now, ClientEvent& event);
  void OnRefused(ByteView datagram, Now now, ClientEvent& event);
  void OnPacket(ByteSpan datagram, Now now, ClientEvent& event);
  void OnControl(const ControlMessage& message, ClientEvent& event);

  ClientToken token_;
  std::vector<std::uint8_t> hello_;
  RandomSource& random_;
  Cookie cookie_{};  // zeros until the server gave one
  std::optional<Attempt> attempt_;
  std::int64_t attempt_began_us_ = 0;
  std::int64_t next_retry_us_ = 0;

  std::optional<Channel> channel_;
  std::uint32_t index_ = 0;       // of the session, here
  std::uint32_t peer_index_ = 0;  // at the server
  std::int64_t last_heard_us_ = 0;
  std::int64_t next_probe_us_ = 0;
  bool unknown_at_server_ = false;
  std::optional<Cookie> path_answer_;
  bool renewing_ = false;
  std::int64_t next_renewal_us_ = 0;
  Refusal last_refusal_ = Refusal::kNone;
};

}  // namespace furrow::protocol::secure
