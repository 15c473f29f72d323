// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "protocol/messages/bytes.h"
#include "protocol/secure/handshake/cookie.h"
#include "protocol/secure/handshake/handshake_packets.h"
#include "protocol/secure/session/host_budgets.h"
#include "protocol/secure/session/now.h"
#include "protocol/secure/session/rate_budget.h"
#include "protocol/secure/session/session_state.h"
#include "protocol/secure/token/connect_token.h"
#include "protocol/secure/token/key_ring.h"

namespace furrow::protocol::secure {

struct AdmissionSettings {
  std::string audience;  // name of this server; tokens for another name are refused
  std::uint32_t handshakes_per_second = 500;
  std::uint32_t handshakes_per_second_of_a_token = 10;
  // First messages that are examined: each costs 14 us, also if the client does not know the key of
  // the token that it shows. One token at one host may use a small part, so that others find some
  // left.
  std::uint32_t attempts_per_second = 2000;
  std::uint32_t attempts_per_second_of_a_host = 100;
};

// A token with sessions. It may not be used from another host meanwhile.
struct TokenUse {
  TokenNonce nonce{};
  std::uint32_t key_id = 0;
  std::array<std::uint8_t, 16> host{};
  std::int64_t last_heard_us = 0;       // of all its sessions
  std::vector<std::uint32_t> sessions;  // indices
  RateBudget handshakes{0};
};

// A handshake that the server has completed on its side. The client has not yet proved that it
// received the response.
struct AcceptedHandshake {
  SessionKeys keys;
  Grant grant;
  std::uint64_t expires = 0;
  std::uint32_t client_index = 0;
  PublicKey client_key{};  // names the handshake in Release()
  TokenUse* use = nullptr;
  std::vector<std::uint8_t> hello;
};

enum class AdmissionOutcome : std::uint8_t {
  kRefused = 0,
  kRetry,     // the client must return the cookie first
  kRepeated,  // the response to this initiation again; its session exists
  kAccepted,  // a new session
};

struct AdmissionResult {
  AdmissionOutcome outcome = AdmissionOutcome::kRefused;
  Refusal refusal = Refusal::kNone;
  // The datagram to send back, if any: never larger than the initiation.
  ResponseBytes reply_bytes{};
  std::size_t reply_size = 0;
};

// Decides who gets a session. Checks run in the order of their cost, so that an attacker who knows
// less costs less: size, magic, key id, expiry, cookie, use from another host, seal of the token,
// proof of the token's key, budgets, and only then X25519. Checking the proof has budgets of its
// own, for each token at each host and for all of them. Before the cookie is right, nothing
// is allocated and no state is kept. Afterwards the state is bounded by the number of sessions.
//
// The caller owns the sessions. It must Release() every accepted handshake when its session ends.
class Admission {
 public:
  // Keeps a reference to `random`.
  Admission(AdmissionSettings settings, RandomSource& random);

  // A token is free for another host when its sessions were silent for this long.
  static constexpr std::int64_t kTokenHoldMicroseconds = 5'000'000;

  // Replaces the keys, for example after the key file changed.
  void SetKeys(KeyRing keys) { keys_ = std::move(keys); }
  [[nodiscard]] bool HasKey(std::uint32_t id) const { return keys_.Find(id) != nullptr; }

  // Handles a datagram of the kind kInitiation. `server_index`: of the session that would begin, or
  // 0 if no session is free. `accepted` is filled if the outcome is kAccepted.
  [[nodiscard]] AdmissionResult OnInitiation(ByteView datagram, const PeerAddress& from, Now now,
                                             std::uint32_t server_index,
                                             AcceptedHandshake& accepted);

  // Checks a token that a client shows inside of a session, and moves the session to it. `expires`
  // is updated with `grant`. On a refusal nothing changes.
  [[nodiscard]] Refusal Renew(ByteView renewal, const Hash& handshake_hash, std::uint32_t index,
                              Now now, Grant& grant, std::uint64_t& expires, TokenUse*& use);

  // Goes on with a session that another server has admitted. Returns the use of its token.
  [[nodiscard]] TokenUse& Resume(const SessionState& state);

  // Forgets a session. Its token is free when it was the last one.
  void Release(const PublicKey& client_key, TokenUse* use, std::uint32_t index);

  // The cookies, which also prove new addresses of a session.
  [[nodiscard]] CookieMaker& cookies() { return cookies_; }

  [[nodiscard]] std::size_t num_tokens_in_use() const { return uses_.size(); }
  [[nodiscard]] std::uint64_t num_refused(Refusal refusal) const {
    return refused_[static_cast<std::size_t>(refusal)];
  }
  [[nodiscard]] std::uint64_t num_retries() const { return retries_; }
  [[nodiscard]] std::uint64_t num_accepted() const { return accepted_; }

 private:
  // A token that passed the checks of its public part.
  struct KnownToken {
    TokenHead head;
    const TokenKey* key = nullptr;
  };
  // The keys are random, or come from a trusted issuer.
  struct FirstBytes {
    template <std::size_t N>
    std::size_t operator()(const std::array<std::uint8_t, N>& bytes) const {
      return LoadLittle<std::size_t>(bytes.data());
    }
  };

  [[nodiscard]] Refusal CheckHead(TokenView token, Now now, KnownToken& known) const;
  [[nodiscard]] Refusal CheckUse(const TokenNonce& nonce, const PeerAddress& from, Now now) const;
  [[nodiscard]] Refusal CheckContent(TokenView token, const KnownToken& known,
                                     OpenedToken& opened) const;
  [[nodiscard]] Refusal Shake(const InitiationView& view, const KnownToken& known,
                              const PeerAddress& from, Now now, std::uint32_t server_index,
                              AcceptedHandshake& accepted, ResponseBytes& response);
  [[nodiscard]] TokenUse& UseOf(const TokenHead& head, const std::array<std::uint8_t, 16>& host);
  void Detach(TokenUse* use, std::uint32_t index);
  [[nodiscard]] AdmissionResult Refuse(Refusal refusal, std::uint32_t client_index);

  AdmissionSettings settings_;
  RandomSource& random_;
  KeyRing keys_;
  CookieMaker cookies_;
  RateBudget handshakes_;
  RateBudget attempts_;
  HostBudgets attempts_of_hosts_;
  std::unordered_map<TokenNonce, TokenUse, FirstBytes> uses_;
  std::unordered_map<PublicKey, ResponseBytes, FirstBytes> responses_;
  std::array<std::uint64_t, kNumRefusals> refused_{};
  std::uint64_t retries_ = 0;
  std::uint64_t accepted_ = 0;
};

}  // namespace furrow::protocol::secure
