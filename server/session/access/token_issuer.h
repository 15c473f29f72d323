// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "base/status.h"
#include "protocol/secure/session/rate_budget.h"
#include "protocol/secure/token/connect_token.h"
#include "server/core/metrics.h"
#include "server/session/access/access.h"
#include "server/session/access/token_gate.h"

namespace furrow::server {

// Makes tokens for holders of the role operate, to hand on. A new token never allows more than the
// token of its maker: no further role, subject, packet rate or server, and no later end. Not
// thread-safe.
class TokenIssuer {
 public:
  static constexpr std::uint32_t kPerSecond = 10;

  // `gate`, `metrics`: not null; outlive the issuer.
  TokenIssuer(const TokenGate* gate, Metrics* metrics) : gate_(gate), metrics_(metrics) {}

  struct Wanted {
    protocol::secure::Roles roles;
    std::string subjects;       // globs; empty: those of the maker
    std::uint64_t seconds = 0;  // until the end; greater than 0
    std::string audience = {};  // the only server that accepts it; empty: that of the maker
  };
  struct Issued {
    std::string text;
    std::uint64_t expires = 0;  // Unix time in seconds
    std::string subjects;
  };
  // Errors: kUnsupported (the maker has shown no token, lacks the role operate, or has less itself;
  // `where` is the field), kLimit (too many per second), kInvalidArgument (malformed subjects),
  // kUnavailable (no key is valid).
  [[nodiscard]] Result<Issued> Issue(const Access& maker, const Wanted& wanted, Time now);

 private:
  const TokenGate* const gate_;
  Metrics* const metrics_;
  protocol::secure::RateBudget budget_{kPerSecond};
};

// True if every glob of `inner` certainly matches nothing that `outer` does not match: it is one of
// the globs of `outer`, or has no wildcard and matches, or `outer` has the glob "*". Both are
// comma-separated globs.
[[nodiscard]] bool IsWithin(std::string_view inner, std::string_view outer);

}  // namespace furrow::server
