// SPDX-License-Identifier: Apache-2.0
#include "server/restart/shutdown.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <asio/post.hpp>
#include <asio/use_awaitable.hpp>
#include <spdlog/spdlog.h>

#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/pause.h"
#include "server/session/delivery/message_sender.h"

namespace furrow::server {
namespace {

// How often it is checked whether the peers have received everything.
constexpr auto kPoll = std::chrono::milliseconds(5);
// How long the memory of pictures may take to be freed. Weights go on meanwhile.
constexpr Time kLetsGo = std::chrono::milliseconds(500);
// How long connections may take to come to rest, and how long others may then take to read what is
// queued. The next daemon waits meanwhile.
constexpr Time kLeaves = std::chrono::milliseconds(100);
constexpr auto kLeavePoll = std::chrono::milliseconds(1);
// How long a client may take to learn that all subjects have moved.
constexpr Time kLastAnswer = std::chrono::seconds(1);

}  // namespace

void Shutdown::Request() {
  // A second SIGTERM must not start a second shutdown.
  if (std::exchange(has_begun_, true)) return;
  StartCriticalTask(*parts_.io, Run());
}

protocol::DrainState Shutdown::OnDrainRequest(bool begin) {
  if (begin && !moves_.exchange(true)) {
    asio::post(*parts_.io, [this] { StartCriticalTask(*parts_.io, MoveAndEnd()); });
  }
  const Mover::Progress progress = parts_.mover->progress();
  protocol::DrainState state;
  state.draining = moves_;
  state.moved = progress.moved;
  state.why = MessageSender::Truncate(progress.why);
  if (state.draining && parts_.hub->num_subjects() == 0) client_knows_all_moved_ = true;
  return state;
}

// Moves all subjects, however long that takes, and ends then.
asio::awaitable<void> Shutdown::MoveAndEnd() {
  if (has_begun_) co_return;
  spdlog::info("moving all subjects to other nodes");
  mover_has_started_ = true;
  co_await parts_.mover->Run();
  for (const Time end = ReadClock() + kLastAnswer; !client_knows_all_moved_ && ReadClock() < end;) {
    co_await Pause(kPoll);
  }
  Request();
}

// Moves the subjects until shortly before the deadline.
asio::awaitable<void> Shutdown::MoveInTime() {
  const Time left = deadline_ - ReadClock();
  parts_.mover->EndBy(ReadClock() + left * 3 / 4);
  moves_ = true;
  // A drain may have been requested a moment ago and not have begun.
  if (!std::exchange(mover_has_started_, true)) {
    co_await parts_.mover->Run();
  } else {
    while (parts_.mover->running()) co_await Pause(kPoll);
  }
}

asio::awaitable<void> Shutdown::LetGo() {
  const Time end = std::min(ReadClock() + kLetsGo, deadline_);
  while (!parts_.let_go() && ReadClock() < end) co_await Pause(kPoll);
}

asio::awaitable<bool> Shutdown::LeaveAll() {
  const Time end = ReadClock() + kLeaves;
  while (!parts_.leave() && ReadClock() < end) co_await Pause(kLeavePoll);
  // What other shards have passed to this one is in the queue of the event loop before this.
  co_await asio::post(*parts_.io, asio::use_awaitable);
  co_return parts_.save();
}

// Waits until the queued messages have left. The next daemon waits, too, so a client that must
// connect again gets little time, except for frames that may not be left out.
asio::awaitable<void> Shutdown::Flush(bool has_left) {
  const Time soon = ReadClock() + kLeaves;
  const auto waits = [&](Time now) {
    return now < deadline_ && (!has_left || now < soon || parts_.owes_frames());
  };
  while (parts_.is_sending() && waits(ReadClock())) co_await Pause(kPoll);
}

asio::awaitable<void> Shutdown::Run() {
  spdlog::info("shutting down");
  deadline_ = ReadClock() + parts_.drain_time();
  parts_.on_begin();
  if (parts_.mover) co_await MoveInTime();
  if (parts_.leave) co_await LetGo();
  const bool has_left = parts_.leave && co_await LeaveAll();
  parts_.hub->Drain(ReadClock());
  // The goodbyes have left already, at the end of the hub's exclusive lock.
  parts_.stop();
  co_await Flush(has_left);
  parts_.close();
  parts_.io->stop();
}

}  // namespace furrow::server
