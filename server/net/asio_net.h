// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/compose.hpp>
#include <asio/detached.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <asio/redirect_error.hpp>
#include <asio/ssl/error.hpp>
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
  // The buffers of a sequence, which may be one buffer.
  template <class Buffers>
  [[nodiscard]] static auto Begin(const Buffers& buffers) {
    return asio::buffer_sequence_begin(buffers);
  }
  template <class Buffers>
  [[nodiscard]] static auto End(const Buffers& buffers) {
    return asio::buffer_sequence_end(buffers);
  }
  [[nodiscard]] static asio::mutable_buffer Mutable(const asio::mutable_buffer& one) { return one; }
  [[nodiscard]] static asio::const_buffer Const(const asio::const_buffer& one) { return one; }
  // Throws if `text` is not a numeric address.
  [[nodiscard]] static auto MakeAddress(const std::string& text) {
    return asio::ip::make_address(text);
  }
  // Starts a coroutine that lets no exception out.
  static void Spawn(Loop& loop, Awaitable<void> task) {
    asio::co_spawn(loop, std::move(task), asio::detached);
  }

  // An asynchronous operation with the signature void(Error, std::size_t) or void(Error). `step`:
  // see asio::async_compose().
  template <class Signature, class Step, class Token, class Io>
  [[nodiscard]] static auto Compose(Step step, Token token, Io& io) {
    return asio::async_compose<Token, Signature>(std::move(step), token, io);
  }
  template <class Executor, class Handler>
  static void Post(const Executor& executor, Handler handler) {
    asio::post(executor, std::move(handler));
  }
  // The error of OpenSSL with this code, and what a stream reports at its end.
  [[nodiscard]] static Error TlsError(unsigned long code) {
    return {static_cast<int>(code), asio::error::get_ssl_category()};
  }
  [[nodiscard]] static Error SystemError(int code) {
    return {code, asio::error::get_system_category()};
  }
  [[nodiscard]] static Error Ended() { return asio::error::eof; }
  [[nodiscard]] static Error Truncated() { return asio::ssl::error::stream_truncated; }
};

}  // namespace furrow::server
