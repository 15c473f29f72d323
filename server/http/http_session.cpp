// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_session.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "server/http/pictures/picture_stream.h"
#include "server/http/socket/web_socket.h"

namespace furrow::server {
namespace {

// The page loads nothing from elsewhere, and nobody frames it. Its menu sets styles by script.
constexpr char kContentPolicy[] =
    "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
    "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

template <class Message>
void SetHeaders(const WebRequest& request, std::string_view type, Message* message) {
  message->set(http::field::server, "furrowd");
  message->set(http::field::content_type, beast::string_view(type.data(), type.size()));
  message->set("X-Content-Type-Options", "nosniff");
  message->set("Referrer-Policy", "no-referrer");
  message->set("Content-Security-Policy", kContentPolicy);
  message->keep_alive(request.keep_alive());
}

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

// With its body, unless only its head was asked for. False: the connection ends here.
template <class Response>
net::awaitable<bool> Write(beast::tcp_stream& stream, const WebRequest& request,
                           Response& response) {
  http::response_serializer<typename Response::body_type> serializer(response);
  stream.expires_after(kWebDeadline);
  beast::error_code failure;
  if (request.method() == http::verb::head) {
    beast::error_code error;
    const std::size_t size = co_await http::async_write_header(stream, serializer, Redirect(error));
    failure = error;
  } else {
    beast::error_code error;
    const std::size_t size = co_await http::async_write(stream, serializer, Redirect(error));
    failure = error;
  }
  co_return !failure && response.keep_alive();
}

// The hub's thread answers; where it does not within the deadline, that is what is said.
net::awaitable<ApiReply> AskHub(WebContext* context, ApiRequest request) {
  struct Pending {
    net::steady_timer timer;
    std::optional<ApiReply> reply;
  };
  const auto executor = co_await net::this_coro::executor;
  const auto pending =
      std::make_shared<Pending>(Pending{net::steady_timer(executor, kWebDeadline), std::nullopt});
  // Weak: the hub's queue may outlive the loop that the timer is on.
  context->post_to_hub([weak = std::weak_ptr(pending), answer = context->answer,
                        post_to_web = context->post_to_web,
                        request = std::move(request)](Hub& hub, Time now) {
    post_to_web([weak, reply = answer(request, hub, now)] {
      if (const auto waiting = weak.lock()) {
        waiting->reply = reply;
        waiting->timer.cancel();
      }
    });
  });
  beast::error_code ignored;
  co_await pending->timer.async_wait(Redirect(ignored));
  if (pending->reply) co_return *std::move(pending->reply);
  co_return ErrorReply(503, "unavailable", "", "the daemon's loop does not answer");
}

net::awaitable<bool> WritePageFile(beast::tcp_stream& stream, const WebRequest& request,
                                   const PageFile& file) {
  const bool gzip = !file.gzip.empty() &&
                    request[http::field::accept_encoding].find("gzip") != beast::string_view::npos;
  const bool known = request[http::field::if_none_match] == file.etag;
  const std::string& bytes = gzip ? file.gzip : file.bytes;
  http::response<http::span_body<const char>> response(
      known ? http::status::not_modified : http::status::ok, request.version());
  SetHeaders(request, file.type, &response);
  response.set(http::field::etag, file.etag);
  response.set(http::field::vary, "Accept-Encoding");
  response.set(http::field::cache_control,
               file.immutable ? "public, max-age=31536000, immutable" : "no-cache");
  if (gzip) response.set(http::field::content_encoding, "gzip");
  if (!known) response.content_length(bytes.size());
  if (!known && request.method() != http::verb::head) {
    response.body() = {bytes.data(), bytes.size()};
  }
  co_return co_await Write(stream, request, response);
}

bool IsPicture(const std::string& path) { return path == "/mjpeg" || path == "/snapshot.png"; }

bool Reads(const WebRequest& request) {
  return request.method() == http::verb::get || request.method() == http::verb::head;
}

ApiReply NotHere(const WebRequest& request, const std::string& path) {
  if (path == "/") {
    return {.status = 503,
            .type = "text/plain; charset=utf-8",
            .body =
                "furrowd serves, but its page was not built: build the target furrow-web.\n"
                "/mjpeg shows pictures without it.\n"};
  }
  return ErrorReply(404, "not_found", "",
                    std::string(View(request.target())) + " is not served here");
}

class HttpSession {
 public:
  HttpSession(beast::tcp_stream stream, WebContext* context)
      : stream_(std::move(stream)), context_(context) {}

  net::awaitable<void> Run() {
    bool goes_on = true;
    while (goes_on) {  // in two steps: GCC 12 awaits both sides of an &&, whatever the left one is
      goes_on = co_await ReadRequest();
      if (goes_on) goes_on = co_await Answer();
    }
    if (stream_.socket().is_open()) {
      beast::error_code error;
      stream_.socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
    }
  }

