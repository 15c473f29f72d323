// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_session.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "base/process/memory_reserve.h"
#include "server/http/pictures/picture_stream.h"
#include "server/http/request/elsewhere.h"
#include "server/http/request/reply_writer.h"
#include "server/http/request/request_access.h"
#include "server/http/socket/web_socket.h"
#include "server/http/upload/upload.h"
#include "server/http/weights/weight_query.h"
#include "server/http/weights/weight_stream.h"
#include "server/net/clock.h"

namespace furrow::server {
namespace {

constexpr Time kProbeAge = std::chrono::milliseconds(100);
constexpr Time kSkipTime =
    std::chrono::seconds(2);  // for the body of a stranger, which nobody reads

// Asks the hub's thread for a reply, or replies with 503 after kWebDeadline. `host`: it pays for
// the time that the hub's thread needs.
net::awaitable<ApiReply> AskHub(WebContext* context, std::string host, ApiRequest request) {
  // The timer is deadline and wake-up in one: the reply cancels it.
  struct Pending {
    net::steady_timer timer;
    std::optional<ApiReply> reply;
  };
  const auto executor = co_await net::this_coro::executor;
  const auto pending =
      std::make_shared<Pending>(Pending{net::steady_timer(executor, kWebDeadline), std::nullopt});
  // Weak, because the task in the hub's queue may outlive the event loop of the timer.
  context->post_to_hub([weak = std::weak_ptr(pending), answer = context->answer,
                        post_to_web = context->post_to_web, metrics = context->metrics,
                        budget = std::weak_ptr(context->budget), host = std::move(host),
                        request = std::move(request)](Hub& hub, Time now) {
    // On the hub's thread. Only the web thread may touch `pending`, so the reply is posted back.
    const Time begun = ReadClock();
    const MemoryReserve::Scope scope;  // destructors of JSON allocate
    ApiReply reply;
    try {
      if (MemoryReserve::IsShort()) throw std::bad_alloc();
      reply = answer(request, hub, now);
    } catch (const std::bad_alloc&) {  // it costs one request, not the daemon
      metrics->Add(Counter::kAllocationsFailed);
      reply = ErrorReply(503, "unavailable", "", "the daemon is short of memory", "try again");
    }
    post_to_web([weak, budget, host, cost = ReadClock() - begun, reply = std::move(reply)] {
      if (const auto alive = budget.lock()) alive->Charge(host, cost, ReadClock());
      // Late replies find nobody: the coroutine has answered with 503 and gone.
      if (const auto waiting = weak.lock()) {
        waiting->reply = reply;
        waiting->timer.cancel();
      }
    });
  });
  beast::error_code ignored;
  co_await pending->timer.async_wait(Redirect(ignored));
  if (pending->reply) co_return *std::move(pending->reply);
  co_return ErrorReply(503, "unavailable", "", "the daemon did not answer within 10 s");
}

// The origins whose pages may show the file at `path` in a frame. A reference, because GCC 12
// destroys temporaries of a co_await expression twice.
const std::vector<std::string>& FramesOf(std::string_view path, const HttpConfig& config) {
  static const std::vector<std::string> kNobody;
  return path == kEmbedPath ? config.allow_origins : kNobody;
}

// Sends a file of the page from memory, compressed if the client accepts it. False: the connection
// must close. `frames`: the origins whose pages may show the file in a frame.
net::awaitable<bool> WritePageFile(WebStream& stream, const WebRequest& request,
                                   const PageFile& file, const std::vector<std::string>& frames) {
  const bool gzip = !file.gzip.empty() &&
                    request[http::field::accept_encoding].find("gzip") != beast::string_view::npos;
  const bool known = request[http::field::if_none_match] == file.etag;
  const std::string& bytes = gzip ? file.gzip : file.bytes;
  http::response<http::span_body<const char>> response(
      known ? http::status::not_modified : http::status::ok, request.version());
  SetCommonHeaders(file.type, &response);
  AllowFrames(frames, &response);
  response.keep_alive(request.keep_alive());
  response.set(http::field::etag, file.etag);
  // Caches must keep the two encodings apart (RFC 9110 section 12.5.5).
  response.set(http::field::vary, "Accept-Encoding");
  // Names with a hash never change their content. The others are checked by their ETag each time.
  response.set(http::field::cache_control,
               file.immutable ? "public, max-age=31536000, immutable" : "no-cache");
  if (gzip) response.set(http::field::content_encoding, "gzip");
  // A 304 has no body. HEAD sends the length of the body that GET would send.
  if (!known) response.content_length(bytes.size());
  if (!known && request.method() != http::verb::head) {
    response.body() = {bytes.data(), bytes.size()};
  }
  co_return co_await WriteResponse(stream, request, response);
}

// The routes that only read; /mjpeg and /weights go on until the client closes.
bool IsPicture(const std::string& path) { return path == "/mjpeg" || path == "/snapshot.png"; }
bool IsStream(const std::string& path) { return IsPicture(path) || path == "/weights"; }

bool IsRead(const WebRequest& request) {
  return request.method() == http::verb::get || request.method() == http::verb::head;
}

// The reply for an unknown path. If even "/" is unknown, the page has not been built. It omits the
// query, which may contain a token.
ApiReply NotFound(const std::string& path) {
  if (path == "/") {
    return {
        .status = 503,
        .type = "text/plain; charset=utf-8",
        .body =
            "furrowd is running, but its web page is not installed. Build the target furrow-web.\n"
            "/mjpeg shows pictures without the page.\n",
        .retry_after = 0};
  }
  return ErrorReply(404, "not_found", "", path + " does not exist");
}

// One connection. All functions run on the web thread, in one coroutine.
class HttpSession {
 public:
  HttpSession(WebStream stream, WebContext* context)
      : stream_(std::move(stream)), context_(context), client_(LabelOfClient(stream_)) {}

