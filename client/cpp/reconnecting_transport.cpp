// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/reconnecting_transport.h"

#include <algorithm>
#include <random>
#include <thread>
#include <utility>

#include "client/cpp/clock.h"
#include "client/cpp/transports.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

// A message that arrives this long after opening proves that the connection works. An earlier one
// may be a refusal.
constexpr std::int64_t kProvenUs = 1'000'000;
// A UDP socket that only fails for this time is opened again.
constexpr std::int64_t kReopenUs = 5'000'000;
// The same if other servers may be there.
constexpr std::int64_t kReopenWithOthersUs = 500'000;
// No daemon can send a client back to a server that was lost for this time.
constexpr std::int64_t kLostUs = 3'000'000;
// The pause after an attempt that fails, as a multiple of the time that the attempt itself took.
// The system's resolver may block for seconds without a network.
constexpr std::int64_t kRestPerWork = 4;

// True if the client may show its token to servers that others have named. Over UDP they must know
// the token's key, and learn nothing. Over TCP they get the token itself: they need a certificate
// of the authority that the user has named, because any server has one of a public authority.
bool MayFollow(TransportKind kind, const Security& security) {
  if (kind == TransportKind::kUdp || !security.token) return true;
  return security.tls != nullptr && security.own_authority && !security.token_in_clear;
}

}  // namespace

ReconnectingTransport::ReconnectingTransport(TransportKind kind, Opener open, Clock now_us,
                                             const Backoff& backoff,
                                             std::unique_ptr<Transport> first)
    : Transport(kind),
      open_(std::move(open)),
      now_us_(std::move(now_us)),
      backoff_(backoff),
      inner_(std::move(first)) {
  if (inner_ == nullptr) return;
  up_ = true;
  generation_ = 1;
  inner_generation_ = inner_->generation();
  opened_us_ = up_us_ = now_us_();
}

std::unique_ptr<ReconnectingTransport> ReconnectingTransport::Create(
    TransportKind kind, const std::string& host, std::uint16_t port,
    std::chrono::milliseconds send_timeout, std::unique_ptr<Transport> first, Security security) {
  const auto open = [=] { return BeginTransport(kind, host, port, send_timeout, security); };
  auto transport = std::make_unique<ReconnectingTransport>(
      kind, open, &SteadyMicroseconds, Backoff(std::random_device()(), {}), std::move(first));
  if (!MayFollow(kind, security)) return transport;
  transport->FollowBy([=](const Elsewhere& server) {
    return BeginTransport(kind, server.host, kind == TransportKind::kUdp ? server.udp : server.tcp,
                          send_timeout, security);
  });
  return transport;
}

bool ReconnectingTransport::Open(std::int64_t now_us) {
  auto opened = server_ == 0 ? open_() : open_at_(servers_[server_]);
  if (!opened.ok()) {
    failure_ = opened.status().what();
    tls_failed_ = false;
    const std::int64_t after_us = now_us_();
    backoff_.Failed(after_us);
    backoff_.NotBefore(after_us + kRestPerWork * (after_us - now_us));
    TryNext(after_us);
    return false;
  }
  inner_ = *std::move(opened);
  opened_us_ = now_us;
  return true;
}

// The next attempt is made after a pause.
void ReconnectingTransport::Lose(std::int64_t now_us) {
  if (const std::string why = inner_->failure(); !why.empty()) failure_ = why;
  inner_.reset();
  up_ = false;
  abandoned_ = false;
  failing_since_us_.reset();
  // The server that the daemon has named is there; the next one may not be.
  if (std::exchange(moves_, false)) return;
  backoff_.Failed(now_us);
  TryNext(now_us);
}

void ReconnectingTransport::TryNext(std::int64_t now_us) {
  lost_ = servers_[server_];
  lost_us_ = now_us;
  server_ = (server_ + 1) % servers_.size();
}

