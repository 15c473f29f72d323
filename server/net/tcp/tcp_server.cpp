// SPDX-License-Identifier: Apache-2.0
#include "server/net/tcp/tcp_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/steady_timer.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "protocol/framing/tcp_framing.h"
#include "server/core/network_address.h"
#include "server/core/within_memory.h"
#include "server/machine/listen_error.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/pause.h"
#include "server/tls/handshake_watch.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
// For a restart: the most that may wait for one client and for all. Clients that are further behind
// connect again.
constexpr std::size_t kMaxSavedBytesOfOne = std::size_t{256} << 10;
constexpr std::size_t kMaxSavedBytes = std::size_t{64} << 20;

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

// Waits for the first bytes, which stay in the socket. Nothing: the client has closed.
asio::awaitable<std::optional<bool>> SpeaksTls(StreamSocket& stream) {
  const auto [failed] = co_await stream.socket().async_wait(tcp::socket::wait_read, kAwaitTuple);
  std::array<std::uint8_t, kTlsPrefixBytes> first;
  asio::error_code error = failed;
  if (!error) stream.socket().non_blocking(true, error);
  std::size_t size = 0;
  if (!error) {
    size = stream.socket().receive(asio::buffer(first), tcp::socket::message_peek, error);
  }
  if (error) co_return std::nullopt;
  co_return LooksLikeTls(std::span(first).first(size));
}

}  // namespace

TcpServer::TcpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
                     WaitingBytes* waiting, const TlsIdentity* tls)
    : io_(io),
      acceptor_(io),
      limits_(limits),
      hub_(hub),
      metrics_(metrics),
      waiting_(waiting),
      tls_(tls),
      shares_(static_cast<std::size_t>(limits.max_connections)) {}

Status TcpServer::Adopt(const ServiceManager::Listener& listener) {
  asio::error_code error;
  acceptor_.assign(listener.is_v6 ? tcp::v6() : tcp::v4(), listener.socket, error);
  if (!error) return {};
  return Status(StatusCode::kUnavailable,
                "cannot use the socket 'tcp' of the service manager: " + error.message());
}

Status TcpServer::Open(const tcp::endpoint& endpoint) {
  asio::error_code error;
  acceptor_.open(endpoint.protocol(), error);
  // Allows a port in TIME_WAIT. A port with a listener stays an error.
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
  if (!error) return {};
  return ListenError("TCP", {endpoint.address().to_string(), endpoint.port()}, error.value(),
                     "--tcp");
}

HostPort TcpServer::address() const {
  asio::error_code error;
  const tcp::endpoint local = acceptor_.local_endpoint(error);
  return {local.address().to_string(), local.port()};
}

void TcpServer::SetLimits(const Limits& limits) {
  limits_ = limits;
  shares_.SetPlaces(static_cast<std::size_t>(limits.max_connections));
}

void TcpServer::Start() { StartCriticalTask(io_, Accept()); }

asio::awaitable<void> TcpServer::Accept() {
  while (acceptor_.is_open() && !leaves_) {
    // Completes with an error when Drain() closes the acceptor, or Leave() cancels this.
    auto [error, socket] = co_await acceptor_.async_accept(kAwaitTuple);
    // A connection that was accepted before has its place, also if the daemon leaves.
    if (!acceptor_.is_open() || (leaves_ && error)) co_return;
    if (error) {
      // No descriptors are left, or the peer has gone. The pause keeps the loop from spinning.
      accept_log_.Failed(error.message());
      co_await Pause(kAcceptPause);
      continue;
    }
    accept_log_.Accepted();
    const tcp::endpoint client = socket.remote_endpoint(error);
    try {
      const std::string host = error ? std::string() : HostOf(client.address().to_string());
      Lobby::Stay stay;
      if (lobby_.HasQueue(host) || !shares_.HasRoomFor(host)) {
        stay = lobby_.Enter(host, ReadClock());
      }
      if (stay == nullptr) {
        Admit(std::move(socket), host);
      } else {
        // Detached is safe: WaitForPlace() lets no exception out.
        asio::co_spawn(io_, WaitForPlace(std::move(socket), host, std::move(stay)), asio::detached);
      }
    } catch (const std::bad_alloc&) {
      metrics_->Add(Counter::kAllocationsFailed);  // it costs one connection, not the daemon
    }
  }
}

