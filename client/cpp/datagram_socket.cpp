// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/datagram_socket.h"

#include <cerrno>
#include <utility>

#include <asio/buffer.hpp>
#include <sys/socket.h>
#include <sys/time.h>

namespace furrow::client {

using asio::ip::udp;

asio::error_code DatagramSocket::Connect(const std::string& host, std::uint16_t port) {
  asio::error_code error;
  udp::resolver resolver(context_);
  const auto endpoints = resolver.resolve(host, std::to_string(port), error);
  if (error) return error;
  // Picks the first routable address, IPv4 first, because the daemon binds to IPv4 by default.
  for (const bool want_v4 : {true, false}) {
    // A UDP connect sends nothing; it only fixes the peer. It fails if there is no route.
    for (const auto& entry : endpoints) {
      if (entry.endpoint().address().is_v4() != want_v4) continue;
      asio::error_code ignored;
      socket_.close(ignored);
      socket_.open(entry.endpoint().protocol(), error);
      if (!error) socket_.connect(entry.endpoint(), error);
      if (!error) return error;
    }
  }
  return error;
}

IoStatus DatagramSocket::Send(std::span<const std::uint8_t> datagram) {
  asio::error_code error;
  socket_.send(asio::buffer(datagram.data(), datagram.size()), 0, error);
  // The error reports an earlier datagram. This one was not sent, so send it once more.
  if (error == asio::error::connection_refused) {
    refused_ = true;
    socket_.send(asio::buffer(datagram.data(), datagram.size()), 0, error);
  }
  return error ? IoStatus::kNoConnection : IoStatus::kOk;
}

// Sleeps in recv() itself, one system call per datagram; asio's reactor takes several and wakes up
// later (docs/PERFORMANCE.md, "The same machine").
IoStatus DatagramSocket::Receive(Clock::time_point deadline, std::span<std::uint8_t>& datagram) {
  if (std::exchange(refused_, false)) return IoStatus::kNoConnection;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    const bool waits = left.count() > 0 && SetWait(left);
    const ssize_t size =
        recv(socket_.native_handle(), buffer_.data(), buffer_.size(), waits ? 0 : MSG_DONTWAIT);
    if (size >= 0) {
      datagram = std::span(buffer_).first(static_cast<std::size_t>(size));
      return IoStatus::kOk;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return IoStatus::kNoConnection;
    if (!waits) return IoStatus::kTimeout;
  }
}

// Limits how long recv() sleeps. Callers mostly wait for the same time again.
bool DatagramSocket::SetWait(std::chrono::milliseconds wait) {
  if (wait == wait_) return true;
  const timeval time{wait.count() / 1000, wait.count() % 1000 * 1000};
  if (setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &time, sizeof(time)) != 0) {
    return false;
  }
  wait_ = wait;
  return true;
}

}  // namespace furrow::client
