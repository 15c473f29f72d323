// SPDX-License-Identifier: Apache-2.0
#include "server/http/pictures/picture_stream.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include "protocol/codec/codec.h"
#include "server/http/pictures/picture_query.h"
#include "server/http/pictures/picture_replies.h"
#include "server/http/request/reply_writer.h"
#include "server/http/socket/web_peer.h"

namespace furrow::server {
namespace {

constexpr char kBoundary[] = "furrow-picture";  // as in kMjpegType
// Small, so that a slow client is at most a picture or two behind.
constexpr int kSendBufferBytes = 128 * 1024;
// What a stream that waits may keep of the memory of its last picture.
constexpr std::size_t kMaxKeptPictureBytes = 256 * 1024;
constexpr std::uint64_t kSession = 1;  // any number: the peer has only one session

// The subscription behind one HTTP response. It is used on the web thread; its peer carries the
// messages to and from the hub's thread.
class PictureStream : public std::enable_shared_from_this<PictureStream> {
 public:
  PictureStream(WebStream* stream, WebContext* context)
      : stream_(stream), wake_(stream->get_executor()), context_(context) {
    ++context_->viewers;
  }
  ~PictureStream() { --context_->viewers; }

  void Open(const protocol::SubscribePictures& pictures, const Access& access) {
    waits_ = pictures.wait;
    // The peer calls this on the hub's thread, and the timer belongs to the web thread, so it is
    // posted. Weak, because the stream may have ended by then.
    auto wake = [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->wake_.cancel();
    };
    peer_.emplace(context_->post_to_hub, LabelOfClient(*stream_, "web pictures"), access,
                  context_->waiting,
                  [post_to_web = context_->post_to_web, wake] { post_to_web(wake); });
    Send(0, pictures);
  }

  // A picture, or a refusal that says why there is none. Neither: the stream has ended.
  struct Next {
    bool has_image = false;
    std::optional<ApiReply> refusal;
  };
  net::awaitable<Next> Wait(std::optional<std::chrono::steady_clock::time_point> deadline) {
    std::vector<std::uint8_t> message;
    while (true) {
      // Takes everything that waits: one wake-up may stand for several messages.
      while (peer_->Pop(&message)) {
        if (std::optional<Next> next = Take(message); next) co_return *std::move(next);
      }
      // After the queue, so that a picture that arrived in time is not refused.
      if (deadline && std::chrono::steady_clock::now() >= *deadline) {
        co_return Next{false, ErrorReply(503, "unavailable", "subject",
                                         "no picture within 10 s: no pose arrived, the renderer is "
                                         "still preparing its shaders, or this address has no room "
                                         "for what waits",
                                         "try again")};
      }
      if (peer_->overrun()) {
        context_->metrics->Add(Counter::kConnectionsOverrun);
        gone_ = true;
      }
      if (gone_) co_return Next{};
      // Streams of usual size keep their memory from picture to picture.
      if (image_.bytes.capacity() > kMaxKeptPictureBytes) image_.bytes = {};
      // Waits for a message or the deadline; both end the wait in the same way.
      wake_.expires_at(deadline.value_or(net::steady_timer::time_point::max()));
      beast::error_code ignored;
      co_await wake_.async_wait(Redirect(ignored));
    }
  }
  // Ends the wait when the client closes, so that nobody draws for it. A client of /mjpeg sends
  // nothing after its request, so any readable data means that it has closed. `sends_more`: the
  // client may already send its next request; then only the end of the connection counts.
  void WatchForEnd(bool sends_more) {
    const auto end = [weak = weak_from_this(), sends_more](beast::error_code) {
      const auto self = weak.lock();
      if (self == nullptr || (sends_more && !self->stream_->HasEnded())) return;
      self->gone_ = true;
      self->wake_.cancel();
    };
    stream_->socket().async_wait(net::ip::tcp::socket::wait_read, end);
  }
  void Acknowledge() { Send(subscription_, protocol::FrameAck{image_.number}); }
  [[nodiscard]] const protocol::ImageFrame& image() const { return image_; }
  // The client has closed.
  [[nodiscard]] bool is_gone() const { return gone_; }

 private:
  template <class Message>
  void Send(std::uint16_t stream, const Message& message) {
    std::vector<std::uint8_t> bytes;
    encoder_.Encode({.session = kSession, .stream = stream, .sequence = ++requests_}, message,
                    bytes);
    if (!peer_->Send(std::move(bytes))) gone_ = true;
  }

  // What a message of the hub means for the response; nullopt: nothing, wait on.
  std::optional<Next> Take(const std::vector<std::uint8_t>& message) {
    protocol::MessageView view;
    if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) !=
        protocol::DecodeStatus::kOk) {
      return std::nullopt;
    }
    if (view.kind == protocol::MessageKind::kImage) {
      subscription_ = view.header.stream;
      // image_ keeps its memory from picture to picture.
      const bool good = protocol::Decode(view, image_) == protocol::DecodeStatus::kOk;
      return good ? std::optional(Next{true, std::nullopt}) : std::nullopt;
    }
    if (view.kind == protocol::MessageKind::kGoodbye) {
      // A goodbye on a stream concerns the subject, which may come back.
      const bool goes_on = waits_ && view.header.stream != 0;
      return goes_on ? std::nullopt : std::optional(Next{});
    }
    protocol::ErrorMessage error;
    if (protocol::Decode(view, error) != protocol::DecodeStatus::kOk) return std::nullopt;
    return Next{false, PictureRefusal(error)};
  }

