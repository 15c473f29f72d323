// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "server/cluster/coordinator.h"
#include "server/config/http_config.h"
#include "server/core/network_address.h"
#include "server/http/request/web_context.h"
#include "server/machine/service_manager.h"

namespace furrow::server {

// The web server of a daemon: the page, WebSockets, pictures over plain HTTP, and the JSON API
// (docs/HTTP-API.md). It runs on its own thread and exchanges messages with the hub's thread, so
// web clients cost the hub no more than other peers.
class HttpServer {
 public:
  struct Parts {
    HttpConfig config;
    std::string bind;                                  // numeric address
    std::optional<ServiceManager::Listener> listener;  // used instead of `bind` and the port
    // The file of the character for browsers that draw it themselves, served as /character.glb.
    // Called once, on the server's thread. Empty, or an empty path: there is none.
    std::function<std::filesystem::path()> find_character;
    PostToHub post_to_hub;
    AnswerApi answer;                      // called on the hub's thread
    Metrics* metrics = nullptr;            // not null; outlives the server
    WaitingBytes* waiting = nullptr;       // for web clients; outlives the server; null: no limit
    const TokenGate* gate = nullptr;       // outlives the server; null: everybody may do everything
    const TlsIdentity* tls = nullptr;      // outlives the server; null or not enabled: plain HTTP
    const Coordinator* cluster = nullptr;  // outlives the server; null: the daemon is alone
    RecordingLoader* loader = nullptr;     // outlives the server; null: nothing can be uploaded
  };
  // Opens the port. Clients wait until Start(). Errors: kUnavailable; the message names the address
  // and the port. A missing page is only logged; everything else works without it.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> Listen(Parts parts);
  // Closes all connections and joins the thread. Call it on the hub's thread or after that has
  // ended.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // Answers clients from now on, on a thread of its own. Call it once, when all of `Parts` is
  // ready.
  void Start();
  // Where it listens.
  [[nodiscard]] const HostPort& address() const;
  [[nodiscard]] std::uint16_t port() const { return address().port; }
  [[nodiscard]] int listening_socket() const;
  // The open connections, and those of them that are WebSockets or picture streams. Thread-safe.
  [[nodiscard]] int connections() const;
  [[nodiscard]] int viewers() const;
  // Takes over the lists of allowed names and the limits of `config`, soon. Its other values do not
  // count.
  void Reload(const HttpConfig& config);
  // Stops accepting connections; open ones continue.
  void Drain();

 private:
  struct Impl;
  explicit HttpServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::server
