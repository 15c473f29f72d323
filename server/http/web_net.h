// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/http/request/beast.h"

namespace furrow::server {

// Boost's Asio for templates that serve both Asios; see AsioNet.
struct WebNet {
  using Tcp = net::ip::tcp;
  using Loop = net::io_context;
  using Timer = net::steady_timer;
  using Error = beast::error_code;
  template <class T>
  using Awaitable = net::awaitable<T>;

  [[nodiscard]] static auto Redirect(Error& error) { return server::Redirect(error); }
  template <class Bytes>
  [[nodiscard]] static auto Buffer(Bytes& bytes) {
    return net::buffer(bytes);
  }
  [[nodiscard]] static auto MakeAddress(const std::string& text) {
    return net::ip::make_address(text);
  }
  static void Spawn(Loop& loop, Awaitable<void> task) {
    net::co_spawn(loop, std::move(task), net::detached);
  }
};

}  // namespace furrow::server
