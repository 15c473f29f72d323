// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include <sys/socket.h>

#include "base/process/descriptor.h"
#include "base/status.h"
#include "client/chaos/link.h"
#include "client/chaos/report.h"
#include "client/chaos/tcp_relay.h"
#include "client/net/poller.h"

namespace furrow::chaos {

// The addresses and faults of a proxy.
struct ProxyOptions {
  std::string listen_host = "127.0.0.1";  // numeric address
  std::uint16_t listen_port = 0;          // UDP; 0: any free port
  std::uint16_t listen_tcp_port = 0;      // 0: any free port
  std::string to_host;                    // the server: a name or a numeric address
  std::uint16_t to_udp = 0;               // the server's UDP port
  std::uint16_t to_tcp = 0;               // the server's TCP port; 0: do not forward TCP
  Faults up;    // client to server; TCP honours jitter and black holes only
  Faults down;  // server to client
};

// Forwards traffic between clients and a server and injects faults. Datagrams pass through a Link
// per client and direction; TCP connections pass through a TcpRelay.
//
// Single-threaded. Memory is bounded by the delayed packets and by 1,024 client addresses.
class Proxy {
 public:
  // Binds the ports and resolves the server's name. Errors: kInvalidArgument (`listen_host` is not
  // a numeric address), kIo (cannot bind), kUnavailable (the server's name does not resolve).
  [[nodiscard]] static Result<std::unique_ptr<Proxy>> Open(const ProxyOptions& options);
  ~Proxy();

  // The ports that the proxy listens on.
  [[nodiscard]] std::uint16_t udp_port() const { return udp_port_; }
  [[nodiscard]] std::uint16_t tcp_port() const { return tcp_port_; }

  // Forwards until `keep_going` returns false; calls it at least ten times per second.
  void Run(const std::function<bool()>& keep_going);

  // Totals of all links and TCP connections, per direction. Valid after Run().
  [[nodiscard]] Outcome up() const { return {options_.up, up_counts_, up_relay_counts_}; }
  [[nodiscard]] Outcome down() const { return {options_.down, down_counts_, down_relay_counts_}; }

 private:
  struct Flow;  // the links of one client address

  explicit Proxy(ProxyOptions options);
  [[nodiscard]] Status Listen();
  void ReadClients(std::int64_t now_us);
  // Returns null if no socket to the server can be opened.
  [[nodiscard]] Flow* FindFlow(const sockaddr_storage& from, socklen_t size);
  void ReadServer(Flow& flow, std::int64_t now_us);
  void ForwardDue(std::int64_t now_us);
  void ForgetOldest();
  void Accept();
  void PumpRelays(std::int64_t now_us);
  void ForgetRelay(const TcpRelay& relay);
  [[nodiscard]] std::int64_t WaitNs(std::int64_t now_us) const;

  ProxyOptions options_;
  Descriptor udp_;
  Descriptor tcp_;
  std::uint16_t udp_port_ = 0;
  std::uint16_t tcp_port_ = 0;
  net::Poller poller_;
  std::list<std::unique_ptr<Flow>> flows_;  // most recently active first
  std::list<TcpRelay> relays_;
  std::int64_t start_us_ = -1;     // arrival of the first packet: time 0 of the black holes
  std::uint64_t next_number_ = 0;  // for the next flow or relay
  std::vector<std::uint8_t> buffer_;
  std::vector<std::uint8_t> packet_;
  FaultCounts up_counts_;
  FaultCounts down_counts_;
  RelayCounts up_relay_counts_;
  RelayCounts down_relay_counts_;
};

}  // namespace furrow::chaos
