// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/status.h"
#include "server/config/http_config.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

// The web side of a daemon on a thread of its own: the page, WebSockets, pictures for plain HTTP,
// and the JSON API (docs/HTTP-API.md). Whatever a client does there costs the hub's thread no more
// than any other peer's messages.
class HttpServer {
 public:
  struct Parts {
    HttpConfig config;
    std::string bind;  // numeric
    PostToHub post_to_hub;
    AnswerApi answer;  // called on the hub's thread
    Metrics* metrics = nullptr;
  };
  // Listens when it returns. Errors: kIo (names address and port). A page that is not there is
  // logged; the rest is served without it.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> Start(Parts parts);
  // Cuts all connections and joins. On the hub's thread, or when that has ended.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] int connections() const;
  [[nodiscard]] int viewers() const;
  // No more connections.
  void Drain();

 private:
  struct Impl;
  explicit HttpServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::server
