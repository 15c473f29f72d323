// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <utility>  // Boost 1.74 uses std::exchange without including it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

// Boost for the few files that speak HTTP: dear to compile, so included by them alone. It brings
// its own Asio; the rest of the daemon runs on the standalone one, on another thread.
namespace furrow::server {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

// The completion token of every asynchronous call: the coroutine continues with `error` set
// instead of an exception. (Boost 1.74 has no as_tuple.)
[[nodiscard]] inline auto Redirect(beast::error_code& error) {
  return net::redirect_error(net::use_awaitable, error);
}
inline constexpr auto kWebDeadline = std::chrono::seconds(10);  // to ask, and to take an answer
inline constexpr auto kWebIdle = std::chrono::seconds(30);      // a WebSocket that says nothing

using WebRequest = http::request<http::string_body>;

}  // namespace furrow::server
