// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace furrow::server {

// Upper bounds of one daemon ([limits] in furrow.example.toml). Counts are in [1, 1'000'000],
// rates and times in (0, 1e9]; ValidateConfig() checks them. Each limit applies to the whole daemon
// unless its comment names something smaller.
struct Limits {
  // Shared between hosts (FairShare): one host alone gets half.
  int max_connections = 512;  // TCP connections
  int max_udp_peers = 8192;   // proven UDP addresses, over all threads
  int max_subjects = 2048;    // subjects published at a time
  // Over TLS: clients of one host that have not shown who they are, in [1, 256].
  int max_strangers_per_host = 1;
  int max_skeletons = 256;     // bound skeletons kept for reuse
  int max_subscriptions = 64;  // per peer, at most 65,535
  // Shared between hosts, at least max_subscriptions.
  int max_all_subscriptions = 16'384;
  double packets_per_second = 20000;  // per peer: datagrams or TCP messages
  double packet_burst = 4000;         // per peer: messages accepted at once
  // What waits for TCP and web clients that read slowly, shared between hosts (WaitingBytes), at
  // least 72.
  int max_waiting_megabytes = 256;
  int outbox_messages = 64;   // per TCP peer: queued frames; newer frames replace older ones
  double idle_seconds = 30;   // forget a peer without subscriptions after this silence
  double loss_seconds = 0.5;  // a subject without a pose for this long decays to neutral
  double drain_seconds = 2;   // after SIGTERM: time for queued messages to leave

  [[nodiscard]] std::size_t waiting_bytes() const {
    return static_cast<std::size_t>(max_waiting_megabytes) * 1'000'000;
  }
  friend bool operator==(const Limits&, const Limits&) = default;
};

}  // namespace furrow::server
