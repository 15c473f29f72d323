// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/token_gate.h"

#include <algorithm>
#include <chrono>

#include "protocol/secure/token/token_text.h"

namespace furrow::server {

namespace secure = protocol::secure;
using secure::Refusal;

Counter RefusalCounter(Refusal refusal) {
  switch (refusal) {
    case Refusal::kUnknownSession: return Counter::kRefusedUnknownSession;
    case Refusal::kUnknownKey: return Counter::kRefusedUnknownKey;
    case Refusal::kExpired: return Counter::kRefusedExpired;
    case Refusal::kForgedToken: return Counter::kRefusedForgedToken;
    case Refusal::kWrongAudience: return Counter::kRefusedWrongServer;
    case Refusal::kTokenInUse: return Counter::kRefusedTokenInUse;
    case Refusal::kForgedHandshake: return Counter::kRefusedForgedHandshake;
    case Refusal::kBusy: return Counter::kRefusedBusy;
    case Refusal::kFull: return Counter::kRefusedFull;
    case Refusal::kNone:
    case Refusal::kBadInitiation:
    case Refusal::kBadToken: break;
  }
  return Counter::kRefusedMalformed;
}

void TokenGate::SetKeys(secure::KeyRing keys) {
  auto shared = std::make_shared<const secure::KeyRing>(std::move(keys));
  const std::lock_guard lock(mutex_);
  keys_ = std::move(shared);
}

std::shared_ptr<const secure::KeyRing> TokenGate::keys() const {
  const std::lock_guard lock(mutex_);
  return keys_;
}

bool TokenGate::HasKey(std::uint32_t id) const { return keys()->Find(id) != nullptr; }

Result<Access> TokenGate::Refuse(Refusal refusal) const {
  metrics_->Add(RefusalCounter(refusal));
  return Status(StatusCode::kInvalidArgument,
                std::string("the daemon refuses the token: ") + RefusalText(refusal));
}

// The public part of a token can be seen on the network, so the client key must be shown, too.
Result<Access> TokenGate::Admit(std::string_view text, bool shielded, Time now) const {
  if (!TakesTokens(shielded)) {
    metrics_->Add(Counter::kRefusedInClear);
    return Status(StatusCode::kInvalidArgument,
                  "the daemon takes tokens over TCP and HTTP from its own computer only, because "
                  "they are not encrypted; use UDP, or start the daemon with --tls-certificate");
  }
  const auto token = secure::ParseToken(text);
  if (!token.ok()) return Refuse(Refusal::kBadToken);
  secure::TokenHead head;
  if (ReadTokenHead(token->bytes, head) != secure::TokenStatus::kOk) {
    return Refuse(Refusal::kBadToken);
  }
  const auto ring = keys();
  const secure::TokenKey* const key = ring->Find(head.key_id);
  if (key == nullptr) return Refuse(Refusal::kUnknownKey);
  const std::uint64_t expires = std::min(head.expires, key->expires);
  if (unix_now_() >= expires) return Refuse(Refusal::kExpired);
  secure::OpenedToken opened;
  if (OpenToken(token->bytes, key->key, opened) != secure::TokenStatus::kOk ||
      !secure::EqualInConstantTime(opened.key.bytes(), token->key.bytes())) {
    return Refuse(Refusal::kForgedToken);
  }
  const std::string& audience = opened.grant.audience;
  if (!audience.empty() && audience != settings_.name) return Refuse(Refusal::kWrongAudience);
  return Access::Of(opened.grant, head.key_id, ExpiryOf(expires, now));
}

Time TokenGate::ExpiryOf(std::uint64_t expires, Time now) const {
  const std::uint64_t unix_now = unix_now_();
  constexpr std::uint64_t kLongest = std::uint64_t{100} * 365 * 86'400;  // fits into Time
  const std::uint64_t left = expires > unix_now ? std::min(expires - unix_now, kLongest) : 0;
  return now + std::chrono::seconds(left);
}

}  // namespace furrow::server
