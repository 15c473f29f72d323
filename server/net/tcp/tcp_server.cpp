// SPDX-License-Identifier: Apache-2.0
#include "server/net/tcp/tcp_server.h"

#include <chrono>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "protocol/framing/tcp_framing.h"
#include "server/core/network_address.h"
#include "server/net/await_tuple.h"
#include "server/net/critical_task.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;
constexpr auto kAcceptPause = std::chrono::milliseconds(100);

// Sends one reply on a connection that is refused. The buffer of a new socket has room for it. If
// the send fails, the client only sees the connection close.
class RefusalLink : public Link {
 public:
  explicit RefusalLink(tcp::socket* socket) : socket_(socket) {}
  void SendReply(std::span<const std::uint8_t> message) override {
    const auto prefix = protocol::FramePrefix(message.size());
    std::vector<std::uint8_t> frame(prefix.begin(), prefix.end());
    frame.insert(frame.end(), message.begin(), message.end());
    asio::error_code error;
    // The acceptor waits for nobody: a client that does not read loses its reply.
    socket_->non_blocking(true, error);
    socket_->send(asio::buffer(frame), 0, error);
    // Tells the client that nothing follows. The socket closes when Refuse() returns.
    socket_->shutdown(tcp::socket::shutdown_send, error);
  }
  int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
    return 0;
  }
  void DropFrames(std::uint64_t) override {}

 private:
  tcp::socket* socket_;
};

}  // namespace

TcpServer::TcpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics)
    : io_(io),
      acceptor_(io),
      limits_(limits),
      hub_(hub),
      metrics_(metrics),
      shares_(static_cast<std::size_t>(limits.max_connections)) {}

Status TcpServer::Open(const tcp::endpoint& endpoint) {
  asio::error_code error;
  acceptor_.open(endpoint.protocol(), error);
  // Allows a port in TIME_WAIT. A port with a listener stays an error.
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
  if (!error) return {};
  return Status(StatusCode::kUnavailable,
                "cannot listen on TCP " + endpoint.address().to_string() + " port " +
                    std::to_string(endpoint.port()) + ": " + error.message(),
                "", "stop the program that uses the port, or set another one with --tcp");
}

std::uint16_t TcpServer::port() const {
  asio::error_code error;
  return acceptor_.local_endpoint(error).port();
}

void TcpServer::Start() { StartCriticalTask(io_, Accept()); }

asio::awaitable<void> TcpServer::Accept() {
  while (acceptor_.is_open()) {
    // Completes with an error when Drain() closes the acceptor.
    auto [error, socket] = co_await acceptor_.async_accept(kAwaitTuple);
    if (!acceptor_.is_open()) co_return;
    if (error) {
      // No descriptors are left, or the peer has gone. The pause keeps the loop from spinning.
      spdlog::warn("cannot accept a connection: {}", error.message());
      asio::steady_timer pause(io_, kAcceptPause);
      co_await pause.async_wait(kAwaitTuple);
      continue;
    }
    const tcp::endpoint client = socket.remote_endpoint(error);
    const std::string host = error ? std::string() : HostOf(client.address().to_string());
    if (!shares_.Enter(host)) {
      Refuse(std::move(socket));
    } else {
      metrics_->Add(Counter::kConnectionsAccepted);
      const auto session = std::make_shared<TcpSession>(
          std::move(socket), limits_, hub_, metrics_,
          // Runs on this thread, in Close(). The server outlives its sessions: the daemon destroys
          // it after the event loop has ended.
          [this, host](const std::shared_ptr<TcpSession>& closed) {
            if (sessions_.erase(closed) > 0) shares_.Leave(host);
          });
      sessions_.insert(session);
      session->Start();
    }
  }
}

void TcpServer::Refuse(tcp::socket socket) {
  metrics_->Add(Counter::kConnectionsRefused);
  RefusalLink link(&socket);
  hub_->RefuseConnection(&link);
}

void TcpServer::Drain() {
  asio::error_code error;
  acceptor_.close(error);
  // CloseAfterFlush() never erases a session at once, so the loop may use the set.
  for (const auto& session : sessions_) session->CloseAfterFlush(/*linger=*/false);
}

void TcpServer::CloseAll() {
  while (!sessions_.empty()) (*sessions_.begin())->Close();
}

}  // namespace furrow::server
