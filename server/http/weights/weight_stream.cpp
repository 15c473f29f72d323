// SPDX-License-Identifier: Apache-2.0
#include "server/http/weights/weight_stream.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "protocol/codec/codec.h"
#include "server/http/socket/web_peer.h"
#include "server/http/weights/weight_lines.h"

namespace furrow::server {
namespace {

namespace websocket = beast::websocket;

constexpr std::uint64_t kWeightSession = 1;  // any number: the peer has only one session
// Clients send nothing but control frames; what else they send is read and dropped.
constexpr std::size_t kMaxClientMessage = 1024;
// Small, so that a slow client is only a few frames behind.
constexpr int kLineBufferBytes = 64 * 1024;

// The subscriptions behind one response, and their lines. It is used on the web thread.
class LineSource : public std::enable_shared_from_this<LineSource> {
 public:
  LineSource(const net::any_io_executor& executor, WebContext* context, WeightQuery query)
      : wake_(executor), context_(context), query_(std::move(query)), lines_(query_.requests) {
    ++context_->viewers;
  }
  ~LineSource() { --context_->viewers; }
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;

  void Open(PeerLabel label, Access access) {
    // The hub's thread calls this, and the timer belongs to the web thread. Weak, because the
    // stream may have ended by then.
    auto wake = [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->wake_.cancel();
    };
    peer_.emplace(context_->post_to_hub, std::move(label), std::move(access), context_->waiting,
                  [post_to_web = context_->post_to_web, wake] { post_to_web(wake); });
    protocol::Encoder encoder;
    std::uint32_t sequence = 0;
    for (const protocol::SubscribeWeights& request : query_.requests) {
      std::vector<std::uint8_t> bytes;
      encoder.Encode({.session = kWeightSession, .sequence = ++sequence}, request, bytes);
      if (!peer_->Send(std::move(bytes))) ended_ = true;
    }
  }

  // Waits for the next line. False: there is none, because End() was called or the client is slow.
  net::awaitable<bool> Next(std::string* line) {
    std::vector<std::uint8_t> message;
    const auto silence = net::steady_timer::clock_type::now() + query_.alive;
    while (!ended_) {
      if (peer_->overrun()) {
        context_->metrics->Add(Counter::kConnectionsOverrun);
        break;
      }
      if (peer_->Pop(&message)) {
        const WeightLines::Line kind = lines_.Translate(message, line);
        if (kind == WeightLines::Line::kLast) ended_ = true;  // after this line
        if (kind != WeightLines::Line::kNone) co_return true;
        continue;
      }
      wake_.expires_at(silence);
      beast::error_code woken;
      co_await wake_.async_wait(Redirect(woken));
      if (woken) continue;
      *line = WeightLines::kAlive;
      co_return true;
    }
    co_return false;
  }

  // The client has gone.
  void End() {
    ended_ = true;
    wake_.cancel();
  }