  net::awaitable<void> Run() {
    bool goes_on = true;
    while (goes_on) {  // two statements: GCC 12 awaits both operands of && in any case
      goes_on = co_await ReadRequest();
      if (!goes_on) break;
      if (!context_->pace.Take(client_.host, ReadClock())) {
        context_->metrics->Add(Counter::kHttpSlowed);
        co_await Pause();
      }
      goes_on = co_await Answer();
    }
    if (unread_bytes_ > 0 && stream_.is_open()) co_await SkipBody();
    // After an upgrade the socket has moved to the WebSocket. Otherwise tell the client that no
    // reply follows.
    if (stream_.is_open()) co_await stream_.EndSending();
  }

 private:
  net::awaitable<bool> ReadRequest() {
    // A new parser for each request, because a parser cannot be reused.
    http::request_parser<http::string_body> parser;
    // Beast stops reading at the limits, so a client cannot make the daemon hold more than this.
    parser.header_limit(kMaxWebHeaderBytes);
    // Each route has a limit of its own for the body, and the path is in the header.
    parser.body_limit(std::numeric_limits<std::uint64_t>::max());
    // Covers the whole request: a client that sends one byte at a time (slowloris) is closed, too.
    // It also ends idle connections.
    stream_.expires_after(kWebDeadline);
    beast::error_code error;
    co_await http::async_read_header(stream_, buffer_, parser, Redirect(error));
    bool has_body = false;
    is_upload_ = false;
    body_bytes_.reset();
    if (!error) {
      stream_.NoteRequest();
      Admit(parser.get());
      has_body = !parser.is_done();
      is_upload_ = !refusal_ && IsUpload(parser.get(), *url_);
      if (parser.content_length()) body_bytes_ = *parser.content_length();
    }
    // A stranger cannot make the daemon hold a body, so the reply does not wait for it. An upload
    // is read by its route.
    const bool skips_body = has_body && !access_.admitted();
    if (has_body && !skips_body && !is_upload_) {
      if (body_bytes_.value_or(0) > kMaxWebMessageBytes) {
        error = http::error::body_limit;
      } else {
        parser.body_limit(kMaxWebMessageBytes);
        co_await http::async_read(stream_, buffer_, parser, Redirect(error));
      }
    }
    if (!error) {
      if (skips_body) SkipBodyLater(kMaxWebMessageBytes);
      request_ = parser.release();
      if (!access_.admitted()) buffer_.shrink_to_fit();  // strangers make the daemon hold little
      if (skips_body || stream_.MustMakeRoom()) request_.keep_alive(false);
      context_->metrics->Add(Counter::kHttpRequests);
      co_return true;
    }
    // Only errors of the HTTP syntax get an answer. For an end of the stream or a timeout there is
    // nobody to read it.
    if (error.category() == http::make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message) {
      co_await RejectBytes(error);
    }
    co_return false;
  }

  // Reads the header: sets the URL, what the client may do, and the reply that refuses the request.
  void Admit(const WebRequest& request) {
    url_.reset();
    access_ = Access();
    refusal_ = Refuse(request);
  }

