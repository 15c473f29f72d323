// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/http/stream/beast.h"

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
  template <class Buffers>
  [[nodiscard]] static auto Begin(const Buffers& buffers) {
    return net::buffer_sequence_begin(buffers);
  }
  template <class Buffers>
  [[nodiscard]] static auto End(const Buffers& buffers) {
    return net::buffer_sequence_end(buffers);
  }
  [[nodiscard]] static net::mutable_buffer Mutable(const net::mutable_buffer& one) { return one; }
  [[nodiscard]] static net::const_buffer Const(const net::const_buffer& one) { return one; }
  [[nodiscard]] static auto MakeAddress(const std::string& text) {
    return net::ip::make_address(text);
  }
  static void Spawn(Loop& loop, Awaitable<void> task) {
    net::co_spawn(loop, std::move(task), net::detached);
  }

  // An asynchronous operation with the signature void(Error, std::size_t) or void(Error). `step`:
  // see net::async_compose().
  template <class Signature, class Step, class Token, class Io>
  [[nodiscard]] static auto Compose(Step step, Token token, Io& io) {
    return net::async_compose<Token, Signature>(std::move(step), token, io);
  }
  template <class Executor, class Handler>
  static void Post(const Executor& executor, Handler handler) {
    net::post(executor, std::move(handler));
  }
  // The error of OpenSSL with this code, and what a stream reports at its end.
  [[nodiscard]] static Error TlsError(unsigned long code) {
    return {static_cast<int>(code), net::error::get_ssl_category()};
  }
  [[nodiscard]] static Error SystemError(int code) {
    return {code, net::error::get_system_category()};
  }
  [[nodiscard]] static Error Ended() { return net::error::eof; }
  [[nodiscard]] static Error Truncated() { return net::ssl::error::stream_truncated; }
};

}  // namespace furrow::server