 private:
  net::steady_timer wake_;
  WebContext* context_;
  WeightQuery query_;
  WeightLines lines_;
  std::optional<WebPeer> peer_;  // set by Open()
  bool ended_ = false;
};

void SetOptions(WebStream& stream) {
  beast::error_code ignored;
  stream.socket().set_option(net::ip::tcp::no_delay(true), ignored);
  stream.socket().set_option(net::socket_base::send_buffer_size(kLineBufferBytes), ignored);
  // Lines fit into the buffer long after a client has vanished. The kernel would keep trying for
  // about 15 minutes (tcp(7), TCP_USER_TIMEOUT).
  const auto limit = static_cast<unsigned>(
      std::chrono::duration_cast<std::chrono::milliseconds>(kWebDeadline).count());
  setsockopt(stream.socket().native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &limit, sizeof(limit));
}

using Socket = websocket::stream<WebStream>;

void Close(Socket& socket) {
  beast::error_code ignored;
  beast::get_lowest_layer(socket).socket().close(ignored);
}

// Closes the socket, which ends ReadAndDrop(), also after an exception.
struct CloseOnExit {
  Socket* socket;
  ~CloseOnExit() { Close(*socket); }
};

// Reads until the connection ends, which also answers pings and close frames.
net::awaitable<void> ReadAndDrop(std::shared_ptr<Socket> socket,
                                 std::shared_ptr<LineSource> lines) {
  beast::flat_buffer buffer;
  beast::error_code error;
  while (!error) {
    co_await socket->async_read(buffer, Redirect(error));
    buffer.clear();
  }
  lines->End();
}

}  // namespace

net::awaitable<void> ServeWeightSocket(WebStream stream, WebContext* context, WebRequest request,
                                       WeightQuery query, Access access) {
  const PeerLabel label = LabelOfClient(stream);
  stream.expires_never();  // the WebSocket has its own timeouts
  beast::error_code error;
  SetOptions(stream);
  // Shared by the reader and this coroutine; the last one to end closes it.
  const auto socket = std::make_shared<Socket>(std::move(stream));
  // The client need not send anything: the daemon pings it, and closes if no answer comes.
  socket->set_option(websocket::stream_base::timeout{kWebDeadline, kWebIdle, true});
  const bool offers =
      request[http::field::sec_websocket_protocol].find(kWebProtocol) != beast::string_view::npos;
  socket->set_option(
      websocket::stream_base::decorator([offers](websocket::response_type& response) {
        response.set(http::field::server, "furrowd");
        if (offers) response.set(http::field::sec_websocket_protocol, kWebProtocol);
      }));
  socket->read_message_max(kMaxClientMessage);
  socket->auto_fragment(false);
  socket->text(true);
  co_await socket->async_accept(request, Redirect(error));
  if (error) co_return;
  context->metrics->Add(Counter::kWebSocketsAccepted);
  const auto lines =
      std::make_shared<LineSource>(socket->get_executor(), context, std::move(query));
  lines->Open(label, std::move(access));
  net::co_spawn(socket->get_executor(), ReadAndDrop(socket, lines), net::detached);
  const CloseOnExit close_on_exit{socket.get()};
  // The WebSocket's own timeout does not end a client that sends and never reads.
  net::steady_timer write_watch(socket->get_executor());
  const auto watch = [&write_watch, &socket, context](std::chrono::seconds deadline) {
    write_watch.expires_after(deadline);
    write_watch.async_wait(
        [weak = std::weak_ptr<Socket>(socket), context](beast::error_code cancelled) {
          const auto alive = weak.lock();
          if (cancelled || !alive) return;
          context->metrics->Add(Counter::kConnectionsIdle);
          Close(*alive);
        });
  };
  std::string line;
  while (!error) {
    const bool more = co_await lines->Next(&line);
    if (!more) break;
    watch(kWebDeadline);
    co_await socket->async_write(net::buffer(line), Redirect(error));
    write_watch.cancel();
  }
  // After the last line the daemon shuts down, or a newcomer needs the place; otherwise the client
  // is slow or has gone already.
  watch(kWebCloseDeadline);
  co_await socket->async_close(websocket::close_code::going_away, Redirect(error));
}

net::awaitable<void> ServeWeightLines(WebStream* stream, WebContext* context, WeightQuery query,
                                      Access access) {
  beast::error_code error;
  SetOptions(*stream);
  stream->expires_never();
  const auto lines =
      std::make_shared<LineSource>(stream->get_executor(), context, std::move(query));
  lines->Open(LabelOfClient(*stream), std::move(access));
  // The client sends nothing after its request, so readable data means that it has closed.
  stream->socket().async_wait(net::ip::tcp::socket::wait_read,
                              [weak = std::weak_ptr<LineSource>(lines)](beast::error_code) {
                                if (const auto alive = weak.lock()) alive->End();
                              });
  // Written by hand: the body is endless, and Beast's serializer wants to know where it ends.
  std::string out =
      "HTTP/1.1 200 OK\r\nServer: furrowd\r\nCache-Control: no-store\r\nConnection: close\r\n"
      "X-Content-Type-Options: nosniff\r\nContent-Type: application/jsonl\r\n\r\n";
  std::string line;
  while (!error) {
    stream->expires_after(kWebDeadline);
    co_await net::async_write(*stream, net::buffer(out), Redirect(error));
    stream->expires_never();
    if (error) break;
    const bool more = co_await lines->Next(&line);
    if (!more) break;
    out = line + "\n";
  }
}

}  // namespace furrow::server
