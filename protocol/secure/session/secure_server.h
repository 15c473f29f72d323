// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "protocol/secure/session/admission.h"
#include "protocol/secure/session/channel.h"
#include "protocol/secure/session/session_state.h"

namespace furrow::protocol::secure {

struct SecureServerSettings {
  AdmissionSettings admission;
  std::size_t max_sessions = 4096;  // at most 65,535
  // More sessions of one token, also by a renewal, close the one that was silent for longest.
  std::size_t max_sessions_of_a_token = 16;
};

// What a datagram means for the program around.
struct ServerEvent {
  // The session whose client sent the datagram; 0 if nothing proves that.
  std::uint32_t session = 0;
  bool opened = false;   // the session began with this datagram
  bool renewed = false;  // its grant or expiry changed
  bool closed = false;   // the client ended it; `session` is invalid now
  ByteSpan inner;        // one datagram of the wire, inside of the datagram's buffer; or empty
  // The datagram that the client sent with its first packet, if `opened`: usually a Hello.
  std::vector<std::uint8_t> hello;
  // A datagram for the sender's address, if any. It is never larger than the datagram.
  std::array<std::uint8_t, 64> reply_bytes{};
  std::size_t reply_size = 0;
  // Why the datagram was dropped.
  Refusal refusal = Refusal::kNone;
  OpenStatus open_status = OpenStatus::kOk;

  [[nodiscard]] ByteView reply() const { return {reply_bytes.data(), reply_size}; }
};

// All secure sessions of a server, without sockets and clocks. Look-ups take constant time. A
// packet of an existing session costs no allocation. One thread at a time may use an object.
class SecureServer {
 public:
  // Keeps a reference to `random`.
  explicit SecureServer(SecureServerSettings settings, RandomSource& random = SystemRandom());
  ~SecureServer();

  // A session without an authentic packet from its client for this long ends; clients probe every
  // half second. A handshake that the client does not continue ends sooner.
  static constexpr std::int64_t kSilenceMicroseconds = 30'000'000;
  static constexpr std::int64_t kUnconfirmedMicroseconds = 5'000'000;
  static constexpr std::size_t kMaxUnconfirmedOfAToken = 4;
  static constexpr std::int64_t kChallengeMicroseconds = 100'000;

  // Replaces the keys. Sessions whose tokens were sealed with a key that is no longer there end, so
  // a retired key lets nobody in and keeps nobody in.
  void SetKeys(KeyRing keys);

  // Handles a datagram for which IsSecure() is true. Opens it in place.
  [[nodiscard]] ServerEvent OnDatagram(ByteSpan datagram, const PeerAddress& from, Now now);

  // Seals a packet for the client of a session (PacketSealer::Seal) and sets `to` to its address.
  // kNotConnected: no such session, or its client has not continued the handshake.
  [[nodiscard]] SealStatus Seal(std::uint32_t session, ByteSpan packet, Now now, PeerAddress& to);

  // The permissions of a session, the id of the key that sealed its token, and when they end (Unix
  // time in seconds). `grant` is null if there is no such session.
  struct Info {
    const Grant* grant = nullptr;
    std::uint32_t key_id = 0;
    std::uint64_t expires = 0;
  };
  [[nodiscard]] Info InfoOf(std::uint32_t session) const;
  [[nodiscard]] const PeerAddress* AddressOf(std::uint32_t session) const;

  // Ends a session at once. Packets of its client are answered as those of an unknown session.
  void Close(std::uint32_t session);
  // Ends all sessions. Returns those that have begun, for a server that goes on with them: their
  // clients notice nothing. This server seals nothing more.
  [[nodiscard]] std::vector<SessionState> TakeAll();
  // Goes on with a session of another server. False, and nothing has changed: its number is taken
  // or too high, it has expired, or the key of its token is unknown.
  [[nodiscard]] bool Resume(const SessionState& state, Now now);

  // Ends sessions that are silent or whose tokens have expired. Call it about once per second.
  void Expire(Now now);
  // The sessions that have ended since the last call, except those that the caller closed and those
  // that never opened.
  [[nodiscard]] std::vector<std::uint32_t> TakeClosed();

  [[nodiscard]] std::size_t num_sessions() const { return num_sessions_; }
  [[nodiscard]] const Admission& admission() const { return admission_; }
  [[nodiscard]] std::uint64_t num_dropped(OpenStatus status) const {
    return dropped_[static_cast<std::size_t>(status)];
  }

 private:
  struct Session;

  [[nodiscard]] std::uint32_t FreeIndex() const;
  [[nodiscard]] Session* Find(std::uint32_t index) const;
  void OnInitiation(ByteSpan datagram, const PeerAddress& from, Now now, ServerEvent& event);
  void OnPacket(ByteSpan datagram, const PeerAddress& from, Now now, ServerEvent& event);
  void OnControl(Session& session, const OpenedPacket& packet, const PeerAddress& from, Now now,
                 ServerEvent& event);
  void Renew(Session& session, ByteView renewal, Now now, ServerEvent& event);
  void Challenge(Session& session, std::size_t received, const PeerAddress& from, Now now,
                 ServerEvent& event);
  void Confirm(Session& session, ServerEvent& event);
  void LimitConfirmed(const Session& session, bool replaces);
  void LimitUnconfirmed(const TokenUse& use);
  void Reply(Session& session, ControlType type, ByteView content, Now now, ServerEvent& event);
  void End(Session& session, bool report);

  SecureServerSettings settings_;
  Admission admission_;
  // By the low 16 bits of the index. The high bits change from one session to the next, and begin
  // at random, so packets for an earlier session or an earlier server find none.
  std::vector<std::unique_ptr<Session>> sessions_;
  std::vector<std::uint16_t> free_places_;
  std::size_t num_sessions_ = 0;
  std::uint32_t generation_;
  std::vector<std::uint32_t> closed_;
  std::array<std::uint64_t, kNumOpenStatuses> dropped_{};
};

}  // namespace furrow::protocol::secure
