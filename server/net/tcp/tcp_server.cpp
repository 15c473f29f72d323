// SPDX-License-Identifier: Apache-2.0
#include "server/net/tcp/tcp_server.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <unistd.h>

#include "protocol/framing/tcp_framing.h"
#include "server/core/network_address.h"
#include "server/core/within_memory.h"
#include "server/net/critical_task.h"
#include "server/net/door/end_notice.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;
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

}  // namespace

TcpServer::TcpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
                     WaitingBytes* waiting, const TlsIdentity* tls)
    : io_(io),
      limits_(limits),
      hub_(hub),
      metrics_(metrics),
      waiting_(waiting),
      tls_(tls),
      handshakes_(io, GateParts()),
      door_(io, DoorParts()) {}

Door<AsioNet>::Parts TcpServer::DoorParts() {
  return {.port = "TCP port",
          .limit = "limits.max_connections",
          .flag = "--tcp",
          .listener = "tcp",
          .places = static_cast<std::size_t>(limits_.max_connections),
          .newcomers = tls_->enabled() ? Lobby::kFewPlaces : Lobby::kPlaces,
          .again = Lobby::kAgain,
          .metrics = metrics_,
          .begin = [this](tcp::socket socket,
                          const std::string& host) { Admit(std::move(socket), host); },
          .refuse =
              [this](tcp::socket socket) {
                // A client that speaks TLS only sees that the connection closes.
                Refuse(socket, protocol::ErrorCode::kLimit,
                       "this address has its share of the " +
                           std::to_string(limits_.max_connections) +
                           " connections; see limits.max_connections");
              },
          .make_room =
              [this](const std::string& host, bool any_host, Time now, RoomRequest* request) {
                if (!hub_->MakeRoom(Transport::kTcp, host, any_host, now)) request->Refuse();
              }};
}

HandshakeGate<AsioNet>::Parts TcpServer::GateParts() {
  return {
      .metrics = metrics_,
      .places = &tls_->places(),
      .context = [this] { return tls_->for_messages(); },
      .answer_plain =
          [this](tcp::socket& socket) {
            Refuse(socket, protocol::ErrorCode::kUnsupported,
                   "this port speaks TLS only: connect with furrow://HOST?tls=1 or --tls");
          },
      .begin =
          [this](tcp::socket socket, const std::string& host, HandshakeGate<AsioNet>::Place place) {
            BeginHandshake(std::move(socket), host, std::move(place));
          },
      .ended = [this](const std::string& host) { door_.FreePlace(host); }};
}

Status TcpServer::Adopt(const ServiceManager::Listener& listener) { return door_.Adopt(listener); }

Status TcpServer::Open(const tcp::endpoint& endpoint) {
  return door_.Open({endpoint.address().to_string(), endpoint.port()});
}

void TcpServer::SetLimits(const Limits& limits) {
  limits_ = limits;
  door_.SetPlaces(static_cast<std::size_t>(limits.max_connections));
}

void TcpServer::Start() { StartCriticalTask(io_, door_.Accept()); }

// Begins a session, perhaps after a handshake. The host has a place for it.
void TcpServer::Admit(tcp::socket socket, const std::string& host) {
  if (tls_->enabled()) return handshakes_.Enter(std::move(socket), host);
  Begin(std::make_shared<StreamSocket>(std::move(socket)), host);
}

void TcpServer::BeginHandshake(tcp::socket socket, const std::string& host,
                               HandshakeGate<AsioNet>::Place place) {
  auto stream = std::make_shared<StreamSocket>(std::move(socket));
  asio::co_spawn(io_, BeginWithTls(std::move(stream), host, std::move(place)), asio::detached);
}

// The session has the place of the host once it is in `sessions_`.
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
        if (sessions_.erase(closed) > 0) door_.FreePlace(host);
      });
  sessions_.insert(session);
  return session;
}

bool TcpServer::Leave() {
  door_.Leave();
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
  if (!door_.TakePlace(host)) return;
  std::optional<Access> access;
  if (peer.access)
    access = Access::Of(peer.access->grant, peer.access->key_id, peer.access->expires);
  const auto session = Add(std::make_shared<StreamSocket>(std::move(socket)), host);
  const PeerId id = session->Resume(saved, std::move(access));
  if (id != 0) peers->try_emplace(peer.id, Hub::ResumedPeer{id, &peer});
}

// Frees the place of the host unless a session has begun.
asio::awaitable<void> TcpServer::BeginWithTls(std::shared_ptr<StreamSocket> stream,
                                              std::string host,
                                              HandshakeGate<AsioNet>::Place place) {
  EndNotice notice(alive_, [this, &host] { door_.FreePlace(host); });
  const bool passed = co_await handshakes_.Pass(*stream, std::move(place));
  // While the handshake went on, the daemon may have begun to shut down.
  if (!passed || door_.is_closed()) co_return;
  if (!hub_->RequiresToken()) stream->Admit();
  Begin(std::move(stream), host);
  notice.Cancel();
}

void TcpServer::Refuse(tcp::socket& socket, protocol::ErrorCode code, const std::string& why) {
  RefusalLink link(&socket);
  hub_->RefuseConnection(&link, code, why);
}

void TcpServer::Drain() {
  door_.Close();
  handshakes_.Close();
  for (const auto& session : AllSessions()) {
    session->is_saved() ? session->Close() : session->CloseAfterFlush(/*linger=*/false);
  }
}

void TcpServer::CloseAll() {
  while (!sessions_.empty()) (*sessions_.begin())->Close();
}

}  // namespace furrow::server
