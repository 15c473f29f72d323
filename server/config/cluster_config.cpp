// SPDX-License-Identifier: Apache-2.0
#include "server/config/cluster_config.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "base/text.h"
#include "server/cluster/node/node_address.h"

namespace furrow::server {
namespace {

Status Refuse(std::string what, std::string todo = {}) {
  return {StatusCode::kInvalidArgument, std::move(what), "", std::move(todo)};
}

bool IsStoreUrl(std::string_view url) {
  const bool known = url.starts_with("nats://") || url.starts_with("tls://");
  const std::string_view address = url.substr(std::min(url.size(), url.find("://") + 3));
  const std::size_t colon = address.rfind(':');
  if (!known || colon == std::string_view::npos || colon == 0) return false;
  std::uint16_t port = 0;
  const auto [end, error] =
      std::from_chars(address.data() + colon + 1, address.data() + address.size(), port);
  return error == std::errc() && end == address.data() + address.size() && port != 0 &&
         address.find_first_of("@/ ,") == std::string_view::npos;
}

Status ValidateStatic(const ClusterConfig& cluster, const std::string& name) {
  bool has_self = false;
  for (const std::string& text : cluster.nodes) {
    const auto node = ParseNode(text);
    if (!node.ok()) return node.status().At("--cluster-node");
    has_self |= node->name == name;
  }
  if (has_self) return {};
  return Refuse("--cluster-node: the list has no node named '" + name + "'",
                "list all nodes, this one among them");
}

}  // namespace

Status ValidateCluster(const ClusterConfig& cluster, const std::string& name,
                       const std::string& bind) {
  if (!cluster.enabled()) return {};
  if (!IsNodeName(name)) {
    return Refuse(
        "a cluster needs --name: 1 to 47 letters, digits, '-' and '_', another one "
        "for each daemon");
  }
  const bool is_any = bind == "0.0.0.0" || bind == "::";
  if (is_any && cluster.advertise.empty()) {
    return Refuse("--bind " + bind + " gives clients no address to go to",
                  "name this computer by --cluster-advertise HOST");
  }
  if (!cluster.advertise.empty() && !IsHost(cluster.advertise)) {
    return Refuse("--cluster-advertise: " + Quoted(cluster.advertise) + " is not a host",
                  "give the name or the numeric address alone, without a port");
  }
  if (!cluster.store.empty() && !cluster.nodes.empty()) {
    return Refuse("--cluster and --cluster-node cannot be combined",
                  "with a store, the nodes find each other");
  }
  if (cluster.store.empty()) return ValidateStatic(cluster, name);
  if (!IsStoreUrl(cluster.store)) {
    return Refuse(
        "--cluster: the address of the store must be nats://HOST:PORT or "
        "tls://HOST:PORT",
        "put a user and password into the file of --cluster-credentials");
  }
  return {};
}

}  // namespace furrow::server