 private:
  net::awaitable<bool> ReadRequest() {
    http::request_parser<http::string_body> parser;
    parser.header_limit(kMaxWebHeaderBytes);
    parser.body_limit(kMaxWebMessageBytes);
    stream_.expires_after(kWebDeadline);
    beast::error_code error;
    const std::size_t size = co_await http::async_read(stream_, buffer_, parser, Redirect(error));
    if (!error) {
      request_ = parser.release();
      context_->metrics->Add(Counter::kHttpRequests);
      co_return true;
    }
    if (error.category() == http::make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message) {
      co_await RefuseBytes(error);
    }
    co_return false;
  }

  // Bytes that are no request we take: one answer, then the connection ends.
  net::awaitable<void> RefuseBytes(beast::error_code error) {
    context_->metrics->Add(Counter::kHttpRefused);
    request_ = WebRequest(http::verb::get, "/", 11);
    request_.keep_alive(false);
    if (error == http::error::body_limit) {
      (void)co_await WriteReply(
          stream_, request_,
          ErrorReply(413, "limit", "", "a request's body has at most 65536 bytes"));
    } else if (error == http::error::header_limit) {
      (void)co_await WriteReply(stream_, request_,
                                ErrorReply(431, "limit", "", "too many header fields"));
    } else {
      (void)co_await WriteReply(stream_, request_, ErrorReply(400, "parse", "", "no HTTP request"));
    }
  }

  // False: the connection ends here.
  net::awaitable<bool> Answer() {
    const std::string why = context_->guard.Check(View(request_[http::field::host]),
                                                  View(request_[http::field::origin]));
    if (!why.empty()) {
      context_->metrics->Add(Counter::kHttpRefused);
      co_return co_await WriteReply(stream_, request_, ErrorReply(403, "forbidden", "", why));
    }
    std::optional<Url> url = ParseUrl(View(request_.target()));
    if (!url) {
      co_return co_await WriteReply(stream_, request_,
                                    ErrorReply(400, "parse", "", "a target that is no path"));
    }
    if (url->path == "/ws") {
      if (beast::websocket::is_upgrade(request_)) {
        co_await ServeWebSocket(std::move(stream_), context_, std::move(request_));
        co_return false;
      }
      co_return co_await WriteReply(stream_, request_,
                                    ErrorReply(400, "upgrade", "", "/ws is a WebSocket"));
    }
    if (IsPicture(url->path) && Reads(request_)) {
      co_return co_await ServePictures(&stream_, context_, request_, *url);
    }
    co_return co_await AnswerPlain(*std::move(url));
  }

  net::awaitable<bool> AnswerPlain(Url url) {
    const PageFile* file = context_->page.Find(url.path);
    if (file != nullptr && Reads(request_)) {
      co_return co_await WritePageFile(stream_, request_, *file);
    }
    if (file != nullptr || IsPicture(url.path)) {
      ApiReply reply = MethodReply(View(request_.method_string()), url.path, "GET, HEAD");
      co_return co_await WriteReply(stream_, request_, std::move(reply));
    }
    const bool is_api = url.path.starts_with("/api/") || url.path == "/metrics" ||
                        url.path == "/healthz" || url.path == "/readyz";
    if (!is_api) {
      co_return co_await WriteReply(stream_, request_, NotHere(request_, url.path));
    }
    ApiRequest request{std::string(View(request_.method_string())), std::move(url),
                       std::move(request_.body())};
    if (request.method == "HEAD") request.method = "GET";
    ApiReply reply = co_await AskHub(context_, std::move(request));
    co_return co_await WriteReply(stream_, request_, std::move(reply));
  }

  beast::tcp_stream stream_;
  WebContext* context_;
  beast::flat_buffer buffer_;
  WebRequest request_;
};

}  // namespace

net::awaitable<bool> WriteReply(beast::tcp_stream& stream, const WebRequest& request,
                                ApiReply reply) {
  http::response<http::string_body> response(static_cast<http::status>(reply.status),
                                             request.version());
  SetHeaders(request, reply.type, &response);
  response.set(http::field::cache_control, "no-store");
  if (!reply.file_name.empty()) {
    response.set(http::field::content_disposition,
                 "attachment; filename=\"" + reply.file_name + "\"");
  }
  if (!reply.allow.empty()) response.set(http::field::allow, reply.allow);
  // The length of what was not made for a HEAD is left out.
  const bool is_unmade = request.method() == http::verb::head && reply.body.empty();
  response.body() = std::move(reply.body);
  if (!is_unmade) response.prepare_payload();
  co_return co_await Write(stream, request, response);
}

net::awaitable<void> ServeConnection(beast::tcp_stream stream, WebContext* context) {
  HttpSession session(std::move(stream), context);
  co_await session.Run();
}

}  // namespace furrow::server
