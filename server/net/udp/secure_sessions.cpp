// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/secure_sessions.h"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/text.h"
#include "server/net/clock.h"
#include "server/net/udp/udp_address.h"

namespace furrow::server {

namespace secure = protocol::secure;
using secure::OpenStatus;
using secure::Refusal;

SecureSessions::SecureSessions(const TokenGate* gate, std::function<std::uint64_t()> unix_now,
                               int max_sessions, int shards, Metrics* metrics)
    : gate_(gate),
      unix_now_(std::move(unix_now)),
      metrics_(metrics),
      server_({.admission = {.audience = gate->settings().name},
               .max_sessions = static_cast<std::size_t>(max_sessions)}),
      shard_of_(kPlaces),
      is_v4_(kPlaces),
      scope_of_(kPlaces),
      closed_(static_cast<std::size_t>(shards)),
      has_closed_(static_cast<std::size_t>(shards)) {}

secure::Now SecureSessions::At(Time now) const {
  return {.us = ToMicroseconds(now), .unix_s = unix_now_()};
}

SecureSessions::Outcome SecureSessions::OnDatagram(std::span<std::uint8_t> bytes,
                                                   const asio::ip::udp::endpoint& from, int shard,
                                                   Time now) {
  Outcome outcome;
  const std::lock_guard lock(mutex_);
  outcome.event = server_.OnDatagram(bytes, ToPeerAddress(from), At(now));
  const secure::ServerEvent& event = outcome.event;
  // Before a new session can get the place of one that has just ended.
  SortClosed();
  Count(event);
  if (Lasts(event.refusal)) {
    refusals_.Note([&] { return "udp " + from.address().to_string(); }, RefusalText(event.refusal),
                   now);
  }
  if (event.session == 0) return outcome;
  const std::size_t place = PlaceOf(event.session);
  if (event.opened) {
    shard_of_[place] = static_cast<std::uint8_t>(shard);
    is_v4_[place] = from.address().is_v4();
  }
  outcome.shard = shard_of_[place];
  // Of the address that the session sends to, not of one that has yet to prove itself.
  const secure::PeerAddress* const address = server_.AddressOf(event.session);
  if (address != nullptr && *address == ToPeerAddress(from)) scope_of_[place] = ScopeOf(from);
  if (!event.closed && (event.opened || event.renewed)) {
    outcome.access = AccessOf(event.session, now);
  }
  return outcome;
}

Access SecureSessions::AccessOf(std::uint32_t session, Time now) const {
  const auto info = server_.InfoOf(session);
  return Access::Of(*info.grant, info.key_id, gate_->ExpiryOf(info.expires, now));
}

void SecureSessions::Count(const secure::ServerEvent& event) {
  if (event.opened) metrics_->Add(Counter::kHandshakes);
  const std::uint64_t retries = server_.admission().num_retries();
  metrics_->Add(Counter::kHandshakeRetries, retries - std::exchange(retries_, retries));
  if (event.refusal != Refusal::kNone) metrics_->Add(RefusalCounter(event.refusal));
  switch (event.open_status) {
    case OpenStatus::kOk:
    case OpenStatus::kUnknownSession: return;
    case OpenStatus::kDuplicate:
    case OpenStatus::kTooOld: return metrics_->Add(Counter::kSealedReplayed);
    case OpenStatus::kBadHeader:
    case OpenStatus::kOldKey:
    case OpenStatus::kNotAuthentic:
    case OpenStatus::kExhausted: return metrics_->Add(Counter::kSealedForged);
  }
}

bool SecureSessions::Seal(std::uint32_t session, std::span<std::uint8_t> packet,
                          asio::ip::udp::endpoint& to) {
  const std::lock_guard lock(mutex_);
  secure::PeerAddress address;
  if (server_.Seal(session, packet, At(ReadClock()), address) != secure::SealStatus::kOk) {
    return false;
  }
  to = ToEndpoint(address, is_v4_[PlaceOf(session)], scope_of_[PlaceOf(session)]);
  return true;
}

std::vector<SavedSecureSession> SecureSessions::TakeAll() {
  const std::lock_guard lock(mutex_);
  std::vector<SavedSecureSession> all;
  for (secure::SessionState& session : server_.TakeAll()) {
    const std::size_t place = PlaceOf(session.index);
    all.push_back({.shard = shard_of_[place],
                   .is_v4 = is_v4_[place],
                   .scope = scope_of_[place],
                   .session = std::move(session)});
  }
  return all;
}

std::optional<Access> SecureSessions::Resume(const SavedSecureSession& saved, Time now) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t index = saved.session.index;
  if (saved.shard >= closed_.size() || !server_.Resume(saved.session, At(now))) {
    return std::nullopt;
  }
  const std::size_t place = PlaceOf(index);
  shard_of_[place] = saved.shard;
  is_v4_[place] = saved.is_v4;
  scope_of_[place] = saved.scope;
  return AccessOf(index, now);
}

void SecureSessions::SetKeys(secure::KeyRing keys) {
  const std::lock_guard lock(mutex_);
  const std::size_t before = server_.num_sessions();
  server_.SetKeys(std::move(keys));
  if (const std::size_t ended = before - server_.num_sessions(); ended > 0) {
    spdlog::warn("ended {} over UDP: the keys of their tokens were retired",
                 Counted(ended, "session"));
  }
  SortClosed();
}

void SecureSessions::Close(std::uint32_t session) {
  const std::lock_guard lock(mutex_);
  server_.Close(session);
}

void SecureSessions::Expire(Time now) {
  const std::lock_guard lock(mutex_);
  server_.Expire(At(now));
  SortClosed();
}

void SecureSessions::SortClosed() {
  for (const std::uint32_t session : server_.TakeClosed()) {
    const std::size_t shard = shard_of_[PlaceOf(session)];
    closed_[shard].push_back(session);
    has_closed_[shard].store(true, std::memory_order_relaxed);
  }
}

std::vector<std::uint32_t> SecureSessions::TakeClosed(int shard) {
  const std::lock_guard lock(mutex_);
  const auto index = static_cast<std::size_t>(shard);
  has_closed_[index].store(false, std::memory_order_relaxed);
  return std::exchange(closed_[index], {});
}

}  // namespace furrow::server
