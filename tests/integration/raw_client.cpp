// SPDX-License-Identifier: Apache-2.0
#include "raw_client.h"

#include <array>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace furrow::testing_net {
int ConnectSocket(int type, std::uint16_t port, const char* from) {
  const int socket = ::socket(AF_INET, type, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  ::inet_pton(AF_INET, from, &own.sin_addr);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::bind(socket, reinterpret_cast<sockaddr*>(&own), sizeof(own)) != 0 ||
      ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
    ::close(socket);
    return -1;
  }
  return socket;
}

RawClient::~RawClient() {
  if (socket_ >= 0) ::close(socket_);
}

void RawClient::SendRaw(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // closed by the other end: what follows will show it
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

long RawClient::ReadSome(std::span<std::uint8_t> buffer) {
  pollfd poll_socket{socket_, POLLIN, 0};
  if (::poll(&poll_socket, 1, static_cast<int>(std::chrono::milliseconds(kGuard).count())) <= 0)
    return -1;
  return ::recv(socket_, buffer.data(), buffer.size(), 0);
}

std::optional<Received> RawClient::Next() {
  for (;;) {
    while (ready_.empty()) {
      if (!Fill()) return std::nullopt;
    }
    Received received;
    received.bytes = std::move(ready_.front());
    ready_.pop_front();
    if (protocol::OpenMessage(received.bytes, received.view, protocol::kMaxReplyBytes) !=
        protocol::DecodeStatus::kOk) {
      return std::nullopt;
    }
    protocol::Ping challenge;
    if (received.view.kind != protocol::MessageKind::kPing ||
        protocol::Decode(received.view, challenge) != protocol::DecodeStatus::kOk) {
      return received;
    }
    ++challenges_;
    Send(protocol::Pong{challenge.time_us, 0});
  }
}

bool RawClient::AwaitClose() {
  while (auto received = Next()) skipped.push_back(*std::move(received));
  std::array<std::uint8_t, 16> rest;
  return ReadSome(rest) <= 0;
}

std::uint16_t RawClient::local_port() const {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

TcpClient::TcpClient(std::uint16_t port) : RawClient(ConnectSocket(SOCK_STREAM, port)) {}

void TcpClient::SendBytes(std::span<const std::uint8_t> message) {
  // In one piece: two would wait for each other's acknowledgement (Nagle).
  const auto prefix = protocol::FramePrefix(message.size());
  std::vector<std::uint8_t> frame(prefix.begin(), prefix.end());
  frame.insert(frame.end(), message.begin(), message.end());
  SendRaw(frame);
}

bool TcpClient::Fill() {
  std::array<std::uint8_t, 16384> buffer;
  const long size = ReadSome(buffer);
  if (size <= 0) return false;
  std::span<const std::uint8_t> bytes(buffer.data(), static_cast<std::size_t>(size));
  std::span<const std::uint8_t> frame;
  while (!bytes.empty()) {
    const protocol::FrameStatus status = frames_.Push(bytes, frame);
    if (status == protocol::FrameStatus::kBadLength) return false;
    if (status == protocol::FrameStatus::kFrame) ready_.emplace_back(frame.begin(), frame.end());
  }
  return true;
}

UdpClient::UdpClient(std::uint16_t port, const char* from)
    : RawClient(ConnectSocket(SOCK_DGRAM, port, from)) {}

void UdpClient::SendBytes(std::span<const std::uint8_t> message) {
  const std::size_t count = protocol::NumDatagrams(message.size());
  const std::uint32_t id = message_id_++;
  std::array<std::uint8_t, protocol::kMaxDatagramBytes> datagram;
  for (std::size_t index = 0; index < count; ++index) {
    const std::size_t size = protocol::WriteDatagram(message, id, index, datagram);
    SendRaw({datagram.data(), size});
  }
}

bool UdpClient::Fill() {
  std::array<std::uint8_t, 2048> buffer;
  const long size = ReadSome(buffer);
  if (size <= 0) return false;
  ++datagrams_;
  const auto datagram = std::span(buffer).first(static_cast<std::size_t>(size));
  std::span<const std::uint8_t> message;
  const auto status = reassembler_.Push({}, datagram, 0, message);
  if (status == protocol::FragmentStatus::kWhole && bundles_) {
    protocol::Unbundler unbundler;
    if (unbundler.Open(datagram) != protocol::BundleStatus::kOk) return false;
    while (unbundler.Next(message)) ready_.emplace_back(message.begin(), message.end());
  } else if (status == protocol::FragmentStatus::kWhole ||
             status == protocol::FragmentStatus::kComplete) {
    ready_.emplace_back(message.begin(), message.end());
  }
  return true;
}

bool UdpClient::Prove(bool bundles) {
  bundles_ = bundles;
  Send(protocol::Hello{"test", 0, bundles}, 0, 1);
  const auto welcome = Await<protocol::Welcome>();
  if (!welcome) return false;
  Send(protocol::Hello{"test", welcome->token, bundles}, 0, 2);
  const auto proven = Await<protocol::Welcome>();
  return proven_ = proven && proven->token == 0;
}

}  // namespace furrow::testing_net
