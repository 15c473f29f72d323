// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/redirect_error.hpp>
#include <asio/steady_timer.hpp>
#include <asio/use_awaitable.hpp>

namespace furrow::server {

// Standalone Asio for templates that serve both Asios, such as Door. WebNet in server/http has the
// same members for Boost's Asio.
struct AsioNet {
  using Tcp = asio::ip::tcp;
  using Loop = asio::io_context;
  using Timer = asio::steady_timer;
  using Error = asio::error_code;
  template <class T>
  using Awaitable = asio::awaitable<T>;

  // The completion token of every asynchronous call: the coroutine resumes with `error` set instead
  // of an exception, and `error` is cleared on success.
  [[nodiscard]] static auto Redirect(Error& error) {
    return asio::redirect_error(asio::use_awaitable, error);
  }
  template <class Bytes>
  [[nodiscard]] static auto Buffer(Bytes& bytes) {
    return asio::buffer(bytes);
  }
  // Throws if `text` is not a numeric address.
  [[nodiscard]] static auto MakeAddress(const std::string& text) {
    return asio::ip::make_address(text);
  }
  // Starts a coroutine that lets no exception out.
  static void Spawn(Loop& loop, Awaitable<void> task) {
    asio::co_spawn(loop, std::move(task), asio::detached);
  }
};

}  // namespace furrow::server
