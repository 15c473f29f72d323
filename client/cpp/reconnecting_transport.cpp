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

// A TCP attempt that takes longer has failed.
constexpr std::int64_t kConnectTimeoutUs = 3'000'000;
// A UDP socket that only fails for this time is opened again.
constexpr std::int64_t kReopenUs = 5'000'000;
// The pause after an attempt that fails, as a multiple of the time that the attempt itself took.
// The system's resolver may block for seconds without a network.
constexpr std::int64_t kRestPerWork = 4;

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
  opened_us_ = now_us_();
}

std::unique_ptr<ReconnectingTransport> ReconnectingTransport::Create(
    TransportKind kind, const std::string& host, std::uint16_t port,
    std::chrono::milliseconds send_timeout, std::unique_ptr<Transport> first, Security security) {
  const auto open = [=] { return BeginTransport(kind, host, port, send_timeout, security); };
  return std::make_unique<ReconnectingTransport>(
      kind, open, &SteadyMicroseconds, Backoff(std::random_device()(), {}), std::move(first));
}

bool ReconnectingTransport::Open(std::int64_t now_us) {
  auto opened = open_();
  if (!opened.ok()) {
    failure_ = opened.status().what();
    tls_failed_ = false;
    const std::int64_t after_us = now_us_();
    backoff_.Failed(after_us);
    backoff_.NotBefore(after_us + kRestPerWork * (after_us - now_us));
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
  backoff_.Failed(now_us);
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
    inner_generation_ = inner_->generation();
    refusal_ = protocol::secure::Refusal::kNone;
    ++generation_;
  }
  switch (status) {
    case IoStatus::kOk:
      // An open port alone proves nothing: it may close each connection at once.
      backoff_.Succeeded();
      failing_since_us_.reset();
      tls_failed_ = false;
      return status;
    case IoStatus::kTimeout:
      if (!up_ && now_us_() - opened_us_ > kConnectTimeoutUs) return OnFailure(now_us_());
      return status;
    default: return OnFailure(now_us_());
  }
}

IoStatus ReconnectingTransport::OnFailure(std::int64_t now_us) {
  if (!failing_since_us_) failing_since_us_ = now_us;
  if (const std::string why = inner_->failure(); !why.empty()) failure_ = why;
  refusal_ = inner_->refusal();
  tls_failed_ = inner_->tls_failed();
  const bool keep = kind() == TransportKind::kUdp && up_ && now_us - *failing_since_us_ < kReopenUs;
  if (!keep) Lose(now_us);
  return IoStatus::kNoConnection;
}

}  // namespace furrow::client
