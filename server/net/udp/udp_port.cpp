// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_port.h"

#include <chrono>
#include <exception>
#include <map>
#include <optional>
#include <utility>

#include <asio/post.hpp>
#include <asio/steady_timer.hpp>

#include "base/status.h"
#include "server/core/within_memory.h"
#include "server/machine/socket_cookie.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/run_loop.h"

namespace furrow::server {
namespace {

constexpr auto kExpireInterval = std::chrono::seconds(1);
// How much later than its time a pose may leave a jitter buffer.
constexpr auto kReleaseInterval = std::chrono::milliseconds(2);

// The kernel spreads senders by hash, so each shard gets about an equal part, rounded up.
Limits LimitsOfShard(Limits limits, int shards) {
  limits.max_udp_peers = (limits.max_udp_peers + shards - 1) / shards;
  return limits;
}

}  // namespace

UdpPort::UdpPort(asio::io_context& io, int shards, const Limits& limits, Hub* hub, Metrics* metrics,
                 RecordingTap* recording, SecureSessions* secure, bool requires_token)
    : io_(io), hub_(hub), metrics_(metrics), secure_(secure) {
  std::vector<UdpServer*> by_shard;
  for (int shard = 0; shard < shards; ++shard) {
    // The hint 1 tells Asio that one thread runs the loop.
    if (shard > 0) loops_.push_back(std::make_unique<asio::io_context>(1));
    servers_.push_back(std::make_unique<UdpServer>(LoopOf(static_cast<std::size_t>(shard)),
                                                   LimitsOfShard(limits, shards), hub, metrics,
                                                   recording, shard, secure, requires_token));
    by_shard.push_back(servers_.back().get());
  }
  // After all servers exist: each may send through any other's buffer.
  for (UdpServer* server : by_shard) server->Join(by_shard);
}

UdpPort::~UdpPort() { Close(); }

void UdpPort::SetBusyPoll(Time time) {
  for (const auto& server : servers_) server->SetBusyPoll(time);
}

// The first socket opens the port exclusively. If another daemon has the port, this is an error,
// and the two do not share the port by accident.
Status UdpPort::Open(const asio::ip::udp::endpoint& endpoint) {
  FURROW_RETURN_IF_ERROR(servers_.front()->Open(endpoint));
  if (servers_.size() == 1) return {};
  // SO_REUSEPORT takes effect at once for sockets that bind later, so setting it after bind() is
  // what keeps a second daemon out and lets the other shards in.
  FURROW_RETURN_IF_ERROR(servers_.front()->Share());
  for (std::size_t shard = 1; shard < servers_.size(); ++shard) {
    const Status status =
        servers_[shard]->Open({endpoint.address(), port()}, UdpServer::Port::kShared);
    if (!status.ok()) return status;
  }
  // Adding sockets changes which socket a sender maps to. Datagrams that arrived before would
  // create a second peer of the same sender in another shard, and the two would fight over a
  // subject.
  for (const auto& server : servers_) server->DropWaiting();
  return {};
}

Status UdpPort::Adopt(std::span<const int> sockets) {
  for (std::size_t shard = 0; shard < servers_.size(); ++shard) {
    FURROW_RETURN_IF_ERROR(servers_[shard]->Adopt(sockets[shard]));
  }
  return {};
}

void UdpPort::Start() {
  for (std::size_t shard = 0; shard < servers_.size(); ++shard) {
    servers_[shard]->Start();
    StartCriticalTask(LoopOf(shard), ExpireLoop(shard));
    if (hub_->HoldsPoses()) StartCriticalTask(LoopOf(shard), ReleaseLoop(shard));
  }
  // Only after every server has its first operation pending: a loop without work would return.
  for (const auto& loop : loops_) threads_.emplace_back([this, &loop = *loop] { Run(loop); });
}

// An exception ends the caller's event loop, too.
void UdpPort::Run(asio::io_context& loop) {
  try {
    RunLoop(loop, metrics_);
  } catch (...) {
    asio::post(io_, [error = std::current_exception()] { std::rethrow_exception(error); });
  }
}

asio::awaitable<void> UdpPort::ExpireLoop(std::size_t shard) {
  asio::steady_timer timer(LoopOf(shard));
  while (true) {
    timer.expires_after(kExpireInterval);
    co_await timer.async_wait(kAwaitTuple);
    WithinMemory(metrics_, [&] { servers_[shard]->Expire(ReadClock()); });
  }
}

// Runs only if some subject may have a jitter buffer.
asio::awaitable<void> UdpPort::ReleaseLoop(std::size_t shard) {
  asio::steady_timer timer(LoopOf(shard));
  while (true) {
    timer.expires_after(kReleaseInterval);
    co_await timer.async_wait(kAwaitTuple);
    WithinMemory(metrics_, [&] { hub_->ReleaseHeld(static_cast<int>(shard), ReadClock()); });
  }
}

void UdpPort::Save(SavedState* state) {
  for (const auto& server : servers_) {
    server->Save(&state->udp);
    state->udp_sockets.push_back(SocketCookie(server->socket()));
  }
  if (secure_ != nullptr) state->secure = secure_->TakeAll();
}

std::vector<int> UdpPort::sockets() {
  std::vector<int> all;
  for (const auto& server : servers_) all.push_back(server->socket());
  return all;
}

void UdpPort::Resume(const SavedState& state, Hub::ResumedPeers* peers, Time now) {
  std::map<std::uint32_t, Access> sessions;
  for (const SavedSecureSession& saved : state.secure) {
    if (secure_ == nullptr) break;
    if (auto access = secure_->Resume(saved, now)) {
      sessions.emplace(saved.session.index, *std::move(access));
    }
  }
  for (const SavedUdpPeer& saved : state.udp) {
    if (saved.shard >= servers_.size()) continue;
    std::optional<Access> access;
    if (saved.secure_session != 0) {
      const auto session = sessions.find(saved.secure_session);
      if (session == sessions.end()) continue;
      access = session->second;
    }
    const PeerId id = servers_[saved.shard]->Resume(saved, std::move(access), now);
    if (id != 0) peers->try_emplace(saved.peer.id, Hub::ResumedPeer{id, &saved.peer});
  }
}

void UdpPort::Leave() {
  for (const auto& server : servers_) server->StopReading();
  if (threads_.empty()) return;
  Join();
  // Packets that one shard has opened for another one would be lost: their senders do not repeat
  // them, and the next daemon would refuse them if they did.
  for (const auto& loop : loops_) {
    loop->restart();
    while (!WithinMemory(metrics_, [&loop = *loop] { loop.poll(); })) {
    }
  }
}

void UdpPort::Join() {
  for (const auto& loop : loops_) loop->stop();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void UdpPort::Close() {
  // The sockets close after the threads have ended, since an Asio socket must not be closed on one
  // thread while another uses it.
  Join();
  for (const auto& server : servers_) server->Close();
}

}  // namespace furrow::server
