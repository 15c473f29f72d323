// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include <sys/socket.h>

#include "base/status.h"
#include "client/chaos/link.h"
#include "client/chaos/report.h"
#include "client/chaos/stream.h"
#include "client/load/net/poller.h"
#include "client/load/net/socket.h"

namespace furrow::load {

struct ChaosProxyOptions {
  std::string listen_host = "127.0.0.1";  // numeric
  std::uint16_t listen_port = 0;          // UDP's; 0: any free one
  std::uint16_t listen_tcp_port = 0;      // 0: any free one
  std::string to_host;
  std::uint16_t to_udp = 0;
  std::uint16_t to_tcp = 0;  // 0: datagrams alone
  ChaosOptions up;           // what comes from clients; of TCP: delays and black holes alone
  ChaosOptions down;         // what goes to them
};

// Stands between clients and a server and mistreats what passes: datagrams as their links say, TCP
// connections by holding bytes back (black holes and jitter), since TCP loses nothing.
//
// One thread runs it. Memory is bounded by what the delays hold; 1,024 addresses are remembered.
class ChaosProxy {
 public:
  // kIo: the port cannot be had; kUnavailable: the server's name cannot be resolved.
  [[nodiscard]] static Result<std::unique_ptr<ChaosProxy>> Open(const ChaosProxyOptions& options);
  ~ChaosProxy();

  [[nodiscard]] std::uint16_t udp_port() const { return udp_port_; }
  [[nodiscard]] std::uint16_t tcp_port() const { return tcp_port_; }

  // Forwards until `go_on` says false, which is asked several times a second.
  void Run(const std::function<bool()>& go_on);

  // Of all links and TCP connections, by direction, once Run() has ended.
  [[nodiscard]] ChaosOutcome up() const { return {options_.up, up_counts_, up_stream_counts_}; }
  [[nodiscard]] ChaosOutcome down() const {
    return {options_.down, down_counts_, down_stream_counts_};
  }

 private:
  struct Flow;  // the datagrams of one client

  explicit ChaosProxy(ChaosProxyOptions options);
  [[nodiscard]] Status Listen();
  void ReadClients(std::int64_t now_us);
  // Null where the server cannot be reached for it.
  [[nodiscard]] Flow* FindFlow(const sockaddr_storage& from, socklen_t size);
  void ReadServer(Flow& flow, std::int64_t now_us);
  void ForwardDue(std::int64_t now_us);
  void ForgetOldest();
  void Accept();
  void PumpStreams(std::int64_t now_us);
  void ForgetStream(const ChaosStream& stream);
  [[nodiscard]] std::int64_t WaitNs(std::int64_t now_us) const;

  ChaosProxyOptions options_;
  Descriptor udp_;
  Descriptor tcp_;
  std::uint16_t udp_port_ = 0;
  std::uint16_t tcp_port_ = 0;
  Poller poller_;
  std::list<std::unique_ptr<Flow>> flows_;  // the one heard last first
  std::list<ChaosStream> streams_;
  std::int64_t start_us_ = -1;     // when the first packet came: what black holes count from
  std::uint64_t next_number_ = 0;  // of a flow or stream
  std::vector<std::uint8_t> buffer_;
  std::vector<std::uint8_t> packet_;
  ChaosCounts up_counts_;
  ChaosCounts down_counts_;
  ChaosStreamCounts up_stream_counts_;
  ChaosStreamCounts down_stream_counts_;
};

}  // namespace furrow::load
