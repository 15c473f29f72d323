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
#include "server/machine/socket_cookie.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/session/peers/peer_label.h"

namespace furrow::server {
namespace {

constexpr std::size_t kReadBytes = 64 * 1024;
// The largest message of a client that must show a token first. A Hello with one has 1 KiB at most.
constexpr std::size_t kStrangerBytes = 4 * 1024;
// Bytes per write call; small messages leave together.
constexpr std::size_t kWriteBytes = 16 * 1024;
// Unsent bytes that the kernel may queue (TCP_NOTSENT_LOWAT). By default it queues megabytes, so a
// slow reader would receive poses that are seconds old.
constexpr int kUnsentBytes = 32 * 1024;
// Replies that may wait for a client that does not read. It is then disconnected.
constexpr std::size_t kMaxReplies = 1024;
// A write takes microseconds unless the peer does not read.
constexpr Time kStuckAfter = std::chrono::milliseconds(100);
constexpr auto kWatchInterval = std::chrono::milliseconds(500);

PeerLabel NameOf(StreamSocket& stream) {
  asio::error_code error;
  const auto endpoint = stream.socket().remote_endpoint(error);
  const std::string transport = stream.is_tls() ? "tls" : "tcp";
  // It has reset the connection, and what it sent before is still read. It may be anywhere.
  if (error) return {transport + ", disconnected", {}, stream.is_tls()};
  PeerLabel label = LabelOf(transport, endpoint.address().to_string(), endpoint.port());
  label.shielded |= stream.is_tls();
  return label;
}

// True for the head of a ClientHello (RFC 8446 section 5.1). Its length in Furrow's framing may be
// a permitted one, but the message of a frame begins with another byte.
bool BeginsTls(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 5 && bytes[0] == 22 && bytes[1] == 3 && bytes[5] == 1;
}

}  // namespace

TcpSession::TcpSession(std::shared_ptr<StreamSocket> stream, const Limits& limits, Hub* hub,
                       Metrics* metrics, WaitingBytes* waiting,
                       std::function<void(const std::shared_ptr<TcpSession>&)> on_closed)
    : stream_(std::move(stream)),
      limits_(limits),
      hub_(hub),
      metrics_(metrics),
      waiting_(waiting),
      on_closed_(std::move(on_closed)),
      wake_(stream_->get_executor()),
      watch_(stream_->get_executor()),
      outbox_(kMaxReplies, static_cast<std::size_t>(limits.outbox_messages)),
      // The reader checks a length before it allocates, so a client can make it hold this much at
      // most.
      frames_(hub->RequiresToken() ? kStrangerBytes : protocol::kMaxRequestBytes),
      in_(hub->RequiresToken() ? kStrangerBytes : kReadBytes) {}

void TcpSession::Start() { Begin({}); }

void TcpSession::Begin(std::optional<Access> access) {
  asio::error_code error;
  // Nagle's algorithm would hold a small message back until the last one is acknowledged. The
  // writer joins messages itself.
  stream_->socket().set_option(asio::ip::tcp::no_delay(true), error);
  // Optional: without it, slow readers only receive older frames.
  setsockopt(stream_->socket().native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes,
             sizeof(kUnsentBytes));
  thread_ = std::this_thread::get_id();
  const PeerLabel label = NameOf(*stream_);
  outbox_.SetAccount({waiting_, label.host});
  peer_ = hub_->AddPeer(Transport::kTcp, label, this, ReadClock(), 0, std::move(access));
  StartTasks();
}

void TcpSession::StartTasks() {
  for (const Task task : {kRead, kWrite, kWatch}) {
    if ((running_ & task) == 0) Spawn(task);
  }
}

// Each coroutine holds the session, which therefore lives until the last of them has ended,
// whatever Close() does. The hub has only a pointer to the Link, and RemovePeer() takes it back.
void TcpSession::Spawn(Task task) {
  const auto self = shared_from_this();
  running_ |= task;
  asio::co_spawn(
      stream_->get_executor(), [self, task] { return self->Perform(task); },
      [self, task](const std::exception_ptr& failed) {
        self->running_ &= ~task;
        // Such as out of memory, which ends this connection only.
        if (failed) self->Close();
      });
}

asio::awaitable<void> TcpSession::Perform(Task task) {
  if (task == kRead) return Read();
  return task == kWrite ? Write() : Watch();
}

PeerId TcpSession::Resume(const SavedConnection& saved, std::optional<Access> access) {
  is_new_ = false;
  if (access || !hub_->RequiresToken()) OnAdmitted();
  std::span<const std::uint8_t> input = saved.input;
  std::span<const std::uint8_t> frame;
  // A frame that is complete would have been read by the former daemon.
  if (!input.empty() && frames_.Push(input, frame) != protocol::FrameStatus::kNeedMore) {
    Close();
    return 0;
  }
  unsent_ = saved.output;
  Begin(std::move(access));
  return peer_;
}

bool TcpSession::Leave() {
  if (!leaves_ && (state_ != State::kOpen || stream_->is_tls() || !hub_->MaySavePeer(peer_))) {
    return true;
  }
  leaves_ = true;
  if (running_ == 0) return true;
  // A write that has just succeeded in part goes on after a cancellation, so one may not suffice.
  asio::error_code ignored;
  stream_->socket().cancel(ignored);
  wake_.cancel();
  watch_.cancel();
  return false;
}

std::optional<SavedConnection> TcpSession::Save(std::size_t room) {
  if (!leaves_ || running_ != 0 || state_ != State::kOpen) return std::nullopt;
  {
    const std::lock_guard lock(mutex_);
    if (unsent_.size() + outbox_.bytes() > room) return std::nullopt;
  }
  auto peer = hub_->SavePeer(peer_);
  if (!peer) return std::nullopt;
  std::vector<std::uint8_t> output;
  while (FillWriteBuffer()) output.insert(output.end(), out_.begin(), out_.end());
  unsent_ = output;  // for Stay()
  is_saved_ = true;
  return SavedConnection{.socket = SocketCookie(socket()),
                         .input = frames_.unfinished(),
                         .output = std::move(output),
                         .peer = *std::move(peer)};
}

void TcpSession::Stay() {
  if (!std::exchange(leaves_, false)) return;
  is_saved_ = false;
  if (state_ != State::kClosed) StartTasks();
}

asio::awaitable<void> TcpSession::Read() {
  while (state_ != State::kClosed) {
    if (leaves_) co_return;
    if (is_admitted_ && in_.size() < kReadBytes) in_.resize(kReadBytes);
    const auto [error, size] = co_await stream_->async_read_some(asio::buffer(in_), kAwaitTuple);
    if (error == asio::error::operation_aborted) continue;  // by Leave() or Close()
    if (error) break;
    if (state_ != State::kOpen) continue;  // ignore input; wait for the end of the stream
    // Without a valid length the start of the next frame is unknown, so the stream cannot go on.
    if (!OnBytes({in_.data(), size}, ReadClock())) {
      metrics_->Add(Counter::kConnectionsMalformed);
      CloseAfterFlush(/*linger=*/true);
    }
  }
  Close();
}

bool TcpSession::OnBytes(std::span<const std::uint8_t> bytes, Time now) {
  // Without an answer, both sides would wait.
  if (std::exchange(is_new_, false) && BeginsTls(bytes)) {
    hub_->OnBadFrame(peer_);
    return false;
  }
  std::span<const std::uint8_t> frame;
  while (!bytes.empty() && state_ == State::kOpen) {
    switch (frames_.Push(bytes, frame)) {
      // Push() has consumed all bytes, so the loop ends.
      case protocol::FrameStatus::kNeedMore: break;
      case protocol::FrameStatus::kFrame: hub_->OnMessage(peer_, frame, now); break;
      case protocol::FrameStatus::kBadLength: hub_->OnBadFrame(peer_); return false;
    }
  }
  return true;
}

// Writes what is queued, sleeps while nothing is, and completes a graceful close: flush, shut down
// the sending direction, and let the reader wait for the peer's end.
asio::awaitable<void> TcpSession::Write() {
  while (state_ == State::kOpen || state_ == State::kFlushing) {
    if (leaves_) co_return;
    if (FillWriteBuffer()) {
      write_started_ = ReadClock();
      // While a write is in progress nobody has to wake the writer: it looks again afterwards.
      SetWriting(true);
      const auto [error, size] =
          co_await asio::async_write(*stream_, asio::buffer(out_), kAwaitTuple);
      SetWriting(false);
      if (error == asio::error::operation_aborted) {  // by Leave() or Close()
        unsent_.assign(out_.begin() + static_cast<std::ptrdiff_t>(size), out_.end());
      } else if (error) {
        Close();
      }
    } else if (state_ == State::kFlushing) {
      state_ = State::kLingering;
      co_await stream_->EndSending(linger_);
      if (!linger_) Close();
    } else {
      // A timer that never expires serves as a condition variable for coroutines. A message that
      // another thread queues between FillWriteBuffer() and this wait is not missed: Wake() posts
      // the cancellation to this executor, which runs it once this coroutine waits.
      wake_.expires_at(asio::steady_timer::time_point::max());
      co_await wake_.async_wait(kAwaitTuple);
    }
  }
}

// Moves queued messages into out_, up to kWriteBytes. False: nothing is queued.
bool TcpSession::FillWriteBuffer() {
  // What waits for nobody must not keep the memory of a picture.
  if (out_.capacity() > 4 * kWriteBytes) out_ = {};
  out_.clear();
  if (!unsent_.empty()) {
    out_.swap(unsent_);
    return true;
  }
  const std::lock_guard lock(mutex_);
  owes_frames_ = outbox_.owes_frames();
  // Takes little at a time: what stays in the outbox can still be replaced by newer frames, what is
  // in out_ cannot.
  while (out_.size() < kWriteBytes && outbox_.Pop(&message_)) {
    const auto prefix = protocol::FramePrefix(message_.size());
    out_.insert(out_.end(), prefix.begin(), prefix.end());
    out_.insert(out_.end(), message_.begin(), message_.end());
    if (message_.capacity() > kWriteBytes) message_ = {};  // release the memory of a picture
  }
  return !out_.empty();
}

asio::awaitable<void> TcpSession::Watch() {
  while (state_ != State::kClosed && !leaves_) {
    // Polls instead of moving a deadline with every message, which would cost each of them a timer.
    watch_.expires_after(kWatchInterval);
    co_await watch_.async_wait(kAwaitTuple);
    if (state_ != State::kClosed && !leaves_ && IsOverdue(ReadClock())) {
      metrics_->Add(Counter::kConnectionsIdle);
      Close();
    }
  }
}

// True for a peer that does not read, has gone idle, or does not close.
bool TcpSession::IsOverdue(Time now) {
  // `writing_` and `write_started_` are written on this thread only, so it may read them without
  // the mutex.
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
  // Outside of the mutex: the hub calls back into this Link, and takes its own locks first
  // everywhere else.
  hub_->RemovePeer(peer_);
  // The writer may be asleep with an empty outbox; it has to see kFlushing.
  wake_.cancel();
}

bool TcpSession::OwesFrames() {
  const std::lock_guard lock(mutex_);
  return state_ != State::kClosed && (owes_frames_ || outbox_.owes_frames());
}

void TcpSession::Close() {
  // Reader, writer and watchdog may each find a reason to close; the first one does it.
  if (state_ == State::kClosed) return;
  state_ = State::kClosed;
  hub_->RemovePeer(peer_);
  asio::error_code error;
  stream_->socket().close(error);
  wake_.cancel();
  watch_.cancel();
  // Last, because it may release the server's reference to this session.
  on_closed_(shared_from_this());
}

void TcpSession::SendReply(std::span<const std::uint8_t> message) {
  if (state_ != State::kOpen) return;
  {
    const std::lock_guard lock(mutex_);
    // A reply that is dropped would leave the client waiting for it, so a full queue ends the
    // connection.
    if (outbox_.PushReply(message)) {
      if (!writing_) Wake();
      return;
    }
  }
  metrics_->Add(Counter::kConnectionsOverrun);
  // Close later: the hub is using this peer right now.
  asio::post(stream_->get_executor(), [self = shared_from_this()] { self->Close(); });
}

int TcpSession::SendFrame(std::uint64_t key, std::span<const std::uint8_t> message,
                          std::size_t keep, int /*shard*/) {
  const std::lock_guard lock(mutex_);
  if (state_ != State::kOpen) return 0;
  const int dropped = outbox_.PushFrame(key, message, keep);
  if (!writing_) Wake();
  return dropped;
}

// Called while this session reads a message.
void TcpSession::OnAdmitted() {
  is_admitted_ = true;
  stream_->Admit();
  frames_.SetMaxFrameBytes(protocol::kMaxRequestBytes);
}

// Later, because the hub is using this peer right now.
void TcpSession::Finish() {
  asio::post(stream_->get_executor(),
             [self = shared_from_this()] { self->CloseAfterFlush(/*linger=*/true); });
}

void TcpSession::FinishSoon() {
  asio::post(stream_->get_executor(),
             [self = shared_from_this()] { self->CloseAfterFlush(/*linger=*/false); });
}

void TcpSession::SetWriting(bool writing) {
  const std::lock_guard lock(mutex_);
  writing_ = writing;
}

// Wakes the writer. Another thread posts at most one wake-up until the writer has run.
void TcpSession::Wake() {
  // Timers of Asio are not thread-safe; only the session's own thread may cancel one.
  if (std::this_thread::get_id() == thread_) {
    wake_.cancel();
  } else if (!woken_.exchange(true)) {
    asio::post(stream_->get_executor(), [self = shared_from_this()] {
      // Before the cancellation: a message that is queued from here on posts a new wake-up.
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
