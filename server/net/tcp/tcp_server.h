// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>

#include "base/status.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/core/network_address.h"
#include "server/machine/service_manager.h"
#include "server/net/asio_net.h"
#include "server/net/door/door.h"
#include "server/net/door/handshake_gate.h"
#include "server/net/tcp/stream_socket.h"
#include "server/net/tcp/tcp_session.h"
#include "server/saved/saved_state.h"
#include "server/session/hub.h"
#include "server/shares/waiting_bytes.h"
#include "server/tls/tls_identity.h"

namespace furrow::server {

// Accepts TCP connections, at most Limits::max_connections at a time, shared fairly between hosts,
// and owns their sessions. Sessions without use give way to newcomers (Hub::MakeRoom()). With a
// certificate, connections begin with a TLS handshake, which holds a place as a session does.
class TcpServer {
 public:
  // The arguments must outlive the server. All functions run on the thread of `io`.
  TcpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
            WaitingBytes* waiting, const TlsIdentity* tls);

  // Listens at `endpoint`. Errors: kUnavailable; the message names the address and the port.
  [[nodiscard]] Status Open(const asio::ip::tcp::endpoint& endpoint);
  // Listens at a socket of the service manager instead. Errors: kUnavailable.
  [[nodiscard]] Status Adopt(const ServiceManager::Listener& listener);
  // Where it listens.
  [[nodiscard]] const HostPort& address() const { return door_.address(); }
  // Starts accepting.
  void Start();

  // Uses other limits for connections from now on.
  void SetLimits(const Limits& limits);

  // For a restart: stops accepting, and stops reading and writing where the next daemon can go on
  // (TcpSession::Leave()). False: some of these connections are still busy; call it again.
  [[nodiscard]] bool Leave();
  // Saves the connections that have left for the next daemon, `most` of them. Returns their
  // sockets, which stay open until Drain(). Other connections go on here.
  [[nodiscard]] std::vector<int> Save(SavedState* state, std::size_t most);
  // All connections go on here: nobody takes those that were saved.
  void Stay();
  [[nodiscard]] int socket() { return door_.socket(); }
  // Goes on with a connection of the former daemon. The socket belongs to this object.
  void Resume(const SavedConnection& saved, int socket, Hub::ResumedPeers* peers);

  // Stops accepting. Connections that were saved close at once, without an end that the client
  // would see while the next daemon has the socket. Other open connections send what is queued and
  // close.
  void Drain();
  // True if a connection has not sent all frames that may not be left out.
  [[nodiscard]] bool OwesFrames() const;
  // Closes all connections immediately.
  void CloseAll();
  [[nodiscard]] std::size_t num_sessions() const { return sessions_.size(); }

 private:
  [[nodiscard]] Door<AsioNet>::Parts DoorParts();
  [[nodiscard]] HandshakeGate<AsioNet>::Parts GateParts();
  void Admit(asio::ip::tcp::socket socket, const std::string& host);
  void Begin(std::shared_ptr<StreamSocket> stream, const std::string& host);
  // A copy, because Close() erases a session.
  [[nodiscard]] std::vector<std::shared_ptr<TcpSession>> AllSessions() const {
    return {sessions_.begin(), sessions_.end()};
  }
  std::shared_ptr<TcpSession> Add(std::shared_ptr<StreamSocket> stream, const std::string& host);
  void BeginHandshake(asio::ip::tcp::socket socket, const std::string& host,
                      HandshakeGate<AsioNet>::Place place);
  asio::awaitable<void> BeginWithTls(std::shared_ptr<StreamSocket> stream, std::string host,
                                     HandshakeGate<AsioNet>::Place place);
  void Refuse(asio::ip::tcp::socket& socket, protocol::ErrorCode code, const std::string& why);

  asio::io_context& io_;
  Limits limits_;
  Hub* const hub_;
  Metrics* const metrics_;
  WaitingBytes* const waiting_;
  const TlsIdentity* const tls_;
  HandshakeGate<AsioNet> handshakes_;
  Door<AsioNet> door_;  // its places are those of the sessions and handshakes
  std::unordered_set<std::shared_ptr<TcpSession>> sessions_;
  // The loop may destroy coroutines later.
  const std::shared_ptr<void> alive_ = std::make_shared<char>();
};

}  // namespace furrow::server
