// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/token_issuer.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include <spdlog/spdlog.h>

#include "protocol/messages/pattern.h"
#include "protocol/secure/token/token_text.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;

std::vector<std::string_view> GlobsOf(std::string_view pattern) {
  std::vector<std::string_view> globs;
  while (!pattern.empty()) globs.push_back(protocol::NextGlob(&pattern));
  return globs;
}

Status Forbidden(const std::string& what, const std::string& field, const Access& maker) {
  return {StatusCode::kUnsupported, what + "; " + maker.Text(), field};
}

}  // namespace

bool IsWithin(std::string_view inner, std::string_view outer) {
  const std::vector<std::string_view> outer_globs = GlobsOf(outer);
  return std::ranges::all_of(GlobsOf(inner), [&](std::string_view glob) {
    if (glob.empty()) return true;  // matches nothing
    const bool listed = std::ranges::any_of(
        outer_globs, [&](std::string_view other) { return other == "*" || other == glob; });
    const bool is_name = glob.find_first_of("*?") == std::string_view::npos;
    return listed || (is_name && protocol::MatchesPattern(outer, glob));
  });
}

Result<TokenIssuer::Issued> TokenIssuer::Issue(const Access& maker, const Wanted& wanted,
                                               Time now) {
  if (!maker.by_token()) {
    return Status(StatusCode::kUnsupported, "tokens are made for holders of a token only", "",
                  "show a token with the role operate, or use 'furrow token new'");
  }
  if (!maker.Has(Role::kOperate)) return Forbidden("the role operate is needed", "", maker);
  const secure::Grant& own = maker.grant();
  if ((wanted.roles.bits() & ~own.roles.bits()) != 0) {
    return Forbidden("a new token can have no further role", "roles", maker);
  }
  secure::Grant grant = own;  // also the audience and the rate
  grant.roles = wanted.roles;
  if (!wanted.audience.empty()) {
    if (!own.audience.empty() && own.audience != wanted.audience) {
      return Forbidden("a new token can be for no further server", "audience", maker);
    }
    grant.audience = wanted.audience;
  }
  if (!wanted.subjects.empty()) grant.subjects = wanted.subjects;
  if (!IsWithin(grant.subjects, own.subjects)) {
    return Forbidden("a new token can have no further subject", "subjects", maker);
  }
  const auto left = std::chrono::duration_cast<std::chrono::seconds>(maker.expires() - now);
  if (wanted.seconds > static_cast<std::uint64_t>(std::max<std::int64_t>(0, left.count()))) {
    return Status(StatusCode::kUnsupported,
                  "a new token cannot be valid longer than yours, which ends in " +
                      std::to_string(left.count()) + " s",
                  "for");
  }
  const std::uint64_t unix_now = gate_->unix_now();
  const std::uint64_t expires = unix_now + wanted.seconds;
  const auto ring = gate_->keys();
  // The key of the maker's token: when it is retired, the tokens that were made with it end, too.
  const secure::TokenKey* const key = ring->Find(maker.key_id());
  if (key == nullptr || key->expires < expires) {
    return Status(StatusCode::kUnavailable, "the key of your token is not valid for that time",
                  "for", "use a shorter time");
  }
  const std::int64_t now_us = ToMicroseconds(now);
  if (!budget_.Take(now_us)) {
    return Status(StatusCode::kLimit, "too many tokens are made at the moment", "", "try again");
  }
  secure::RandomSource& random = secure::SystemRandom();
  grant.client_id = random.Number<std::uint64_t>();
  const auto token = secure::MakeToken(key->id, key->key, expires, grant, random);
  if (!token.ok()) return token.status().At("subjects");
  metrics_->Add(Counter::kTokensMade);
  spdlog::info("made a token for {} of '{}' for {} s", ToText(grant.roles), grant.subjects,
               wanted.seconds);
  return Issued{ToText(*token), expires, grant.subjects};
}

}  // namespace furrow::server