  std::optional<ApiReply> Refuse(const WebRequest& request) {
    // First of all checks: a foreign web page must not reach any route, not even a WebSocket.
    const std::string why = context_->guard.Check(ToView(request[http::field::host]),
                                                  ToView(request[http::field::origin]));
    if (!why.empty()) {
      context_->metrics->Add(Counter::kHttpRefused);
      return ErrorReply(403, "forbidden", "", why);
    }
    url_ = ParseUrl(ToView(request.target()));
    if (!url_) return ErrorReply(400, "parse", "", "the request target is not a valid path");
    if (LacksCertificate(url_->path)) {
      context_->metrics->Add(Counter::kTlsNoCertificate);
      return ErrorReply(403, "forbidden", "", "show a client certificate");
    }
    Result<Access> access = AccessOf(request, context_->gate, client_.shielded, &*url_);
    if (access.ok() && access->admitted()) {
      access_ = *std::move(access);
      stream_.Admit();
      return std::nullopt;
    }
    if (IsForAll(url_->path)) return std::nullopt;
    if (!access.ok()) return RefusesToken(access.status().what());
    context_->metrics->Add(Counter::kRefusedNoToken);
    // 401 asks for a token, and the page then asks its user. Not where it would be disclosed.
    return context_->gate->TakesTokens(client_.shielded)
               ? NeedsToken(kNeedsTokenText)
               : ErrorReply(403, "forbidden", "", kNoTokenHereText);
  }

  // Lets the connection end after the reply, and SkipBody() before that. `most_bytes`: of the body
  // that are read.
  void SkipBodyLater(std::uint64_t most_bytes) {
    unread_bytes_ = std::min<std::uint64_t>(body_bytes_.value_or(most_bytes), most_bytes);
  }

  // Reads the body of a refused request away. Closing with unread input would reset the connection,
  // and the client might not get the reply.
  net::awaitable<void> SkipBody() {
    std::array<char, 4096> unused;
    stream_.expires_after(access_.admitted() ? Time(kWebDeadline) : kSkipTime);
    beast::error_code error;
    unread_bytes_ -= std::min<std::uint64_t>(unread_bytes_, buffer_.size());
    while (unread_bytes_ > 0 && !error) {
      const std::size_t size =
          co_await stream_.async_read_some(net::buffer(unused), Redirect(error));
      unread_bytes_ -= std::min<std::uint64_t>(unread_bytes_, size);
    }
  }

  // Replies to invalid bytes. The connection closes afterwards.
  net::awaitable<void> RejectBytes(beast::error_code error) {
    context_->metrics->Add(Counter::kHttpRefused);
    // The request that could not be parsed is incomplete. The reply needs a version (1.1) and no
    // more.
    request_ = WebRequest(http::verb::get, "/", 11);
    request_.keep_alive(false);
    if (error == http::error::body_limit) {
      (void)co_await WriteReply(
          stream_, request_, ErrorReply(413, "limit", "", "the request body exceeds 65536 bytes"));
    } else if (error == http::error::header_limit) {
      (void)co_await WriteReply(
          stream_, request_, ErrorReply(431, "limit", "", "the header fields exceed 8192 bytes"));
    } else {
      (void)co_await WriteReply(stream_, request_,
                                ErrorReply(400, "parse", "", "not a valid HTTP request"));
    }
  }

  // False: the connection must close.
  net::awaitable<bool> Answer() {
    if (refusal_) co_return co_await WriteReply(stream_, request_, *std::move(refusal_));
    std::optional<Url> url = std::move(url_);
    if (url->path == "/ws") {
      if (beast::websocket::is_upgrade(request_)) {
        // The session gives its socket away and ends with the WebSocket.
        co_await ServeWebSocket(std::move(stream_), context_, std::move(request_), access_);
        co_return false;
      }
      co_return co_await WriteReply(
          stream_, request_,
          ErrorReply(400, "upgrade", "", "/ws accepts WebSocket connections only"));
    }
    // A client of WebSockets does not follow such a reply. Its subscriptions are answered instead.
    if (IsStream(url->path) && IsRead(request_) && !beast::websocket::is_upgrade(request_)) {
      auto reply = SendElsewhere(context_->cluster, *url, access_, stream_.is_tls(), ReadClock());
      if (reply) {
        context_->metrics->Add(Counter::kRedirected);
        co_return co_await WriteReply(stream_, request_, *std::move(reply));
      }
    }
    if (IsPicture(url->path) && request_.method() == http::verb::head) {
      co_return co_await AnswerHeadOfPictures(*std::move(url));
    }
    if (IsPicture(url->path) && IsRead(request_)) {
      co_return co_await ServePictures(&stream_, context_, request_, *url, access_);
    }
    if (url->path == "/weights" && IsRead(request_)) co_return co_await AnswerWeights(*url);
    co_return co_await AnswerPlainRequest(*std::move(url));
  }