// Waits until a connection without use has given way to the newcomer.
asio::awaitable<void> TcpServer::WaitForPlace(tcp::socket socket, std::string host,
                                              Lobby::Stay stay) {
  try {
    const Time begun = ReadClock();
    Time again = begun;
    while (acceptor_.is_open() && !(lobby_.IsFirst(host, stay) && shares_.HasRoomFor(host))) {
      const Time now = ReadClock();
      if (now - begun >= Lobby::kPatience) break;
      if (now >= again) {
        if (!hub_->MakeRoom(Transport::kTcp, host, shares_.held(host) == 0, now)) break;
        again = now + Lobby::kAgain;
      }
      co_await Pause(Lobby::kPoll);
    }
    if (acceptor_.is_open()) Admit(std::move(socket), host);
  } catch (const std::bad_alloc&) {
    metrics_->Add(Counter::kAllocationsFailed);
  }
}

// Begins a session or a handshake, or refuses the connection.
void TcpServer::Admit(tcp::socket socket, const std::string& host) {
  if (!shares_.Enter(host)) {
    metrics_->Add(Counter::kConnectionsRefused);
    // A client that speaks TLS only sees that the connection closes.
    return Refuse(socket, protocol::ErrorCode::kLimit,
                  "this address has its share of the " + std::to_string(limits_.max_connections) +
                      " connections; see limits.max_connections");
  }
  try {
    auto stream = std::make_shared<StreamSocket>(std::move(socket));
    if (!tls_->enabled()) return Begin(std::move(stream), host);
    asio::co_spawn(
        io_,
        [this, stream = std::move(stream), host]() mutable {
          return BeginWithTls(std::move(stream), host);
        },
        [this, host](const std::exception_ptr& failed, bool begun) {
          if (failed || !begun) shares_.Leave(host);
        });
  } catch (const std::bad_alloc&) {
    shares_.Leave(host);
    throw;
  }
}

// The session has the place of the host in `shares_` once it is in `sessions_`.
void TcpServer::Begin(std::shared_ptr<StreamSocket> stream, const std::string& host) {
  metrics_->Add(Counter::kConnectionsAccepted);
  const auto session = Add(std::move(stream), host);
  try {
    session->Start();
  } catch (const std::bad_alloc&) {
    metrics_->Add(Counter::kAllocationsFailed);
    session->Close();  // gives the place back
  }
}

std::shared_ptr<TcpSession> TcpServer::Add(std::shared_ptr<StreamSocket> stream,
                                           const std::string& host) {
  auto session = std::make_shared<TcpSession>(
      std::move(stream), limits_, hub_, metrics_, waiting_,
      // Runs on this thread, in Close(). The server outlives its sessions: the daemon destroys it
      // after the event loop has ended.
      [this, host](const std::shared_ptr<TcpSession>& closed) {
        if (sessions_.erase(closed) > 0) shares_.Leave(host);
      });
  sessions_.insert(session);
  return session;
}

bool TcpServer::Leave() {
  leaves_ = true;
  asio::error_code ignored;
  acceptor_.cancel(ignored);
  bool have_left = true;
  for (const auto& session : sessions_) have_left &= session->Leave();
  return have_left;
}

std::vector<int> TcpServer::Save(SavedState* state, std::size_t most) {
  std::vector<int> sockets;
  std::size_t room = kMaxSavedBytes;
  for (const auto& session : AllSessions()) {
    const bool saved = WithinMemory(metrics_, [&] {
      if (sockets.size() >= most) return session->Stay();
      auto connection = session->Save(std::min(room, kMaxSavedBytesOfOne));
      if (!connection) return session->Stay();
      room -= std::min(room, connection->output.size());
      state->connections.push_back(*std::move(connection));
      sockets.push_back(session->socket());
    });
    if (!saved) session->Close();
  }
  return sockets;
}

void TcpServer::Stay() {
  for (const auto& session : AllSessions()) {
    if (!WithinMemory(metrics_, [&] { session->Stay(); })) session->Close();
  }
}