  WebStream* stream_;
  net::steady_timer wake_;
  WebContext* context_;
  std::optional<WebPeer> peer_;  // set by Open()
  protocol::Encoder encoder_;
  std::uint32_t requests_ = 0;
  std::uint16_t subscription_ = 0;
  bool waits_ = false;  // stay while the subject is absent
  protocol::ImageFrame image_;
  bool gone_ = false;
};

// Writes the three parts with one gathered write. False: the client has gone or does not read.
net::awaitable<bool> WriteAll(WebStream* stream, std::string_view head,
                              const std::vector<std::uint8_t>& body, std::string_view tail) {
  const std::array<net::const_buffer, 3> parts = {net::buffer(head.data(), head.size()),
                                                  net::buffer(body),
                                                  net::buffer(tail.data(), tail.size())};
  stream->expires_after(kWebDeadline);
  beast::error_code error;
  co_await net::async_write(*stream, parts, Redirect(error));
  co_return !error;
}

std::string PartHead(std::size_t bytes) {
  return std::string("--") + kBoundary +
         "\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(bytes) + "\r\n\r\n";
}

net::awaitable<bool> ServeMjpeg(WebStream* stream, PictureStream* pictures,
                                const WebRequest& request) {
  beast::error_code ignored;
  // The kernel would otherwise buffer many pictures, and the client would see the past.
  stream->socket().set_option(net::socket_base::send_buffer_size(kSendBufferBytes), ignored);
  // Written by hand: the body is endless, and Beast's serializer wants to know where it ends.
  const std::string head = std::string(
                               "HTTP/1.1 200 OK\r\nServer: furrowd\r\nCache-Control: no-store\r\n"
                               "Connection: close\r\nContent-Type: ") +
                           kMjpegType + "\r\n\r\n";
  bool has_begun = false;
  pictures->WatchForEnd(/*sends_more=*/false);
  while (true) {
    PictureStream::Next next = co_await pictures->Wait(std::nullopt);
    // After the head it is too late for an error status; then the connection closes.
    if (next.refusal && !has_begun) {
      co_return co_await WriteReply(*stream, request, *std::move(next.refusal));
    }
    if (!next.has_image) co_return false;
    const protocol::ImageFrame& image = pictures->image();
    const std::string part = PartHead(image.bytes.size());
    const std::string first = has_begun ? part : head + part;
    has_begun = true;
    if (!co_await WriteAll(stream, first, image.bytes, "\r\n")) co_return false;
    // Browsers show a part when the next one begins. No picture follows a still until something
    // changes, so without the repetition they would show the moving picture before it.
    if (image.still && !co_await WriteAll(stream, part, image.bytes, "\r\n")) co_return false;
    // After the write has ended, so that the speed of the client limits how many pictures are
    // requested.
    pictures->Acknowledge();
  }
}

net::awaitable<bool> ServeSnapshot(WebStream* stream, PictureStream* pictures,
                                   const WebRequest& request, WaitingBytes* waiting) {
  pictures->WatchForEnd(/*sends_more=*/true);
  const PictureStream::Next next =
      co_await pictures->Wait(std::chrono::steady_clock::now() + kWebDeadline);
  if (!next.has_image && pictures->is_gone()) co_return false;
  if (!next.has_image) {
    co_return co_await WriteReply(
        *stream, request,
        next.refusal.value_or(ErrorReply(404, "not_found", "subject", "the subject has left")));
  }
  const std::vector<std::uint8_t>& bytes = pictures->image().bytes;
  ApiReply picture{.type = kSnapshotType, .body = std::string(bytes.begin(), bytes.end())};
  const std::string host = LabelOfClient(*stream).host;
  co_return co_await WriteLargeReply(*stream, request, std::move(picture), waiting, host);
}

}  // namespace

net::awaitable<bool> ServePictures(WebStream* stream, WebContext* context,
                                   const WebRequest& request, const Url& url,
                                   const Access& access) {
  Result<protocol::SubscribePictures> wanted = PicturesOf(url);
  if (!wanted.ok()) co_return co_await WriteReply(*stream, request, ErrorReply(wanted.status()));
  const bool once = url.path == "/snapshot.png";
  wanted->acknowledged = !once;
  wanted->wait = !once;
  if (once) wanted->format = protocol::ImageFormat::kPng;
  // Waiting for a picture has its own deadline; each write sets one again.
  stream->expires_never();
  // Shared only so that callbacks can hold it weakly. It ends with this coroutine.
  auto pictures = std::make_shared<PictureStream>(stream, context);
  pictures->Open(*wanted, access);
  if (once) co_return co_await ServeSnapshot(stream, pictures.get(), request, context->waiting);
  co_return co_await ServeMjpeg(stream, pictures.get(), request);
}

}  // namespace furrow::server
