// SPDX-License-Identifier: Apache-2.0
#include "server/http/socket/web_socket.h"

#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "protocol/codec/codec.h"
#include "server/http/socket/web_message.h"
#include "server/http/socket/web_peer.h"

namespace furrow::server {
namespace {

namespace websocket = beast::websocket;

// What a client that waits may keep of the memory of its last message.
constexpr std::size_t kMaxKeptMessageBytes = 64 * 1024;

// One WebSocket: a reader and a writer coroutine on the web thread. Beast allows one read and one
// write at a time, and each coroutine does only one of them.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(WebStream stream, WebContext* context, Access access)
      : socket_(std::move(stream)),
        wake_(socket_.get_executor()),
        write_watch_(socket_.get_executor()),
        context_(context),
        access_(std::move(access)) {
    ++context_->viewers;
  }
  ~WebSocketSession() { --context_->viewers; }

  net::awaitable<void> Run(WebRequest request) {
    if (!co_await Accept(request)) co_return;
    context_->metrics->Add(Counter::kWebSocketsAccepted);
    auto wake = [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->wake_.cancel();
    };
    // Made before the peer, so that the writer ends and the hub forgets the peer whatever happens
    // below.
    const AbortOnExit abort_on_exit{this};  // also after an exception
    peer_.emplace(context_->post_to_hub, label_, access_, context_->waiting,
                  [post_to_web = context_->post_to_web, wake] { post_to_web(wake); });
    // The writer holds the session, which therefore outlives this function until the writer has
    // seen closed_.
    net::co_spawn(
        socket_.get_executor(), [self = shared_from_this()] { return self->Write(); },
        [self = shared_from_this()](const std::exception_ptr& failed) {
          if (failed) self->Abort();
        });
    co_await Read();
  }

 private:
  struct AbortOnExit {
    WebSocketSession* session;
    ~AbortOnExit() {
      session->Abort();
      // Write() uses the peer only while closed_ is false, and Abort() has just set it.
      session->peer_.reset();
    }
  };

  net::awaitable<bool> Accept(const WebRequest& request) {
    beast::error_code ignored;
    auto& tcp = beast::get_lowest_layer(socket_);
    label_ = LabelOfClient(tcp);
    // Weights are small messages that must not wait for an acknowledgement (Nagle's algorithm).
    tcp.socket().set_option(net::ip::tcp::no_delay(true), ignored);
    tcp.expires_never();  // the WebSocket has its own timeouts
    socket_.set_option(websocket::stream_base::timeout{kWebDeadline, kWebIdle, false});
    socket_.set_option(websocket::stream_base::decorator([&](websocket::response_type& response) {
      response.set(http::field::server, "furrowd");
      const beast::string_view offered = request[http::field::sec_websocket_protocol];
      if (offered.find(kWebProtocol) != beast::string_view::npos) {
        response.set(http::field::sec_websocket_protocol, kWebProtocol);
      }
    }));
    // Beast fails the read of a longer message instead of buffering it.
    socket_.read_message_max(kMaxWebMessageBytes);
    // One message per frame: cutting pictures into small frames only adds work.
    socket_.auto_fragment(false);
    socket_.binary(true);
    beast::error_code error;
    co_await socket_.async_accept(request, Redirect(error));
    co_return !error;
  }

  net::awaitable<void> Read() {
    beast::flat_buffer buffer;
    while (!closed_) {
      beast::error_code error;
      co_await socket_.async_read(buffer, Redirect(error));
      if (error == websocket::error::message_too_big) {  // Beast has sent close code 1009
        context_->metrics->Add(Counter::kConnectionsMalformed);
      }
      if (error) co_return;
      const auto* bytes = static_cast<const std::uint8_t*>(buffer.cdata().data());
      // A copy, which moves to the hub's thread; the buffer is used for the next message.
      std::vector<std::uint8_t> message(bytes, bytes + buffer.size());
      buffer.consume(buffer.size());
      if (const auto code = Refuse(message); code != websocket::close_code::none) {
        context_->metrics->Add(Counter::kConnectionsMalformed);
        co_await CloseWith(code);
        co_return;
      }
      // The client sends faster than the hub reads. Waiting here instead would only fill the
      // kernel's buffers.
      if (!peer_->Send(std::move(message))) {
        context_->metrics->Add(Counter::kConnectionsOverrun);
        co_await CloseWith(websocket::close_code::policy_error);
        co_return;
      }
    }
  }

