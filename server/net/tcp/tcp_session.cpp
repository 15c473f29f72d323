// SPDX-License-Identifier: Apache-2.0
#include "server/net/tcp/tcp_session.h"

#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/post.hpp>
#include <asio/write.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include "protocol/framing/tcp_framing.h"
#include "protocol/messages/limits.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"

namespace furrow::server {
namespace {

constexpr std::size_t kReadBytes = 64 * 1024;
// Bytes per write call; small messages leave together.
constexpr std::size_t kWriteBytes = 16 * 1024;
// Unsent bytes that the kernel may queue (TCP_NOTSENT_LOWAT). By default it queues megabytes, so a
// slow reader would receive poses that are seconds old.
constexpr int kUnsentBytes = 32 * 1024;
constexpr std::size_t kMaxReplies = 1024;
// A write takes microseconds unless the peer does not read.
constexpr Time kStuckAfter = std::chrono::milliseconds(100);
constexpr auto kWatchInterval = std::chrono::milliseconds(500);

std::string NameOf(const asio::ip::tcp::socket& socket) {
  asio::error_code error;
  const auto endpoint = socket.remote_endpoint(error);
  if (error) return "tcp, disconnected";
  return "tcp " + endpoint.address().to_string() + " port " + std::to_string(endpoint.port());
}

}  // namespace

TcpSession::TcpSession(asio::ip::tcp::socket socket, const Limits& limits, Hub* hub,
                       Metrics* metrics,
                       std::function<void(const std::shared_ptr<TcpSession>&)> on_closed)
    : socket_(std::move(socket)),
      limits_(limits),
      hub_(hub),
      metrics_(metrics),
      on_closed_(std::move(on_closed)),
      wake_(socket_.get_executor()),
      watch_(socket_.get_executor()),
      outbox_(kMaxReplies, static_cast<std::size_t>(limits.outbox_messages)),
      frames_(protocol::kMaxRequestBytes),
      in_(kReadBytes) {}

void TcpSession::Start() {
  asio::error_code error;
  socket_.set_option(asio::ip::tcp::no_delay(true), error);
  // Optional: without it, slow readers only receive older frames.
  setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes,
             sizeof(kUnsentBytes));
  thread_ = std::this_thread::get_id();
  peer_ = hub_->AddPeer(Transport::kTcp, NameOf(socket_), this, ReadClock());
  const auto self = shared_from_this();
  const auto executor = socket_.get_executor();
  // An exception, such as out of memory, ends this connection only.
  const auto ended = [self](const std::exception_ptr& failed) {
    if (failed) self->Close();
  };
  asio::co_spawn(
      executor, [self] { return self->Read(); }, ended);
  asio::co_spawn(
      executor, [self] { return self->Write(); }, ended);
  asio::co_spawn(
      executor, [self] { return self->Watch(); }, ended);
}

asio::awaitable<void> TcpSession::Read() {
  while (state_ != State::kClosed) {
    const auto [error, size] = co_await socket_.async_read_some(asio::buffer(in_), kAwaitTuple);
    if (error) break;
    if (state_ != State::kOpen) continue;  // ignore input; wait for the end of the stream
    if (!OnBytes({in_.data(), size}, ReadClock())) {
      metrics_->Add(Counter::kConnectionsMalformed);
      CloseAfterFlush(/*linger=*/true);
    }
  }
  Close();
}

bool TcpSession::OnBytes(std::span<const std::uint8_t> bytes, Time now) {
  std::span<const std::uint8_t> frame;
  while (!bytes.empty() && state_ == State::kOpen) {
    switch (frames_.Push(bytes, frame)) {
      case protocol::FrameStatus::kNeedMore: break;
      case protocol::FrameStatus::kFrame: hub_->OnMessage(peer_, frame, now); break;
      case protocol::FrameStatus::kBadLength: hub_->OnBadFrame(peer_); return false;
    }
  }
  return true;
}

