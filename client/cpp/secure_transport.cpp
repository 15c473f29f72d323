// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/secure_transport.h"

#include <algorithm>
#include <utility>

#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

namespace secure = protocol::secure;
using secure::Refusal;

// The session has timers of its own, so no wait is longer.
constexpr std::chrono::milliseconds kPollInterval(50);

// Clients leave the expiry of tokens to the daemon, whose clock counts.
secure::Now At(DatagramSocket::Clock::time_point time) { return {.us = Microseconds(time)}; }

}  // namespace

// Without a hello: the program sends its own as soon as there is a session.
SecureTransport::SecureTransport(const secure::ClientToken& token)
    : Transport(TransportKind::kUdp), client_(token, {}) {}

// Tells the daemon, so that it need not wait for the silence of this client.
SecureTransport::~SecureTransport() {
  const std::size_t size = client_.Close(At(Clock::now()), packet_);
  if (size > 0) (void)socket_.Send(std::span(packet_).first(size));
}

std::string SecureTransport::failure() const {
  if (std::string why = RefusedTokenText(refusal_); !why.empty()) return why;
  if (refusal_ == Refusal::kBusy) return RefusalText(refusal_);
  return port_closed_ ? "connection refused" : "no answer";
}

bool SecureTransport::Await(Clock::time_point deadline) {
  std::span<std::uint8_t> datagram;
  for (auto now = Clock::now(); now < deadline && !Lasts(refusal_); now = Clock::now()) {
    port_closed_ = Maintain(now) == IoStatus::kNoConnection || port_closed_;
    switch (socket_.Receive(std::min(deadline, now + kPollInterval), datagram)) {
      case IoStatus::kOk: OnDatagram(datagram, Clock::now()); break;
      case IoStatus::kNoConnection: port_closed_ = true; break;
      default: break;
    }
    if (client_.connected()) return true;
  }
  return false;
}

// Sends what the session itself has to send.
IoStatus SecureTransport::Maintain(Clock::time_point now) {
  IoStatus status = IoStatus::kOk;
  while (const std::size_t size = client_.Poll(At(now), packet_)) {
    status = socket_.Send(std::span(packet_).first(size));
  }
  return status;
}

void SecureTransport::OnDatagram(std::span<std::uint8_t> datagram, Clock::time_point now) {
  inner_ = {};
  if (!secure::IsSecure(datagram)) return;  // nothing proves a plain answer
  const secure::ClientEvent event = client_.OnDatagram(datagram, At(now));
  if (event.connected) {
    ++generation_;
    refusal_ = Refusal::kNone;
    port_closed_ = false;
    // The first packet begins the session at the daemon.
    (void)Maintain(now);
  } else if (event.refusal != Refusal::kNone) {
    refusal_ = event.refusal;
  }
  inner_ = event.inner;
}

IoStatus SecureTransport::Send(std::span<const std::uint8_t> message) {
  if (message.size() > protocol::kMaxUdpMessageBytes) return IoStatus::kTooLarge;
  const std::size_t count = protocol::NumDatagrams(message.size());
  const std::uint32_t id = next_message_id_++;
  const auto now = Clock::now();
  for (std::size_t i = 0; i < count; ++i) {
    const auto inner =
        std::span(packet_).subspan(secure::kPacketHeaderBytes, protocol::kMaxDatagramBytes);
    const std::size_t size =
        protocol::WriteDatagram(message, id, i, inner) + secure::kPacketOverheadBytes;
    const auto packet = std::span(packet_).first(size);
    if (client_.Seal(packet, At(now)) != secure::SealStatus::kOk) return IoStatus::kNoConnection;
    if (const IoStatus status = socket_.Send(packet); status != IoStatus::kOk) return status;
  }
  return IoStatus::kOk;
}

IoStatus SecureTransport::Receive(std::span<const std::uint8_t>& message,
                                  std::chrono::milliseconds timeout) {
  constexpr int kMaxPieces = 1024;  // a flood of fragments must not outlast the timeout
  auto now = Clock::now();
  const auto deadline = now + timeout;
  (void)reassembler_.Expire(Microseconds(now));
  const std::uint64_t generation = generation_;
  for (int piece = 0; piece < kMaxPieces; ++piece) {
    if (unbundler_.Next(message)) return IoStatus::kOk;
    if (inner_.empty()) {
      if (Maintain(now) == IoStatus::kNoConnection) return IoStatus::kNoConnection;
      std::span<std::uint8_t> datagram;
      const IoStatus status = socket_.Receive(std::min(deadline, now + kPollInterval), datagram);
      now = Clock::now();
      if (status == IoStatus::kNoConnection) {
        port_closed_ = true;
        return status;
      }
      if (status == IoStatus::kOk) OnDatagram(datagram, now);
      if (Lasts(refusal_) && !connected()) return IoStatus::kNoConnection;
      // A new session: the caller sends its requests again.
      if (generation_ != generation) return IoStatus::kTimeout;
      if (status != IoStatus::kOk && now >= deadline) return status;
      if (inner_.empty()) continue;
    }
    const auto datagram = std::exchange(inner_, {});
    switch (reassembler_.Push({}, datagram, Microseconds(now), message)) {
      case protocol::FragmentStatus::kWhole: (void)unbundler_.Open(datagram); break;
      case protocol::FragmentStatus::kComplete: return IoStatus::kOk;
      default: break;  // an incomplete message or a foreign datagram
    }
  }
  return IoStatus::kTimeout;
}

}  // namespace furrow::client