  // Without a token everybody gets the page, which asks for one, and the probes of supervisors.
  [[nodiscard]] bool IsForAll(const std::string& path) const {
    const bool is_page = path != kCharacterPath && context_->page.Find(path) != nullptr;
    return is_page || IsProbe(path);
  }

  // True if the client must show a certificate and has not. Probes show none.
  [[nodiscard]] bool LacksCertificate(const std::string& path) const {
    return context_->tls != nullptr && context_->tls->asks_clients() &&
           !stream_.has_client_certificate() && !IsProbe(path);
  }

  // JSON lines, by WebSocket or as an endless body. Returns whether the connection goes on.
  net::awaitable<bool> AnswerWeights(const Url& url) {
    Result<WeightQuery> wanted = WeightsOf(url);
    if (!wanted.ok()) {
      co_return co_await WriteReply(stream_, request_, ErrorReply(wanted.status()));
    }
    if (!access_.Has(Role::kWatch)) {
      co_return co_await WriteReply(stream_, request_, NeedsRole("watch", url.path, access_));
    }
    if (beast::websocket::is_upgrade(request_)) {
      co_await ServeWeightSocket(std::move(stream_), context_, std::move(request_),
                                 *std::move(wanted), access_);
      co_return false;
    }
    if (request_.method() == http::verb::head) {  // the query is valid; subscribe to nothing
      ApiReply reply{.type = "application/jsonl"};
      co_return co_await WriteReply(stream_, request_, std::move(reply));
    }
    co_await ServeWeightLines(&stream_, context_, *std::move(wanted), access_);
    co_return false;
  }

  net::awaitable<bool> AnswerPlainRequest(Url url) {
    const PageFile* file = context_->page.Find(url.path);
    if (file != nullptr && IsRead(request_)) {
      co_return co_await WritePageFile(stream_, request_, *file,
                                       FramesOf(url.path, context_->config));
    }
    if (file != nullptr || IsStream(url.path)) {
      ApiReply reply = MethodReply(ToView(request_.method_string()), url.path, "GET, HEAD");
      co_return co_await WriteReply(stream_, request_, std::move(reply));
    }
    const bool is_api =
        url.path.starts_with("/api/") || url.path == "/metrics" || IsProbe(url.path);
    if (!is_api) {
      co_return co_await WriteReply(stream_, request_, NotFound(url.path));
    }
    if (is_upload_) co_return co_await AnswerUpload(std::move(url));
    ApiRequest request{std::string(ToView(request_.method_string())), std::move(url),
                       std::move(request_.body()), access_, client_.shielded};
    // The routes know GET only; WriteResponse() leaves the body out.
    if (request.method == "HEAD") request.method = "GET";
    // Subjects, settings and rig belong to the hub's thread. The page's files do not, and are sent
    // without asking it.
    ApiReply reply;
    if (IsProbe(request.url.path) &&
        request.method == "GET") {  // no ?:, with which GCC 12 destroys the operands twice
      reply = co_await AnswerProbe(std::move(request));
    } else {
      reply = co_await AnswerApi(std::move(request));
    }
    co_return co_await WriteLargeReply(stream_, request_, std::move(reply), context_->waiting,
                                       client_.host);
  }

  // Nothing is drawn, but the hub's thread knows what else speaks against a picture.
  net::awaitable<bool> AnswerHeadOfPictures(Url url) {
    ApiRequest request{"HEAD", std::move(url), {}, access_, client_.shielded};
    ApiReply reply = co_await AnswerApi(std::move(request));
    co_return co_await WriteReply(stream_, request_, std::move(reply));
  }

  net::awaitable<ApiReply> AnswerApi(ApiRequest request) {
    if (auto throttled = Throttle()) {
      // The client waits, too, so that asking again at once does not cost the web thread more.
      co_await Pause();
      co_return *std::move(throttled);
    }
    co_return co_await AskHub(context_, client_.host, std::move(request));
  }