bool ReconnectingTransport::GoTo(const Elsewhere& server) {
  const std::int64_t now_us = now_us_();
  std::erase_if(moves_us_, [now_us](std::int64_t moved_us) {
    return now_us - moved_us > kMoveWindow.count();
  });
  if (!open_at_ || server.host.empty()) return false;
  // The other servers learn later than this client that one is gone.
  const bool is_lost = lost_ == server && now_us - lost_us_ < kLostUs;
  if (is_lost || moves_us_.size() >= kMostMoves) return true;
  moves_us_.push_back(now_us);
  auto found = std::find(servers_.begin() + 1, servers_.end(), server);
  if (found == servers_.end()) {
    if (servers_.size() > protocol::kMaxOthers) servers_.pop_back();
    found = servers_.insert(servers_.end(), server);
  }
  server_ = static_cast<std::size_t>(found - servers_.begin());
  // Closed in Receive(), because received messages still point into the connection's buffers.
  moves_ = abandoned_ = true;
  return true;
}

void ReconnectingTransport::Remember(std::span<const Elsewhere> others) {
  if (!open_at_ || moves_) return;
  const Elsewhere present = servers_[server_];
  servers_.resize(1);
  for (const Elsewhere& other : others) {
    if (servers_.size() > protocol::kMaxOthers) break;
    if (!other.host.empty() && other != present) servers_.push_back(other);
  }
  if (server_ != 0) {
    server_ = servers_.size();
    servers_.push_back(present);
  }
}

// Waits for the next attempt, so that a caller's loop does not spin.
IoStatus ReconnectingTransport::Rest(std::int64_t now_us, std::chrono::milliseconds timeout) const {
  const std::chrono::microseconds pause(std::max<std::int64_t>(0, backoff_.Wait(now_us)));
  std::this_thread::sleep_for(std::min<std::chrono::microseconds>(pause, timeout));
  return IoStatus::kNoConnection;
}

IoStatus ReconnectingTransport::Send(std::span<const std::uint8_t> message) {
  // Also without a connection, because the message would never fit.
  const bool udp = kind() == TransportKind::kUdp;
  if (message.size() > (udp ? protocol::kMaxUdpMessageBytes : protocol::kMaxRequestBytes)) {
    return IoStatus::kTooLarge;
  }
  if (inner_ == nullptr || abandoned_) return IoStatus::kNoConnection;
  const IoStatus status = inner_->Send(message);
  if (status != IoStatus::kClosed) return status;
  // Closed in Receive(), because received messages still point into the connection's buffers.
  abandoned_ = true;
  return IoStatus::kNoConnection;
}

IoStatus ReconnectingTransport::Receive(std::span<const std::uint8_t>& message,
                                        std::chrono::milliseconds timeout) {
  const std::int64_t now_us = now_us_();
  if (inner_ != nullptr && abandoned_) Lose(now_us);
  if (inner_ == nullptr && (backoff_.Wait(now_us) > 0 || !Open(now_us))) {
    return Rest(now_us, timeout);
  }
  const IoStatus status = inner_->Receive(message, timeout);
  // A secure session may begin again in the same socket.
  if (inner_->connected() && (!up_ || inner_->generation() != inner_generation_)) {
    up_ = true;
    up_us_ = now_us;
    inner_generation_ = inner_->generation();
    refusal_ = protocol::secure::Refusal::kNone;
    ++generation_;
  }
  switch (status) {
    case IoStatus::kOk:
      // An open port alone proves nothing: it may close each connection at once.
      if (now_us - up_us_ >= kProvenUs) backoff_.Succeeded();
      failing_since_us_.reset();
      tls_failed_ = false;
      return status;
    case IoStatus::kTimeout:
      if (!up_ && now_us_() - opened_us_ > inner_->connect_timeout().count()) {
        return OnFailure(now_us_());
      }
      return status;
    default: return OnFailure(now_us_());
  }
}

IoStatus ReconnectingTransport::OnFailure(std::int64_t now_us) {
  if (!failing_since_us_) failing_since_us_ = now_us;
  if (const std::string why = inner_->failure(); !why.empty()) failure_ = why;
  refusal_ = inner_->refusal();
  tls_failed_ = inner_->tls_failed();
  const std::int64_t patience_us = has_others() ? kReopenWithOthersUs : kReopenUs;
  const bool keep =
      kind() == TransportKind::kUdp && up_ && now_us - *failing_since_us_ < patience_us;
  if (!keep) Lose(now_us);
  return IoStatus::kNoConnection;
}

}  // namespace furrow::client