bool TcpServer::OwesFrames() const {
  return std::ranges::any_of(sessions_, [](const auto& session) { return session->OwesFrames(); });
}

void TcpServer::Resume(const SavedConnection& saved, int number, Hub::ResumedPeers* peers) {
  asio::error_code error;
  tcp::socket socket(io_);
  // Both protocols are the same to a socket that is connected.
  socket.assign(tcp::v4(), number, error);
  if (error) {
    close(number);
    return;
  }
  const tcp::endpoint client = socket.remote_endpoint(error);
  const SavedPeer& peer = saved.peer;
  // A new configuration may not let it in any more. The hub ends those whose keys are gone.
  const bool is_stranger = hub_->RequiresToken() && !peer.access;
  if (error || is_stranger || tls_->enabled()) return;
  const std::string host = HostOf(client.address().to_string());
  if (!shares_.Enter(host)) return;
  std::optional<Access> access;
  if (peer.access)
    access = Access::Of(peer.access->grant, peer.access->key_id, peer.access->expires);
  const auto session = Add(std::make_shared<StreamSocket>(std::move(socket)), host);
  const PeerId id = session->Resume(saved, std::move(access));
  if (id != 0) peers->try_emplace(peer.id, Hub::ResumedPeer{id, &peer});
}

// Returns whether a session has begun.
asio::awaitable<bool> TcpServer::BeginWithTls(std::shared_ptr<StreamSocket> stream,
                                              std::string host) {
  const HandshakeWatch<asio::steady_timer, tcp::socket> watch(stream->socket());
  const std::optional<bool> is_tls = co_await SpeaksTls(*stream);
  if (!is_tls) {  // it has closed, or waited too long
    if (watch.expired()) metrics_->Add(Counter::kTlsSlow);
    co_return false;
  }
  if (!*is_tls) {
    metrics_->Add(Counter::kTlsPlain);
    co_await RefusePlain(*stream);
    co_return false;
  }
  if (!handshakes_.Take(host, ReadClock())) {
    metrics_->Add(Counter::kTlsBusy);
    co_return false;
  }
  // The watch ends the wait, too.
  HandshakePlaces::Place place;
  while (!watch.expired() && (place = handshake_places_.Enter(host)) == nullptr) {
    co_await Pause(HandshakePlaces::kPoll);
  }
  const asio::error_code error = co_await stream->Handshake(tls_->for_messages());
  place.reset();
  if (error) {
    metrics_->Add(watch.expired() ? Counter::kTlsSlow
                                  : HandshakeFailure(static_cast<unsigned long>(error.value())));
    co_return false;
  }
  // While the handshake went on, the daemon may have begun to shut down.
  if (!acceptor_.is_open()) co_return false;
  metrics_->Add(Counter::kTlsHandshakes);
  Begin(std::move(stream), host);
  co_return true;
}

// Answers a client that speaks without TLS, and waits until it has closed: closing with unread
// input would reset the connection and lose the answer. HandshakeWatch limits the time.
asio::awaitable<void> TcpServer::RefusePlain(StreamSocket& stream) {
  Refuse(stream.socket(), protocol::ErrorCode::kUnsupported,
         "this port speaks TLS only: connect with furrow://HOST?tls=1 or --tls");
  std::array<std::uint8_t, 1024> dropped;
  asio::error_code error;
  while (!error) {
    std::tie(error, std::ignore) =
        co_await stream.socket().async_read_some(asio::buffer(dropped), kAwaitTuple);
  }
}

void TcpServer::Refuse(tcp::socket& socket, protocol::ErrorCode code, const std::string& why) {
  RefusalLink link(&socket);
  hub_->RefuseConnection(&link, code, why);
}

void TcpServer::Drain() {
  asio::error_code error;
  acceptor_.close(error);
  for (const auto& session : AllSessions()) {
    session->is_saved() ? session->Close() : session->CloseAfterFlush(/*linger=*/false);
  }
}

void TcpServer::CloseAll() {
  while (!sessions_.empty()) (*sessions_.begin())->Close();
}

}  // namespace furrow::server
