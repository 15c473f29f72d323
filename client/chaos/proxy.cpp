// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/proxy.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include "base/status.h"
#include "client/load/net/clock.h"

namespace furrow::load {
namespace {

constexpr std::size_t kMaxFlows = 1024;
constexpr std::int64_t kLongestWaitNs = 100'000'000;
constexpr std::int64_t kMicrosecond = 1000;

// Which descriptor is ready: of a flow, its address, which is beyond these.
enum Token : std::uint64_t { kClients = 0, kListener = 1, kStream = 2, kFlow = 3 };

std::int64_t NowUs() { return SteadyNanoseconds() / kMicrosecond; }

bool ParseAddress(const std::string& host, std::uint16_t port, sockaddr_storage* address,
                  socklen_t* size) {
  auto* const v4 = reinterpret_cast<sockaddr_in*>(address);
  auto* const v6 = reinterpret_cast<sockaddr_in6*>(address);
  *address = {};
  if (inet_pton(AF_INET, host.c_str(), &v4->sin_addr) == 1) {
    v4->sin_family = AF_INET;
    v4->sin_port = htons(port);
    *size = sizeof(*v4);
    return true;
  }
  if (inet_pton(AF_INET6, host.c_str(), &v6->sin6_addr) != 1) return false;
  v6->sin6_family = AF_INET6;
  v6->sin6_port = htons(port);
  *size = sizeof(*v6);
  return true;
}

// A socket bound to `port` (0: any free one) of `host`, and its port.
Status Bind(const std::string& host, int type, Descriptor* bound, std::uint16_t* port) {
  sockaddr_storage address;
  socklen_t size = 0;
  const std::string where =
      host + ":" + std::to_string(*port) + (type == SOCK_STREAM ? " (TCP)" : " (UDP)");
  if (!ParseAddress(host, *port, &address, &size))
    return {StatusCode::kInvalidArgument, "not a numeric address", where};
  Descriptor made(socket(address.ss_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  if (type == SOCK_STREAM) setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  if (made.get() < 0 || bind(made.get(), plain, size) != 0 ||
      (type == SOCK_STREAM && listen(made.get(), SOMAXCONN) != 0) ||
      getsockname(made.get(), plain, &size) != 0) {
    return {StatusCode::kIo, std::string("cannot listen: ") + std::strerror(errno), where};
  }
  *port = ntohs(address.ss_family == AF_INET
                    ? reinterpret_cast<const sockaddr_in&>(address).sin_port
                    : reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  *bound = std::move(made);
  return {};
}

}  // namespace

struct ChaosProxy::Flow {
  sockaddr_storage client{};
  socklen_t client_size = 0;
  std::unique_ptr<Socket> server;
  ChaosLink up;
  ChaosLink down;

  Flow(const ChaosProxyOptions& options, std::uint64_t number, std::int64_t start_us)
      : up(options.up, 2 * number, start_us), down(options.down, 2 * number + 1, start_us) {}
};

ChaosProxy::ChaosProxy(ChaosProxyOptions options)
    : options_(std::move(options)), buffer_(64 * 1024) {}
ChaosProxy::~ChaosProxy() = default;

Result<std::unique_ptr<ChaosProxy>> ChaosProxy::Open(const ChaosProxyOptions& options) {
  std::unique_ptr<ChaosProxy> proxy(new ChaosProxy(options));
  FURROW_RETURN_IF_ERROR(proxy->Listen());
  std::string error;
  if (!Socket::Open(client::TransportKind::kUdp, options.to_host, options.to_udp, &error))
    return Status(StatusCode::kUnavailable, error);
  return proxy;
}

Status ChaosProxy::Listen() {
  const std::string& host = options_.listen_host;
  udp_port_ = options_.listen_port;
  FURROW_RETURN_IF_ERROR(Bind(host, SOCK_DGRAM, &udp_, &udp_port_));
  const int bytes = 4 << 20;
  setsockopt(udp_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  setsockopt(udp_.get(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof(bytes));
  poller_.Add(udp_.get(), kClients);
  if (options_.to_tcp == 0) return {};
  tcp_port_ = options_.listen_tcp_port;
  FURROW_RETURN_IF_ERROR(Bind(host, SOCK_STREAM, &tcp_, &tcp_port_));
  poller_.Add(tcp_.get(), kListener);
  return {};
}

void ChaosProxy::Run(const std::function<bool()>& go_on) {
  while (go_on()) {
    for (const epoll_event& event : poller_.Wait(WaitNs(NowUs()))) {
      const std::uint64_t token = event.data.u64;
      if (start_us_ < 0) start_us_ = NowUs();
      if (token == kClients) ReadClients(NowUs());
      if (token == kListener) Accept();
      if (token >= kFlow) ReadServer(*reinterpret_cast<Flow*>(token), NowUs());
    }
    const std::int64_t now_us = NowUs();
    ForwardDue(now_us);
    PumpStreams(now_us);
    while (flows_.size() > kMaxFlows) ForgetOldest();
  }
  while (!flows_.empty()) ForgetOldest();
  for (const ChaosStream& stream : streams_) ForgetStream(stream);
  streams_.clear();
}

void ChaosProxy::PumpStreams(std::int64_t now_us) {
  std::erase_if(streams_, [&](ChaosStream& stream) {
    const bool ended = !stream.Pump(now_us);
    if (ended) ForgetStream(stream);
    return ended;
  });
}

void ChaosProxy::ForgetStream(const ChaosStream& stream) {
  up_stream_counts_.Add(stream.up_counts());
  down_stream_counts_.Add(stream.down_counts());
}

void ChaosProxy::ForgetOldest() {
  up_counts_.Add(flows_.back()->up.counts());
  down_counts_.Add(flows_.back()->down.counts());
  flows_.pop_back();
}

std::int64_t ChaosProxy::WaitNs(std::int64_t now_us) const {
  std::int64_t wait_ns = kLongestWaitNs;
  const auto not_beyond = [&](std::int64_t due_us) {
    if (due_us >= 0) wait_ns = std::min(wait_ns, (due_us - now_us) * kMicrosecond);
  };
  for (const auto& flow : flows_) {
    not_beyond(flow->up.next_us());
    not_beyond(flow->down.next_us());
  }
  for (const ChaosStream& stream : streams_) not_beyond(stream.next_us(now_us));
  return wait_ns;
}

void ChaosProxy::ReadClients(std::int64_t now_us) {
  constexpr int kAtOnce = 256;
  for (int i = 0; i < kAtOnce; ++i) {
    sockaddr_storage from{};
    socklen_t size = sizeof(from);
    const ssize_t bytes = recvfrom(udp_.get(), buffer_.data(), buffer_.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes < 0) return;
    Flow* const flow = FindFlow(from, size);
    if (flow == nullptr) continue;
    flow->up.Push(std::span(buffer_).first(static_cast<std::size_t>(bytes)), now_us);
  }
}

ChaosProxy::Flow* ChaosProxy::FindFlow(const sockaddr_storage& from, socklen_t size) {
  const auto found = std::ranges::find_if(flows_, [&](const std::unique_ptr<Flow>& flow) {
    return flow->client_size == size && std::memcmp(&flow->client, &from, size) == 0;
  });
  if (found != flows_.end()) {
    flows_.splice(flows_.begin(), flows_, found);
    return flows_.front().get();
  }
  std::string error;
  auto flow = std::make_unique<Flow>(options_, next_number_++, start_us_);
  flow->client = from;
  flow->client_size = size;
  flow->server =
      Socket::Open(client::TransportKind::kUdp, options_.to_host, options_.to_udp, &error);
  if (!flow->server) return nullptr;
  poller_.Add(flow->server->descriptor(), reinterpret_cast<std::uint64_t>(flow.get()));
  flows_.push_front(std::move(flow));
  return flows_.front().get();
}

void ChaosProxy::ReadServer(Flow& flow, std::int64_t now_us) {
  constexpr int kAtOnce = 256;
  for (int i = 0; i < kAtOnce; ++i) {
    const ssize_t bytes =
        recv(flow.server->descriptor(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (bytes < 0) return;  // nothing, or a refusal: the server may come back
    flow.down.Push(std::span(buffer_).first(static_cast<std::size_t>(bytes)), now_us);
  }
}

void ChaosProxy::ForwardDue(std::int64_t now_us) {
  for (const auto& flow : flows_) {
    while (flow->up.Pop(now_us, &packet_))
      (void)send(flow->server->descriptor(), packet_.data(), packet_.size(), MSG_DONTWAIT);
    while (flow->down.Pop(now_us, &packet_)) {
      (void)sendto(udp_.get(), packet_.data(), packet_.size(), 0,
                   reinterpret_cast<const sockaddr*>(&flow->client), flow->client_size);
    }
  }
}

void ChaosProxy::Accept() {
  Descriptor client(accept4(tcp_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (client.get() < 0) return;
  const int on = 1;
  setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  std::string error;
  auto server =
      OpenDescriptor(client::TransportKind::kTcp, options_.to_host, options_.to_tcp, &error);
  if (server.get() < 0) return;  // refused there: refused here
  setsockopt(server.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  streams_.emplace_back(std::move(client), std::move(server), options_.up, options_.down,
                        next_number_++, start_us_);
  // Of what is held back nobody reads for a while, so only what is new may wake us.
  poller_.Add(streams_.back().client(), kStream, Poller::When::kEdge);
  poller_.Add(streams_.back().server(), kStream, Poller::When::kEdge);
}

}  // namespace furrow::load