asio::awaitable<void> TcpSession::Write() {
  while (state_ == State::kOpen || state_ == State::kFlushing) {
    if (FillWriteBuffer()) {
      write_started_ = ReadClock();
      SetWriting(true);
      const auto [error, size] =
          co_await asio::async_write(socket_, asio::buffer(out_), kAwaitTuple);
      SetWriting(false);
      if (error) Close();
    } else if (state_ == State::kFlushing) {
      if (!linger_) {
        Close();
        co_return;
      }
      state_ = State::kLingering;
      asio::error_code error;
      socket_.shutdown(asio::ip::tcp::socket::shutdown_send, error);
    } else {
      wake_.expires_at(asio::steady_timer::time_point::max());
      co_await wake_.async_wait(kAwaitTuple);
    }
  }
}

// Moves queued messages into out_, up to kWriteBytes. False: nothing is queued.
bool TcpSession::FillWriteBuffer() {
  out_.clear();
  const std::lock_guard lock(mutex_);
  while (out_.size() < kWriteBytes && outbox_.Pop(&message_)) {
    const auto prefix = protocol::FramePrefix(message_.size());
    out_.insert(out_.end(), prefix.begin(), prefix.end());
    out_.insert(out_.end(), message_.begin(), message_.end());
    if (message_.capacity() > kWriteBytes) message_ = {};  // release the memory of a picture
  }
  return !out_.empty();
}

asio::awaitable<void> TcpSession::Watch() {
  while (state_ != State::kClosed) {
    watch_.expires_after(kWatchInterval);
    co_await watch_.async_wait(kAwaitTuple);
    if (state_ != State::kClosed && IsOverdue(ReadClock())) {
      metrics_->Add(Counter::kConnectionsIdle);
      Close();
    }
  }
}

// True for a peer that does not read, has gone idle, or does not close.
bool TcpSession::IsOverdue(Time now) {
  if (writing_ && now - write_started_ > FromSeconds(limits_.idle_seconds)) return true;
  if (state_ == State::kOpen) return hub_->IsIdle(peer_, now);
  return now - closing_since_ > FromSeconds(limits_.drain_seconds);
}

void TcpSession::CloseAfterFlush(bool linger) {
  if (state_ != State::kOpen) return;
  linger_ = linger;
  closing_since_ = ReadClock();
  {
    const std::lock_guard lock(mutex_);  // no frame may follow the queued replies
    state_ = State::kFlushing;
    outbox_.DropReplaceableFrames();
  }
  hub_->RemovePeer(peer_);
  wake_.cancel();
}

void TcpSession::Close() {
  if (state_ == State::kClosed) return;
  state_ = State::kClosed;
  hub_->RemovePeer(peer_);
  asio::error_code error;
  socket_.close(error);
  wake_.cancel();
  watch_.cancel();
  on_closed_(shared_from_this());
}

void TcpSession::SendReply(std::span<const std::uint8_t> message) {
  if (state_ != State::kOpen) return;
  {
    const std::lock_guard lock(mutex_);
    if (outbox_.PushReply(message)) {
      if (!writing_) Wake();
      return;
    }
  }
  metrics_->Add(Counter::kConnectionsOverrun);
  // Close later: the hub is using this peer right now.
  asio::post(socket_.get_executor(), [self = shared_from_this()] { self->Close(); });
}

int TcpSession::SendFrame(std::uint64_t key, std::span<const std::uint8_t> message,
                          std::size_t keep, int /*shard*/) {
  const std::lock_guard lock(mutex_);
  if (state_ != State::kOpen) return 0;
  const int dropped = outbox_.PushFrame(key, message, keep);
  if (!writing_) Wake();
  return dropped;
}

void TcpSession::SetWriting(bool writing) {
  const std::lock_guard lock(mutex_);
  writing_ = writing;
}

// Wakes the writer. Another thread posts at most one wake-up until the writer has run.
void TcpSession::Wake() {
  if (std::this_thread::get_id() == thread_) {
    wake_.cancel();
  } else if (!woken_.exchange(true)) {
    asio::post(socket_.get_executor(), [self = shared_from_this()] {
      self->woken_ = false;
      self->wake_.cancel();
    });
  }
}

bool TcpSession::IsStuck(Time now) const { return writing_ && now - write_started_ > kStuckAfter; }

// A closing connection keeps its frames: kKeepAll frames queued before the goodbye still leave.
void TcpSession::DropFrames(std::uint64_t key) {
  if (state_ != State::kOpen) return;
  const std::lock_guard lock(mutex_);
  outbox_.DropFrames(key);
}

}  // namespace furrow::server
