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

// The Boost headers and names that all files of the web server share. Compiling them is slow, so
// only server/http includes them. Boost has its own Asio; the rest of the daemon uses standalone
// Asio on other threads.
namespace furrow::server {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

// The completion token of every asynchronous call: the coroutine resumes with `error` set instead
// of an exception, and `error` is cleared on success. Boost 1.74 has no as_tuple.
[[nodiscard]] inline auto Redirect(beast::error_code& error) {
  return net::redirect_error(net::use_awaitable, error);
}
// The time that a client has to send a request, or to read a response.
inline constexpr auto kWebDeadline = std::chrono::seconds(10);
// The time after which a silent WebSocket is closed.
inline constexpr auto kWebIdle = std::chrono::seconds(30);

// The time that a client has to answer the close frame of a WebSocket.
inline constexpr auto kWebCloseDeadline = std::chrono::seconds(1);

using WebRequest = http::request<http::string_body>;

}  // namespace furrow::server
