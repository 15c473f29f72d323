// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/reply_writer.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace furrow::server {
namespace {

// The page loads nothing from other hosts and must not be framed, unless AllowFrames() says so. Its
// menu sets styles from scripts.
constexpr char kContentPolicy[] =
    "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors ";

// What a client must show (RFC 9110 section 11.6.1, RFC 6750 section 3). Only a refused token is an
// error: a request without one has done nothing wrong.
std::string_view ChallengeOf(const ApiReply& reply) {
  return reply.bad_token ? R"(Bearer realm="furrowd", error="invalid_token")"
                         : R"(Bearer realm="furrowd")";
}

}  // namespace

void SetCommonHeaders(std::string_view content_type, http::fields* fields) {
  fields->set(http::field::server, "furrowd");
  fields->set(http::field::content_type,
              beast::string_view(content_type.data(), content_type.size()));
  // A browser must not run a JSON or text reply as a script.
  fields->set("X-Content-Type-Options", "nosniff");
  fields->set("Referrer-Policy", "no-referrer");
  fields->set("Content-Security-Policy", std::string(kContentPolicy) + "'none'");
}

void AllowFrames(const std::vector<std::string>& origins, http::fields* fields) {
  if (origins.empty()) return;
  std::string policy = kContentPolicy;
  policy += "'self'";
  for (const std::string& origin : origins) policy += " " + origin;
  fields->set("Content-Security-Policy", policy);
}

net::awaitable<bool> WriteReply(WebStream& stream, const WebRequest& request, ApiReply reply) {
  http::response<http::string_body> response(static_cast<http::status>(reply.status),
                                             request.version());
  SetCommonHeaders(reply.type, &response);
  response.keep_alive(request.keep_alive() && !reply.closes);
  // Replies show the state of this moment.
  response.set(http::field::cache_control, "no-store");
  if (!reply.file_name.empty()) {
    response.set(http::field::content_disposition,
                 "attachment; filename=\"" + reply.file_name + "\"");
  }
  if (reply.status == 401) {
    response.set(http::field::www_authenticate, std::string(ChallengeOf(reply)));
  }
  if ((reply.status == 429 || reply.status == 503) && reply.retry_after > 0) {
    response.set(http::field::retry_after, std::to_string(reply.retry_after));
  }
  if (!reply.location.empty()) response.set(http::field::location, reply.location);
  if (!reply.allow.empty()) response.set(http::field::allow, reply.allow);
  // A HEAD request for a picture draws none, so the length of the body is unknown.
  const bool has_no_length = request.method() == http::verb::head && reply.body.empty();
  response.body() = std::move(reply.body);
  if (!has_no_length) response.prepare_payload();
  co_return co_await WriteResponse(stream, request, response);
}

net::awaitable<bool> WriteLargeReply(WebStream& stream, const WebRequest& request, ApiReply reply,
                                     WaitingBytes* waiting, const std::string& host) {
  WaitingBytes::Account account(waiting, host);
  const bool has_body = request.method() != http::verb::head;
  if (has_body && !account.Hold(reply.body.size())) {
    account.CountRefusal();
    reply = ErrorReply(503, "limit", "",
                       "too much waits for clients that read slowly, so this address has no room "
                       "for a large reply; see limits.max_waiting_megabytes",
                       "try again later");
  }
  co_return co_await WriteReply(stream, request, std::move(reply));
}

}  // namespace furrow::server
