// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "base/status.h"
#include "protocol/secure/handshake/handshake_packets.h"
#include "protocol/secure/token/key_ring.h"
#include "server/core/metrics.h"
#include "server/core/security.h"
#include "server/core/time.h"
#include "server/session/access/access.h"

namespace furrow::server {

// The message for a client without a token, where it may show one.
inline constexpr char kNeedsTokenText[] =
    "the daemon requires a token: make one with 'furrow token new', connect with --token FILE";
// The same where it may not. A client that is asked for a token would send it in clear text, and a
// refusal comes too late.
inline constexpr char kNoTokenHereText[] =
    "the daemon requires a token, and takes none over TCP and HTTP from other computers, because "
    "they are not encrypted: use UDP, or start the daemon with --tls-certificate";

struct GateSettings {
  Security security = Security::kOpen;
  std::string name;  // of this daemon: the audience of tokens; may be empty
  // Accepts tokens over plain TCP and HTTP, which everybody on the way can read, from other
  // computers.
  bool tokens_in_clear = false;
};

// Admits those who show a connect token in text form, over TCP and HTTP. Over UDP, clients prove
// what they know without showing it (protocol/secure/session). Safe to use on several threads.
class TokenGate {
 public:
  // `unix_now`: the time of the system clock, Unix seconds. `metrics`: not null; outlives the gate.
  TokenGate(GateSettings settings, std::function<std::uint64_t()> unix_now, Metrics* metrics)
      : settings_(std::move(settings)), unix_now_(std::move(unix_now)), metrics_(metrics) {}

  // Replaces the keys, for example after the key file changed.
  void SetKeys(protocol::secure::KeyRing keys);
  [[nodiscard]] bool HasKey(std::uint32_t id) const;
  [[nodiscard]] std::shared_ptr<const protocol::secure::KeyRing> keys() const;
  // The time of the system clock, Unix seconds.
  [[nodiscard]] std::uint64_t unix_now() const { return unix_now_(); }

  [[nodiscard]] const GateSettings& settings() const { return settings_; }
  [[nodiscard]] bool required() const { return settings_.security == Security::kRequired; }
  // What a peer may do that has shown nothing yet.
  [[nodiscard]] Access Stranger() const { return required() ? Access() : Access::Everything(); }

  // False: a client must not even be asked for its token, which would be sent in clear text.
  // `shielded`: as for Admit().
  [[nodiscard]] bool TakesTokens(bool shielded) const {
    return shielded || settings_.tokens_in_clear;
  }
  // The reply over TCP and HTTP to a client without a token.
  [[nodiscard]] const char* WhyNeeded(bool shielded) const {
    return TakesTokens(shielded) ? kNeedsTokenText : kNoTokenHereText;
  }

  // Opens a token that a client has shown. `shielded`: nobody on the network can read it, because
  // the client is on this computer or speaks TLS. Errors (kInvalidArgument): a sentence for the
  // client. Refusals are counted by reason.
  [[nodiscard]] Result<Access> Admit(std::string_view token, bool shielded, Time now) const;

  // When a token expires, on the daemon's clock. `expires`: Unix time in seconds.
  [[nodiscard]] Time ExpiryOf(std::uint64_t expires, Time now) const;

 private:
  [[nodiscard]] Result<Access> Refuse(protocol::secure::Refusal refusal) const;

  const GateSettings settings_;
  const std::function<std::uint64_t()> unix_now_;
  Metrics* const metrics_;
  mutable std::mutex mutex_;  // guards keys_
  std::shared_ptr<const protocol::secure::KeyRing> keys_ =
      std::make_shared<const protocol::secure::KeyRing>();
};

// The counter of a reason.
[[nodiscard]] Counter RefusalCounter(protocol::secure::Refusal refusal);

}  // namespace furrow::server
