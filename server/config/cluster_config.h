// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/status.h"

namespace furrow::server {

// How this daemon shares subjects with others (docs/CLUSTER.md).
struct ClusterConfig {
  std::string store;                  // nats://HOST:PORT or tls://HOST:PORT; empty: none
  std::vector<std::string> nodes;     // without a store: all nodes (ParseNode())
  std::string bucket = "furrow";      // of the store: one per cluster
  std::string advertise;              // the host by which clients reach this node; empty: bind
  std::filesystem::path credentials;  // "user:password", or a .creds file of NATS; empty: none
  std::filesystem::path authority;    // checks the store's certificate; empty: the system's
  bool strict = false;                // without the store, stop serving instead of going on
  friend bool operator==(const ClusterConfig&, const ClusterConfig&) = default;

  [[nodiscard]] bool enabled() const { return !store.empty() || !nodes.empty(); }
};

// Checks the values that have flags. `name`, `bind`: of the daemon. Errors: kInvalidArgument, with
// the flag.
[[nodiscard]] Status ValidateCluster(const ClusterConfig& cluster, const std::string& name,
                                     const std::string& bind);

}  // namespace furrow::server
