// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <spdlog/spdlog.h>

#include "base/data_dir.h"
#include "base/status.h"
#include "server/core/within_memory.h"
#include "server/http/http_session.h"
#include "server/http/stream/web_net.h"
#include "server/http/stream/web_stream.h"
#include "server/net/door/door.h"
#include "server/net/door/end_notice.h"
#include "server/net/door/handshake_gate.h"
#include "server/net/run_loop.h"
#include "server/session/hub.h"
#include "server/shares/lobby.h"

namespace furrow::server {
namespace {

using net::ip::tcp;

// Answers with 429 and closes: the socket goes out of scope. The answer fits into the send buffer
// of a new socket.
void Refuse(tcp::socket socket) {
  static const std::string kBody =
      ErrorReply(429, "limit", "", "this address has its share of the web connections",
                 "close other pages, or see http.max_connections")
          .body;
  static const std::string kAnswer =
      "HTTP/1.1 429 Too Many Requests\r\nConnection: close\r\nRetry-After: 1\r\n"
      "Content-Type: application/json\r\nContent-Length: " +
      std::to_string(kBody.size()) + "\r\n\r\n" + kBody;
  beast::error_code ignored;
  socket.non_blocking(true, ignored);
  socket.send(net::buffer(kAnswer), 0, ignored);
}

// A connection that gives way may take kWebCloseDeadline to close. Until then, no other one must.
constexpr Time kGivesWay = kWebCloseDeadline + std::chrono::milliseconds(100);
static_assert(kGivesWay < Lobby::kPatience);

// Answers a client that speaks plain HTTP where TLS is spoken.
void RefusePlain(tcp::socket& socket) {
  static constexpr char kAnswer[] =
      "HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Type: text/plain\r\n"
      "Content-Length: 62\r\n\r\n"
      "this port speaks HTTPS only: begin the address with https://.\n";
  beast::error_code ignored;
  socket.send(net::buffer(kAnswer, sizeof(kAnswer) - 1), 0, ignored);
  socket.shutdown(tcp::socket::shutdown_send, ignored);
}

Result<PageFiles> LoadPage(const HttpConfig& config) {
  if (!config.page.empty()) return PageFiles::Load(config.page);
  const auto index = furrow::FindDataFile("web/index.html");
  FURROW_RETURN_IF_ERROR(index);
  return PageFiles::Load(index->parent_path());
}

// Strangers may ask for the character, so it is small, and read and compressed only once.
constexpr std::uintmax_t kMaxCharacterBytes = 4'000'000;

// An installation without the page still has the API, WebSockets and pictures.
PageFiles PageOrNone(const HttpConfig& config,
                     const std::function<std::filesystem::path()>& find_character,
                     Metrics* metrics) {
  Result<PageFiles> page = OrOutOfMemory(metrics, "http.page", [&] { return LoadPage(config); });
  if (!page.ok()) {
    spdlog::warn("serving without a web page: {}", page.status().ToString());
    return {};
  }
  const auto character = find_character ? find_character() : std::filesystem::path();
  if (!character.empty()) {
    const Status status = OrOutOfMemory(metrics, "http.page", [&] {
      return page->Add(kCharacterPath, character, kMaxCharacterBytes);
    });
    if (!status.ok()) spdlog::warn("browsers cannot draw the character: {}", status.ToString());
  }
  return *std::move(page);
}

}  // namespace

struct HttpServer::Impl {
  explicit Impl(Parts parts)
      : context{.config = parts.config,
                .guard = RequestGuard(parts.config),
                .page = {},
                .post_to_hub = std::move(parts.post_to_hub),
                .answer = std::move(parts.answer),
                .metrics = parts.metrics,
                .waiting = parts.waiting,
                .gate = parts.gate,
                .tls = parts.tls,
                .cluster = parts.cluster,
                .loader = parts.loader,
                .uploads = {}},
        find_character(std::move(parts.find_character)) {
    // Weak: tasks in the hub's queue may hold this function after the web server has gone.
    context.post_to_web = [weak = std::weak_ptr(loop)](std::function<void()> task) {
      if (const auto alive = weak.lock()) net::post(*alive, std::move(task));
    };
  }

