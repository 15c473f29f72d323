// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/write.hpp>

#include "server/http/request/api_types.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_stream.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// Converts Beast's string view to the standard one.
[[nodiscard]] inline std::string_view ToView(beast::string_view text) {
  return {text.data(), text.size()};
}

// Sets the header fields that every response has: server, content type and security policies.
void SetCommonHeaders(std::string_view content_type, http::fields* fields);

// Lets the pages of `origins` show the response in a frame; SetCommonHeaders() lets nobody.
void AllowFrames(const std::vector<std::string>& origins, http::fields* fields);

// Sends a response, or only its head for a HEAD request. False: the connection must close, because
// the client asked for it, has gone, or did not read the response within kWebDeadline.
template <class Body>
[[nodiscard]] net::awaitable<bool> WriteResponse(WebStream& stream, const WebRequest& request,
                                                 http::response<Body>& response) {
  http::response_serializer<Body> serializer(response);
  stream.expires_after(kWebDeadline);
  beast::error_code error;
  if (request.method() == http::verb::head) {
    co_await http::async_write_header(stream, serializer, Redirect(error));
  } else {
    co_await http::async_write(stream, serializer, Redirect(error));
  }
  co_return !error && response.keep_alive();
}

// Sends a whole reply. False: the connection must close, as for WriteResponse().
[[nodiscard]] net::awaitable<bool> WriteReply(WebStream& stream, const WebRequest& request,
                                              ApiReply reply);

// The same for a reply that may be large. It takes room for the time of the write, and is replaced
// by an error if the `host` has none left. `waiting`: null: no limit.
[[nodiscard]] net::awaitable<bool> WriteLargeReply(WebStream& stream, const WebRequest& request,
                                                   ApiReply reply, WaitingBytes* waiting,
                                                   const std::string& host);

}  // namespace furrow::server
