// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.h"

#include <array>
#include <chrono>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "base/data_dir.h"
#include "base/status.h"
#include "server/core/accept_log.h"
#include "server/core/network_address.h"
#include "server/core/within_memory.h"
#include "server/http/http_session.h"
#include "server/http/request/web_stream.h"
#include "server/machine/listen_error.h"
#include "server/net/clock.h"
#include "server/net/run_loop.h"
#include "server/session/hub.h"
#include "server/shares/fair_share.h"
#include "server/shares/lobby.h"
#include "server/tls/handshake_places.h"
#include "server/tls/handshake_watch.h"

namespace furrow::server {
namespace {

using net::ip::tcp;
constexpr auto kAcceptPause = std::chrono::milliseconds(100);

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

// Answers a client that speaks plain HTTP where TLS is spoken, and waits until it has closed:
// closing with unread input would reset the connection and lose the answer.
net::awaitable<void> RefusePlain(tcp::socket& socket) {
  static constexpr char kAnswer[] =
      "HTTP/1.1 400 Bad Request\r\nConnection: close\r\nContent-Type: text/plain\r\n"
      "Content-Length: 62\r\n\r\n"
      "this port speaks HTTPS only: begin the address with https://.\n";
  beast::error_code error;
  socket.send(net::buffer(kAnswer, sizeof(kAnswer) - 1), 0, error);
  socket.shutdown(tcp::socket::shutdown_send, error);
  std::array<char, 1024> dropped;
  while (!error) co_await socket.async_read_some(net::buffer(dropped), Redirect(error));
}

// Waits for the first bytes, which stay in the socket. Nothing: the client has closed.
net::awaitable<std::optional<bool>> SpeaksTls(tcp::socket& socket) {
  beast::error_code error;
  co_await socket.async_wait(tcp::socket::wait_read, Redirect(error));
  std::array<std::uint8_t, kTlsPrefixBytes> first;
  std::size_t size = 0;
  if (!error) socket.non_blocking(true, error);
  if (!error) size = socket.receive(net::buffer(first), tcp::socket::message_peek, error);
  if (error) co_return std::nullopt;
  co_return LooksLikeTls(std::span(first).first(size));
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

  Status Listen(const std::string& bind, std::uint16_t port);
  Status Adopt(const ServiceManager::Listener& listener);
  net::awaitable<void> Accept();
  void Admit(tcp::socket socket, const std::string& host);
  net::awaitable<void> WaitForPlace(tcp::socket socket, std::string host, Lobby::Stay stay);
  net::awaitable<void> Serve(tcp::socket socket, std::string host);
  net::awaitable<bool> BeginTls(WebStream* stream, const std::string& host);
  void Run();
  // Ends the daemon, by an exception of the hub's loop.
  void EndHub(const std::exception_ptr& error);

  WebContext context;  // outlives the loop; its connections use it
  const std::function<std::filesystem::path()> find_character;
  HandshakeBudget handshakes;
  HandshakePlaces handshake_places;
  FairShare shares{static_cast<std::size_t>(context.config.max_connections)};
  Lobby lobby;  // of newcomers that wait for a place
  std::shared_ptr<net::io_context> loop = std::make_shared<net::io_context>(1);
  tcp::acceptor acceptor{*loop};
  AcceptLog accept_log{"web port", "http.max_connections", context.metrics};
  HostPort address;
  std::thread thread;
};

Status HttpServer::Impl::Listen(const std::string& bind, std::uint16_t wanted) {
  const tcp::endpoint endpoint(net::ip::make_address(bind), wanted);
  beast::error_code error;
  acceptor.open(endpoint.protocol(), error);
  // Allows a port in TIME_WAIT, so that a restart does not fail. A port with a listener stays an
  // error.
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  if (error) {
    beast::error_code ignored;
    // HttpServer::Listen() may call this again with another port.
    acceptor.close(ignored);
    return ListenError("TCP", {bind, wanted}, error.value(), "--http (or use --no-http)");
  }
  address = {bind, acceptor.local_endpoint().port()};
  return {};
}

Status HttpServer::Impl::Adopt(const ServiceManager::Listener& listener) {
  beast::error_code error;
  acceptor.assign(listener.is_v6 ? tcp::v6() : tcp::v4(), listener.socket, error);
  if (error) {
    return Status(StatusCode::kIo,
                  "cannot use the socket 'http' of the service manager: " + error.message());
  }
  address = {listener.address, acceptor.local_endpoint().port()};
  return {};
}

net::awaitable<void> HttpServer::Impl::Accept() {
  while (acceptor.is_open()) {
    beast::error_code error;
    auto socket = co_await acceptor.async_accept(Redirect(error));
    if (error == net::error::operation_aborted) co_return;
    if (error) {  // usually no descriptors are left; try again later
      accept_log.Failed(error.message());
      net::steady_timer pause(*loop, kAcceptPause);
      beast::error_code ignored;
      co_await pause.async_wait(Redirect(ignored));
      continue;
    }
    accept_log.Accepted();
    const auto client = socket.remote_endpoint(error);
    try {
      std::string host = error ? std::string() : HostOf(client.address().to_string());
      Lobby::Stay stay;
      if (lobby.HasQueue(host) || !shares.HasRoomFor(host)) stay = lobby.Enter(host, ReadClock());
      if (stay == nullptr) {
        Admit(std::move(socket), host);
      } else {
        // Detached is safe: neither coroutine lets an exception out, and the context outlives the
        // loop.
        net::co_spawn(*loop, WaitForPlace(std::move(socket), std::move(host), std::move(stay)),
                      net::detached);
      }
    } catch (const std::bad_alloc&) {
      context.metrics->Add(Counter::kAllocationsFailed);  // it costs one connection
    }
  }
}

// Each connection may hold a request of kMaxWebMessageBytes, so their number bounds the memory.
void HttpServer::Impl::Admit(tcp::socket socket, const std::string& host) {
  if (!shares.Enter(host)) {
    context.metrics->Add(Counter::kConnectionsRefused);
    return Refuse(std::move(socket));
  }
  context.metrics->Add(Counter::kHttpConnections);
  try {
    net::co_spawn(*loop, Serve(std::move(socket), host), net::detached);
  } catch (...) {
    shares.Leave(host);
    throw;
  }
}

// The hub knows which connections are without use, and ends the one that has been so for longest.
net::awaitable<void> HttpServer::Impl::WaitForPlace(tcp::socket socket, std::string host,
                                                    Lobby::Stay stay) {
  try {
    const auto all_in_use = std::make_shared<bool>(false);
    const Time begun = ReadClock();
    Time again = begun;
    net::steady_timer timer(*loop);
    while (!*all_in_use && !(lobby.IsFirst(host, stay) && shares.HasRoomFor(host))) {
      const Time now = ReadClock();
      if (now - begun >= Lobby::kPatience) break;
      if (now >= again) {
        again = now + kGivesWay;
        context.post_to_hub([host, any_host = shares.held(host) == 0, all_in_use,
                             post_to_web = context.post_to_web](Hub& hub, Time hub_now) {
          if (hub.MakeRoom(Transport::kWeb, host, any_host, hub_now)) return;
          post_to_web([all_in_use] { *all_in_use = true; });
        });
      }
      timer.expires_after(Lobby::kPoll);
      beast::error_code ignored;
      co_await timer.async_wait(Redirect(ignored));
    }
    Admit(std::move(socket), host);
  } catch (const std::bad_alloc&) {
    context.metrics->Add(Counter::kAllocationsFailed);
  }
}

// `host`: of the client, which has a place in `shares`.
net::awaitable<void> HttpServer::Impl::Serve(tcp::socket socket, std::string host) {
  ++context.connections;
  try {
    WebStream stream(std::move(socket));
    bool begins = context.tls == nullptr || !context.tls->enabled();
    if (!begins) begins = co_await BeginTls(&stream, host);
    if (begins) co_await ServeConnection(std::move(stream), &context);
  } catch (const std::exception& error) {  // such as out of memory: affects this connection only
    spdlog::error("a web connection failed: {}", error.what());
  }
  --context.connections;
  shares.Leave(host);
}

// False: the connection must close.
net::awaitable<bool> HttpServer::Impl::BeginTls(WebStream* stream, const std::string& host) {
  const HandshakeWatch<net::steady_timer, tcp::socket> watch(stream->socket());
  const std::optional<bool> is_tls = co_await SpeaksTls(stream->socket());
  if (!is_tls) {  // it has closed, or waited too long
    if (watch.expired()) context.metrics->Add(Counter::kTlsSlow);
    co_return false;
  }
  if (!*is_tls) {
    context.metrics->Add(Counter::kTlsPlain);
    co_await RefusePlain(stream->socket());
    co_return false;
  }
  if (!handshakes.Take(host, ReadClock())) {
    context.metrics->Add(Counter::kTlsBusy);
    co_return false;
  }
  // The watch ends the wait, too.
  HandshakePlaces::Place place;
  net::steady_timer timer(*loop);
  while (!watch.expired() && (place = handshake_places.Enter(host)) == nullptr) {
    timer.expires_after(HandshakePlaces::kPoll);
    beast::error_code ignored;
    co_await timer.async_wait(Redirect(ignored));
  }
  const beast::error_code error = co_await stream->Handshake(context.tls->for_web());
  place.reset();
  if (error) {
    context.metrics->Add(watch.expired()
                             ? Counter::kTlsSlow
                             : HandshakeFailure(static_cast<unsigned long>(error.value())));
    co_return false;
  }
  context.metrics->Add(Counter::kTlsHandshakes);
  co_return true;
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
  Status status = listener ? impl->Adopt(*listener)
                           : impl->Listen(bind, asked.value_or(HttpConfig::kDefaultPort));
  // Only the default port may be replaced. A port that the user asked for is an error if it is
  // taken.
  if (!status.ok() && !asked && !listener) {
    spdlog::warn("{}; using any free port", status.what());
    status = impl->Listen(bind, 0);
  }
  if (!status.ok()) return status;
  return std::unique_ptr<HttpServer>(new HttpServer(std::move(impl)));
}

void HttpServer::Start() {
  net::co_spawn(*impl_->loop, impl_->Accept(), [](const std::exception_ptr& failed) {
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

int HttpServer::listening_socket() const { return impl_->acceptor.native_handle(); }

const HostPort& HttpServer::address() const { return impl_->address; }
int HttpServer::connections() const { return impl_->context.connections; }
int HttpServer::viewers() const { return impl_->context.viewers; }

// The context belongs to the web thread.
void HttpServer::Reload(const HttpConfig& config) {
  net::post(*impl_->loop, [this, config] {
    WebContext& context = impl_->context;
    context.guard = RequestGuard(config);
    context.config.allow_origins = config.allow_origins;  // of pages that may frame /embed
    impl_->shares.SetPlaces(static_cast<std::size_t>(config.max_connections));
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
  // An acceptor is not thread-safe, and Accept() uses it on the web thread.
  net::post(*impl_->loop, [this] {
    beast::error_code ignored;
    impl_->acceptor.close(ignored);
  });
}

}  // namespace furrow::server