  [[nodiscard]] Door<WebNet>::Parts DoorParts();
  [[nodiscard]] HandshakeGate<WebNet>::Parts GateParts();
  [[nodiscard]] bool speaks_tls() const { return context.tls != nullptr && context.tls->enabled(); }
  void Admit(tcp::socket socket, const std::string& host);
  void MakeRoom(const std::string& host, bool any_host, RoomRequest* request);
  void Begin(tcp::socket socket, const std::string& host, HandshakeGate<WebNet>::Place place);
  void End(const std::string& host);
  [[nodiscard]] bool IsOpenFor(const WebStream& stream) const;
  net::awaitable<void> Serve(tcp::socket socket, std::string host,
                             HandshakeGate<WebNet>::Place place);
  void Run();
  // Ends the daemon, by an exception of the hub's loop.
  void EndHub(const std::exception_ptr& error);

  WebContext context;  // outlives the loop; its connections use it
  const std::function<std::filesystem::path()> find_character;
  std::shared_ptr<net::io_context> loop = std::make_shared<net::io_context>(1);
  HandshakeGate<WebNet> handshakes{*loop, GateParts()};
  Door<WebNet> door{*loop, DoorParts()};
  std::thread thread;
  // The loop destroys coroutines that have not ended, after what they would use.
  const std::shared_ptr<void> owner = std::make_shared<char>();
};

// Each connection may hold a request of kMaxWebMessageBytes, so their number bounds the memory.
Door<WebNet>::Parts HttpServer::Impl::DoorParts() {
  return {.port = "web port",
          .limit = "http.max_connections",
          .flag = "--http (or use --no-http)",
          .listener = "http",
          .places = static_cast<std::size_t>(context.config.max_connections),
          .newcomers = speaks_tls() ? Lobby::kFewPlaces : Lobby::kPlaces,
          .again = kGivesWay,
          .metrics = context.metrics,
          .begin = [this](tcp::socket socket,
                          const std::string& host) { Admit(std::move(socket), host); },
          .refuse = Refuse,
          .make_room = [this](const std::string& host, bool any_host, Time,
                              RoomRequest* request) { MakeRoom(host, any_host, request); }};
}

// The gate makes no handshakes without a certificate.
HandshakeGate<WebNet>::Parts HttpServer::Impl::GateParts() {
  return {
      .metrics = context.metrics,
      .places = context.tls != nullptr ? &context.tls->places() : nullptr,
      .context = [this] { return context.tls->for_web(); },
      .answer_plain = RefusePlain,
      .begin =
          [this](tcp::socket socket, const std::string& host, HandshakeGate<WebNet>::Place place) {
            Begin(std::move(socket), host, std::move(place));
          },
      .ended = [this](const std::string& host) { End(host); }};
}

// The host has a place for the connection.
void HttpServer::Impl::Admit(tcp::socket socket, const std::string& host) {
  context.metrics->Add(Counter::kHttpConnections);
  speaks_tls() ? handshakes.Enter(std::move(socket), host)
               : Begin(std::move(socket), host, nullptr);
  ++context.connections;  // after what may throw
}

// `place`: the connection begins with a handshake; null: it does not.
void HttpServer::Impl::Begin(tcp::socket socket, const std::string& host,
                             HandshakeGate<WebNet>::Place place) {
  // Detached is safe: Serve() lets no exception out, and the context outlives the loop.
  net::co_spawn(*loop, Serve(std::move(socket), host, std::move(place)), net::detached);
}

// A connection that Admit() has let in has ended.
void HttpServer::Impl::End(const std::string& host) {
  --context.connections;
  door.FreePlace(host);
}

// The client of a new connection over TLS need not show who it is, or has done so.
bool HttpServer::Impl::IsOpenFor(const WebStream& stream) const {
  const bool needs_token = context.gate != nullptr && context.gate->required();
  return !needs_token && (!context.tls->asks_clients() || stream.has_client_certificate());
}

// The hub knows which connections are without use, and ends the one that has been so for longest.
void HttpServer::Impl::MakeRoom(const std::string& host, bool any_host, RoomRequest* request) {
  context.post_to_hub([host, any_host, refused = request->RefuseLater(),
                       post_to_web = context.post_to_web](Hub& hub, Time hub_now) {
    if (hub.MakeRoom(Transport::kWeb, host, any_host, hub_now)) return;
    post_to_web([refused] { *refused = true; });
  });
}

// `host`: of the client, which has a place. `place`: for its handshake; null: it makes none.
net::awaitable<void> HttpServer::Impl::Serve(tcp::socket socket, std::string host,
                                             HandshakeGate<WebNet>::Place place) {
  const EndNotice notice(owner, [this, &host] { End(host); });
  try {
    WebStream stream(std::move(socket));
    bool begins = place == nullptr;
    if (!begins) {
      begins = co_await handshakes.Pass(stream, std::move(place));
      if (begins && IsOpenFor(stream)) stream.Admit();
    }
    if (begins) co_await ServeConnection(std::move(stream), &context);
  } catch (const std::exception& error) {  // such as out of memory: affects this connection only
    spdlog::error("a web connection failed: {}", error.what());
  }
}

void HttpServer::Impl::EndHub(const std::exception_ptr& error) {
  context.post_to_hub([error](Hub&, Time) { std::rethrow_exception(error); });
}

// An exception that ends the web loop also ends the hub's loop, so that the daemon does not run on
// without its web server.
void HttpServer::Impl::Run() {
  try {
    // Here, because reading and compressing takes a while, and weights need not wait for it.
    context.page = PageOrNone(context.config, find_character, context.metrics);
    RunLoop(*loop, context.metrics);
  } catch (const std::bad_alloc&) {
    // The hub's loop takes a std::bad_alloc for the failure of one handler.
    EndHub(std::make_exception_ptr(std::runtime_error("out of memory: the web server has ended")));
  } catch (...) {
    EndHub(std::current_exception());
  }
}

Result<std::unique_ptr<HttpServer>> HttpServer::Listen(Parts parts) {
  const std::string bind = parts.bind;
  const std::optional<std::uint16_t> asked = parts.config.port;
  const std::optional<ServiceManager::Listener> listener = parts.listener;
  auto impl = std::make_unique<Impl>(std::move(parts));
  Status status = listener ? impl->door.Adopt(*listener)
                           : impl->door.Open({bind, asked.value_or(HttpConfig::kDefaultPort)});
  // Only the default port may be replaced. A port that the user asked for is an error if it is
  // taken.
  if (!status.ok() && !asked && !listener) {
    spdlog::warn("{}; using any free port", status.what());
    status = impl->door.Open({bind, 0});
  }
  if (!status.ok()) return status;
  return std::unique_ptr<HttpServer>(new HttpServer(std::move(impl)));
}

void HttpServer::Start() {
  net::co_spawn(*impl_->loop, impl_->door.Accept(), [](const std::exception_ptr& failed) {
    // Not std::bad_alloc, which RunLoop() takes for the failure of one handler.
    if (failed) throw std::runtime_error("the web server cannot accept connections any more");
  });
  // After co_spawn(), so that run() finds work and does not return at once.
  impl_->thread = std::thread([impl = impl_.get()] { impl->Run(); });
}

HttpServer::HttpServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

HttpServer::~HttpServer() {
  // The coroutines do not end; they are destroyed with the loop. Their destructors call
  // post_to_hub, so the hub's event loop must still exist.
  impl_->loop->stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

int HttpServer::listening_socket() const { return impl_->door.socket(); }

const HostPort& HttpServer::address() const { return impl_->door.address(); }
int HttpServer::connections() const { return impl_->context.connections; }
int HttpServer::viewers() const { return impl_->context.viewers; }

// The context belongs to the web thread.
void HttpServer::Reload(const HttpConfig& config) {
  net::post(*impl_->loop, [this, config] {
    WebContext& context = impl_->context;
    context.guard = RequestGuard(config);
    context.config.allow_origins = config.allow_origins;  // of pages that may frame /embed
    impl_->door.SetPlaces(static_cast<std::size_t>(config.max_connections));
    // What hosts have used up is forgotten, so only changes count.
    if (config.api_share != context.config.api_share) {
      context.budget = std::make_shared<RequestBudget>(config.api_share);
    }
    if (config.requests_per_second != context.config.requests_per_second) {
      context.pace = HostRates(static_cast<std::uint32_t>(config.requests_per_second));
    }
    context.config.max_upload_megabytes = config.max_upload_megabytes;
    context.config.api_share = config.api_share;
    context.config.requests_per_second = config.requests_per_second;
  });
}

void HttpServer::Drain() {
  // The door belongs to the web thread.
  net::post(*impl_->loop, [this] { impl_->door.StopListening(); });
}

}  // namespace furrow::server
