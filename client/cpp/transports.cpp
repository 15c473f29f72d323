// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/transports.h"

#include <array>
#include <random>
#include <thread>
#include <vector>

#include "client/cpp/backoff.h"
#include "client/cpp/clock.h"
#include "client/cpp/connect_error.h"
#include "client/cpp/datagram_socket.h"
#include "client/cpp/secure_transport.h"
#include "client/cpp/tcp_transport.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

using Clock = std::chrono::steady_clock;

class UdpTransport : public Transport {
 public:
  UdpTransport() : Transport(TransportKind::kUdp) {}

  asio::error_code Connect(const std::string& host, std::uint16_t port) {
    return socket_.Connect(host, port);
  }

  IoStatus Send(std::span<const std::uint8_t> message) override {
    if (message.size() > protocol::kMaxUdpMessageBytes) return IoStatus::kTooLarge;
    const std::size_t count = protocol::NumDatagrams(message.size());
    const std::uint32_t id = next_message_id_++;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t bytes = protocol::WriteDatagram(message, id, i, datagram_);
      const IoStatus status = socket_.Send(std::span(datagram_).first(bytes));
      if (status != IoStatus::kOk) return status;
    }
    return IoStatus::kOk;
  }

  IoStatus Receive(std::span<const std::uint8_t>& message,
                   std::chrono::milliseconds timeout) override {
    constexpr int kMaxPieces = 1024;  // a flood of fragments must not outlast the timeout
    const auto deadline = Clock::now() + timeout;
    (void)reassembler_.Expire(Microseconds(Clock::now()));
    for (int piece = 0; piece < kMaxPieces; ++piece) {
      if (unbundler_.Next(message)) return IoStatus::kOk;
      std::span<std::uint8_t> datagram;
      const IoStatus read = socket_.Receive(deadline, datagram);
      if (read != IoStatus::kOk) return read;
      switch (reassembler_.Push({}, datagram, Microseconds(Clock::now()), message)) {
        case protocol::FragmentStatus::kWhole: (void)unbundler_.Open(datagram); break;
        case protocol::FragmentStatus::kComplete: return IoStatus::kOk;
        default: break;  // an incomplete message or a foreign datagram
      }
    }
    return IoStatus::kTimeout;
  }

  [[nodiscard]] bool takes_bundles() const override { return true; }

 private:
  DatagramSocket socket_;
  std::array<std::uint8_t, protocol::kMaxDatagramBytes> datagram_{};
  protocol::Unbundler unbundler_;  // splits the last datagram
  protocol::Reassembler reassembler_;
  std::uint32_t next_message_id_ = 0;
};

// Tries again, until the time is over, while the daemon closes the connection during the handshake.
Result<std::unique_ptr<Transport>> OpenTcp(const std::string& host, std::uint16_t port,
                                           std::chrono::milliseconds timeout,
                                           const Security& security) {
  const auto deadline = Clock::now() + timeout;
  Backoff backoff(std::random_device{}(), {});
  for (;;) {
    auto transport = std::make_unique<TcpTransport>(timeout, security);
    FURROW_RETURN_IF_ERROR(transport->Begin(host, port));
    Status status = transport->Await(deadline);
    if (status.ok()) return std::unique_ptr<Transport>(std::move(transport));
    backoff.Failed(SteadyMicroseconds());
    const std::chrono::microseconds pause(backoff.Wait(SteadyMicroseconds()));
    if (!transport->handshake_cut() || Clock::now() + pause >= deadline) return status;
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace

Result<std::unique_ptr<Transport>> OpenTransport(TransportKind kind, const std::string& host,
                                                 std::uint16_t port,
                                                 std::chrono::milliseconds timeout,
                                                 const Security& security) {
  if (kind == TransportKind::kUdp && security.token) {
    auto transport = std::make_unique<SecureTransport>(*security.token);
    const asio::error_code code = transport->Connect(host, port);
    if (code) return ConnectError(TransportKind::kUdp, host, port, code);
    if (transport->Await(Clock::now() + timeout))
      return std::unique_ptr<Transport>(std::move(transport));
    if (transport->refusal() == protocol::secure::Refusal::kNone) {
      return ConnectionFailed(kind, host, port, transport->failure());
    }
    return Status(StatusCode::kInvalidArgument, transport->failure(), AddressText(host, port));
  }
  if (kind == TransportKind::kUdp) return BeginTransport(kind, host, port, timeout);
  return OpenTcp(host, port, timeout, security);
}

Result<std::unique_ptr<Transport>> BeginTransport(TransportKind kind, const std::string& host,
                                                  std::uint16_t port,
                                                  std::chrono::milliseconds send_timeout,
                                                  const Security& security) {
  if (kind == TransportKind::kTcp) {
    auto transport = std::make_unique<TcpTransport>(send_timeout, security);
    FURROW_RETURN_IF_ERROR(transport->Begin(host, port));
    return std::unique_ptr<Transport>(std::move(transport));
  }
  asio::error_code code;
  std::unique_ptr<Transport> result;
  if (security.token) {
    auto transport = std::make_unique<SecureTransport>(*security.token);
    code = transport->Connect(host, port);
    result = std::move(transport);
  } else {
    auto transport = std::make_unique<UdpTransport>();
    code = transport->Connect(host, port);
    result = std::move(transport);
  }
  if (code) return ConnectError(TransportKind::kUdp, host, port, code);
  return result;
}

}  // namespace furrow::client
