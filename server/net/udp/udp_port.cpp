// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_port.h"

#include <chrono>
#include <exception>

#include <asio/experimental/as_tuple.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <asio/use_awaitable.hpp>

#include "base/status.h"
#include "server/net/clock.h"
#include "server/net/spawn.h"

namespace furrow::server {
namespace {

constexpr auto kToken = asio::experimental::as_tuple(asio::use_awaitable);
constexpr auto kExpireInterval = std::chrono::seconds(1);

Limits ShareOf(Limits limits, int lanes) {
  limits.max_udp_peers = (limits.max_udp_peers + lanes - 1) / lanes;
  return limits;
}

}  // namespace

UdpPort::UdpPort(asio::io_context& io, int lanes, const Limits& limits, Hub* hub, Metrics* metrics,
                 RecordingTap* recording)
    : io_(io) {
  std::vector<UdpServer*> by_lane;
  for (int lane = 0; lane < lanes; ++lane) {
    if (lane > 0) loops_.push_back(std::make_unique<asio::io_context>(1));
    servers_.push_back(std::make_unique<UdpServer>(LoopOf(static_cast<std::size_t>(lane)),
                                                   ShareOf(limits, lanes), hub, metrics, recording,
                                                   lane));
    by_lane.push_back(servers_.back().get());
  }
  for (UdpServer* server : by_lane) server->Join(by_lane);
}

UdpPort::~UdpPort() { Close(); }

// The first opens the port as its own, so that whoever has it already, another daemon above all, is
// an error and not a partner.
Status UdpPort::Open(const asio::ip::udp::endpoint& endpoint) {
  FURROW_RETURN_IF_ERROR(servers_.front()->Open(endpoint));
  if (servers_.size() == 1) return {};
  FURROW_RETURN_IF_ERROR(servers_.front()->Share());
  for (std::size_t lane = 1; lane < servers_.size(); ++lane) {
    const Status status =
        servers_[lane]->Open({endpoint.address(), port()}, UdpServer::Port::kShared);
    if (!status.ok()) return status;
  }
  // Who is spread over more sockets than there were when it sent this may be of another lane: it
  // would be two peers, one of which takes the other's subject over.
  for (const auto& server : servers_) server->DropWaiting();
  return {};
}

void UdpPort::Start() {
  for (std::size_t lane = 0; lane < servers_.size(); ++lane) {
    servers_[lane]->Start();
    SpawnVital(LoopOf(lane), ExpireLoop(lane));
  }
  for (const auto& loop : loops_) threads_.emplace_back([this, &loop = *loop] { Run(loop); });
}

// What no loop survives ends the caller's, too.
void UdpPort::Run(asio::io_context& loop) {
  try {
    loop.run();
  } catch (...) {
    asio::post(io_, [error = std::current_exception()] { std::rethrow_exception(error); });
  }
}

asio::awaitable<void> UdpPort::ExpireLoop(std::size_t lane) {
  asio::steady_timer timer(LoopOf(lane));
  while (true) {
    timer.expires_after(kExpireInterval);
    co_await timer.async_wait(kToken);
    servers_[lane]->Expire(ReadClock());
  }
}

void UdpPort::Close() {
  for (const auto& loop : loops_) loop->stop();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  for (const auto& server : servers_) server->Close();
}

}  // namespace furrow::server
