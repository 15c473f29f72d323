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
#include "client/net/clock.h"
#include "client/net/open_socket.h"

namespace furrow::chaos {
namespace {

constexpr std::size_t kMaxFlows = 1024;
constexpr std::int64_t kLongestWaitNs = 100'000'000;
constexpr std::int64_t kMicrosecond = 1000;

// Tokens of the poller. The token of a flow is its address, which is larger than these.
enum Token : std::uint64_t { kClients = 0, kListener = 1, kRelay = 2, kFlow = 3 };

std::int64_t NowUs() { return net::SteadyNanoseconds() / kMicrosecond; }

// Numeric addresses only: the proxy must not wait for a name server.
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

// Binds a socket to `port` of `host` (0: any free port) and sets `port` to the actual port.
Status Bind(const std::string& host, int type, Descriptor* bound, std::uint16_t* port) {
  sockaddr_storage address;
  socklen_t size = 0;
  const std::string where =
      host + ":" + std::to_string(*port) + (type == SOCK_STREAM ? " (TCP)" : " (UDP)");
  if (!ParseAddress(host, *port, &address, &size))
    return {StatusCode::kInvalidArgument, "not a numeric IP address", where};
  Descriptor made(socket(address.ss_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  // Not for UDP, where it would let two proxies share a port.
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

// A socket of its own per client, because the server tells its peers apart by address and port.
struct Proxy::Flow {
  sockaddr_storage client{};
  socklen_t client_size = 0;
  std::unique_ptr<net::Socket> server;
  Link up;
  Link down;

  Flow(const ProxyOptions& options, std::uint64_t number, std::int64_t start_us)
      // Different link numbers give the two directions different faults.
      : up(options.up, 2 * number, start_us), down(options.down, 2 * number + 1, start_us) {}
};

Proxy::Proxy(ProxyOptions options) : options_(std::move(options)), buffer_(64 * 1024) {}
Proxy::~Proxy() = default;

Result<std::unique_ptr<Proxy>> Proxy::Open(const ProxyOptions& options) {
  std::unique_ptr<Proxy> proxy(new Proxy(options));
  FURROW_RETURN_IF_ERROR(proxy->Listen());
  FURROW_RETURN_IF_ERROR(
      // Opened and closed again, so that an unknown host is an error before the first packet.
      net::OpenSocket(client::TransportKind::kUdp, options.to_host, options.to_udp));
  return proxy;
}

Status Proxy::Listen() {
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

void Proxy::Run(const std::function<bool()>& keep_going) {
  while (keep_going()) {
    for (const epoll_event& event : poller_.Wait(WaitNs(NowUs()))) {
      const std::uint64_t token = event.data.u64;
      // Black holes count from the first packet, so a run does not depend on when its client
      // starts.
      if (start_us_ < 0) start_us_ = NowUs();
      if (token == kClients) ReadClients(NowUs());
      if (token == kListener) Accept();
      if (token >= kFlow) ReadServer(*reinterpret_cast<Flow*>(token), NowUs());
    }
    const std::int64_t now_us = NowUs();
    ForwardDue(now_us);
    PumpRelays(now_us);
    // After the events: their tokens are addresses of flows, which must exist until all are
    // handled.
    while (flows_.size() > kMaxFlows) ForgetOldest();
  }
  while (!flows_.empty()) ForgetOldest();
  for (const TcpRelay& relay : relays_) ForgetRelay(relay);
  relays_.clear();
}

void Proxy::PumpRelays(std::int64_t now_us) {
  std::erase_if(relays_, [&](TcpRelay& relay) {
    const bool ended = !relay.Pump(now_us);
    if (ended) ForgetRelay(relay);
    return ended;
  });
}

void Proxy::ForgetRelay(const TcpRelay& relay) {
  up_relay_counts_.Add(relay.up_counts());
  down_relay_counts_.Add(relay.down_counts());
}

// Keeps the counts of a flow and closes it. Its waiting packets are lost.
void Proxy::ForgetOldest() {
  up_counts_.Add(flows_.back()->up.counts());
  down_counts_.Add(flows_.back()->down.counts());
  flows_.pop_back();
}

// Time until the next packet is due or `keep_going` must be asked again.
std::int64_t Proxy::WaitNs(std::int64_t now_us) const {
  std::int64_t wait_ns = kLongestWaitNs;
  const auto not_beyond = [&](std::int64_t due_us) {
    if (due_us >= 0) wait_ns = std::min(wait_ns, (due_us - now_us) * kMicrosecond);
  };
  for (const auto& flow : flows_) {
    not_beyond(flow->up.next_us());
    not_beyond(flow->down.next_us());
  }
  for (const TcpRelay& relay : relays_) not_beyond(relay.next_us(now_us));
  return wait_ns;
}

void Proxy::ReadClients(std::int64_t now_us) {
  // A flood from one side must not keep the other side, or due packets, waiting.
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

Proxy::Flow* Proxy::FindFlow(const sockaddr_storage& from, socklen_t size) {
  const auto found = std::ranges::find_if(flows_, [&](const std::unique_ptr<Flow>& flow) {
    return flow->client_size == size && std::memcmp(&flow->client, &from, size) == 0;
  });
  if (found != flows_.end()) {
    // To the front: the list is in the order of activity. The flow keeps its address, which is its
    // token.
    flows_.splice(flows_.begin(), flows_, found);
    return flows_.front().get();
  }
  auto server = net::OpenSocket(client::TransportKind::kUdp, options_.to_host, options_.to_udp);
  if (!server.ok()) return nullptr;
  auto flow = std::make_unique<Flow>(options_, next_number_++, start_us_);
  flow->client = from;
  flow->client_size = size;
  flow->server = *std::move(server);
  poller_.Add(flow->server->descriptor(), reinterpret_cast<std::uint64_t>(flow.get()));
  flows_.push_front(std::move(flow));
  return flows_.front().get();
}

void Proxy::ReadServer(Flow& flow, std::int64_t now_us) {
  constexpr int kAtOnce = 256;
  for (int i = 0; i < kAtOnce; ++i) {
    const ssize_t bytes =
        recv(flow.server->descriptor(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (bytes < 0) return;  // no data, or a closed port: the server may come back
    flow.down.Push(std::span(buffer_).first(static_cast<std::size_t>(bytes)), now_us);
  }
}

void Proxy::ForwardDue(std::int64_t now_us) {
  for (const auto& flow : flows_) {
    // A send that fails is a lost datagram, which UDP allows; it is not counted as an injected
    // fault.
    while (flow->up.Pop(now_us, &packet_))
      (void)send(flow->server->descriptor(), packet_.data(), packet_.size(), MSG_DONTWAIT);
    while (flow->down.Pop(now_us, &packet_)) {
      (void)sendto(udp_.get(), packet_.data(), packet_.size(), 0,
                   reinterpret_cast<const sockaddr*>(&flow->client), flow->client_size);
    }
  }
}

void Proxy::Accept() {
  Descriptor client(accept4(tcp_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (client.get() < 0) return;
  const int on = 1;
  setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  auto server = net::OpenDescriptor(client::TransportKind::kTcp, options_.to_host, options_.to_tcp);
  if (!server.ok()) return;  // closes the client's connection too
  setsockopt(server->get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  relays_.emplace_back(std::move(client), *std::move(server), options_.up, options_.down,
                       next_number_++, start_us_);
  // A relay that holds data back does not read for a while, so only new data may wake the poller.
  poller_.Add(relays_.back().client(), kRelay, net::Poller::When::kEdge);
  poller_.Add(relays_.back().server(), kRelay, net::Poller::When::kEdge);
}

}  // namespace furrow::chaos