  // Only messages that are not of this wire close the connection. The hub answers other errors.
  [[nodiscard]] websocket::close_code Refuse(const std::vector<std::uint8_t>& message) const {
    if (socket_.got_text()) return websocket::close_code::unknown_data;
    if (!IsWebMessage(message)) return websocket::close_code::protocol_error;
    return websocket::close_code::none;
  }

  net::awaitable<void> CloseWith(websocket::close_code code) {
    // Reader and writer may both want to close; Beast allows one close.
    if (std::exchange(closing_, true)) co_return;
    WatchWrite(kWebCloseDeadline);
    beast::error_code ignored;
    co_await socket_.async_close(code, Redirect(ignored));
  }

  net::awaitable<void> Write() {
    std::vector<std::uint8_t> out;
    while (!closed_) {
      // The client has not read for a long time and would not read a close frame either.
      if (peer_->overrun()) {
        context_->metrics->Add(Counter::kConnectionsOverrun);
        Abort();
      } else if (peer_->Pop(&out)) {
        WatchWrite(kWebDeadline);
        beast::error_code error;
        co_await socket_.async_write(net::buffer(out), Redirect(error));
        write_watch_.cancel();
        if (error) Abort();
        // The last message before the daemon ends. Closing here lets the shutdown proceed before
        // its deadline.
        if (IsFinalGoodbye(out)) {
          co_await CloseWith(websocket::close_code::going_away);
          co_return;
        }
      } else {
        if (out.capacity() > kMaxKeptMessageBytes) out = {};  // the memory of a picture
        wake_.expires_at(net::steady_timer::time_point::max());
        beast::error_code ignored;
        co_await wake_.async_wait(Redirect(ignored));
      }
    }
  }

  // True for a goodbye to the whole peer: the daemon shuts down.
  static bool IsFinalGoodbye(const std::vector<std::uint8_t>& message) {
    protocol::MessageView view;
    return protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) ==
               protocol::DecodeStatus::kOk &&
           view.kind == protocol::MessageKind::kGoodbye && view.header.stream == 0;
  }

  // Closes the connection if the client does not read a message in time.
  void WatchWrite(std::chrono::seconds deadline) {
    write_watch_.expires_after(deadline);
    // Weak: a waiting timer must not keep a closed session alive.
    write_watch_.async_wait([weak = weak_from_this()](beast::error_code error) {
      if (error) return;
      if (const auto self = weak.lock()) {
        self->context_->metrics->Add(Counter::kConnectionsIdle);
        self->Abort();
      }
    });
  }

  // Closes the socket, which ends both loops.
  void Abort() {
    closed_ = true;
    beast::error_code ignored;
    // Pending reads and writes complete with an error.
    beast::get_lowest_layer(socket_).socket().close(ignored);
    wake_.cancel();
    write_watch_.cancel();
  }

  websocket::stream<WebStream> socket_;
  net::steady_timer wake_;
  net::steady_timer write_watch_;
  WebContext* context_;
  const Access access_;
  PeerLabel label_ = "web";
  std::optional<WebPeer> peer_;  // while the connection is open
  bool closed_ = false;
  bool closing_ = false;  // the close frame is being sent
};

}  // namespace

net::awaitable<void> ServeWebSocket(WebStream stream, WebContext* context, WebRequest request,
                                    Access access) {
  auto session = std::make_shared<WebSocketSession>(std::move(stream), context, std::move(access));
  co_await session->Run(std::move(request));
}

}  // namespace furrow::server