  // The reply to a host that asks too often.
  std::optional<ApiReply> Throttle() {
    const int seconds = context_->budget->Ask(client_.host, ReadClock());
    if (seconds <= 0) return std::nullopt;
    context_->metrics->Add(Counter::kHttpThrottled);
    ApiReply reply =
        ErrorReply(429, "limit", "", "this address asks the API too often; see http.api_share",
                   "try again in " + std::to_string(seconds) + " s");
    reply.retry_after = seconds;
    return reply;
  }

  // A recording: its body is read if nothing speaks against it, parsed on another thread, and
  // played. False: the connection must close.
  net::awaitable<bool> AnswerUpload(Url url) {
    UploadTurn::Turn turn;
    UploadedFile file;
    auto refusal = BeginUpload(url, &turn, &file);
    if (refusal) {
      SkipBodyLater(std::max<std::uint64_t>(context_->config.upload_bytes(), kMaxWebMessageBytes));
      request_.keep_alive(false);
      co_return co_await WriteReply(stream_, request_, *std::move(refusal));
    }
    const bool expects = beast::iequals(request_[http::field::expect], "100-continue");
    const bool whole = co_await ReceiveUpload(stream_, buffer_, expects, &file);
    if (!whole) co_return false;
    auto loaded = co_await LoadUpload(context_, std::move(file));
    if (!loaded.ok()) {
      turn.reset();
      ApiReply reply = UnreadableReply(loaded.status());
      co_return co_await WriteReply(stream_, request_, std::move(reply));
    }
    ApiRequest request{.method = "POST",
                       .url = std::move(url),
                       .body = {},
                       .access = access_,
                       .shielded = client_.shielded,
                       .recording = *std::move(loaded)};
    ApiReply reply = co_await AskHub(context_, client_.host, std::move(request));
    turn.reset();  // a client that does not read the reply keeps nobody waiting
    co_return co_await WriteReply(stream_, request_, std::move(reply));
  }

  // Takes the turn and the memory of an upload, or returns the reply that refuses it.
  std::optional<ApiReply> BeginUpload(const Url& url, UploadTurn::Turn* turn, UploadedFile* file) {
    if (auto throttled = Throttle()) return throttled;
    const std::uint64_t most = context_->loader != nullptr ? context_->config.upload_bytes() : 0;
    if (auto refusal = RefuseUpload(url, access_, body_bytes_, most, context_->metrics)) {
      return refusal;
    }
    *turn = context_->uploads.Begin(client_.host, ReadClock());
    if (*turn == nullptr) {
      return ErrorReply(503, "unavailable", "", "another recording is being uploaded",
                        "try again in a few seconds");
    }
    file->name = *UploadName(url);
    file->size = static_cast<std::size_t>(*body_bytes_);
    try {
      file->buffer = std::make_unique_for_overwrite<char[]>(file->size);
    } catch (const std::bad_alloc&) {
      context_->metrics->Add(Counter::kAllocationsFailed);
      return ErrorReply(503, "unavailable", "", "not enough memory for the recording",
                        "shorten the recording, or free memory on the daemon's computer");
    }
    return std::nullopt;
  }

  // Supervisors must not be refused because somebody else asks often. So probes have no budget, but
  // share replies for a moment.
  net::awaitable<ApiReply> AnswerProbe(ApiRequest request) {
    const std::string path = request.url.path;
    if (const auto last = context_->probes.find(path);
        last != context_->probes.end() && ReadClock() - last->second.first < kProbeAge) {
      co_return last->second.second;
    }
    std::string nobody;  // pays for it
    ApiReply reply = co_await AskHub(context_, std::move(nobody), std::move(request));
    context_->probes.insert_or_assign(path, std::pair(ReadClock(), reply));
    co_return reply;
  }

  net::awaitable<void> Pause() {
    net::steady_timer pause(stream_.get_executor(), kThrottlePause);
    beast::error_code ignored;
    co_await pause.async_wait(Redirect(ignored));
  }

  WebStream stream_;
  WebContext* context_;
  const PeerLabel client_;
  // Of the present request; see Admit().
  std::optional<Url> url_;
  Access access_;
  std::optional<ApiReply> refusal_;
  bool is_upload_ = false;                   // its body has not been read
  std::optional<std::uint64_t> body_bytes_;  // as the header states
  std::uint64_t unread_bytes_ = 0;           // of its body
  beast::flat_buffer buffer_;
  WebRequest request_;
};

}  // namespace

net::awaitable<void> ServeConnection(WebStream stream, WebContext* context) {
  HttpSession session(std::move(stream), context);
  co_await session.Run();
}

}  // namespace furrow::server
