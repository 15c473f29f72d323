// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/setup/make_coordinator.h"

#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "server/cluster/static_list.h"
#include "server/cluster/store/store.h"
#include "server/cluster/store/store_coordinator.h"
#include "server/machine/pulse.h"
#include "server/net/clock.h"

namespace furrow::server {
namespace {

constexpr std::uint64_t kMaxCredentialBytes = 64 * 1024;
constexpr char kCredsMark[] = "-----BEGIN NATS USER JWT-----";

// "user:password" on the first line, or a .creds file, which the library reads by itself.
Status ReadCredentials(const std::filesystem::path& path, StoreOptions* options) {
  if (path.empty()) return {};
  auto text = ReadSecretFile(path, kMaxCredentialBytes);
  if (!text.ok()) return text.status().Within("--cluster-credentials");
  if (text->find(kCredsMark) != std::string::npos) {
    options->credentials = path.string();
    return {};
  }
  const std::string line = text->substr(0, text->find_first_of("\r\n"));
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos || colon == 0) {
    return {StatusCode::kParse, "is neither user:password nor a .creds file of NATS",
            path.string()};
  }
  options->user = line.substr(0, colon);
  options->password = line.substr(colon + 1);
  return {};
}

}  // namespace

Result<std::unique_ptr<Coordinator>> MakeCoordinator(const Config& config, std::uint64_t run) {
  const ClusterConfig& cluster = config.cluster;
  if (!cluster.enabled()) return std::unique_ptr<Coordinator>();
  if (cluster.store.empty()) {
    std::vector<NodeAddress> nodes;
    for (const std::string& text : cluster.nodes) {
      auto node = ParseNode(text);
      FURROW_RETURN_IF_ERROR(node);
      nodes.push_back(*std::move(node));
    }
    return std::unique_ptr<Coordinator>(
        std::make_unique<StaticList>(config.security.name, std::move(nodes)));
  }
  StoreOptions options{.url = cluster.store,
                       .bucket = cluster.bucket,
                       .node = config.security.name,
                       .user = {},
                       .password = {},
                       .credentials = {},
                       .authority = cluster.authority.string()};
  FURROW_RETURN_IF_ERROR(ReadCredentials(cluster.credentials, &options));
  auto store = MakeNatsStore(options);
  FURROW_RETURN_IF_ERROR(store);
  const auto pulse = std::make_shared<Pulse>(ReadClock);
  return std::unique_ptr<Coordinator>(std::make_unique<StoreCoordinator>(
      StoreCoordinator::Parts{.store = *std::move(store),
                              .node = config.security.name,
                              .run = run,
                              .capacity = config.limits.max_subjects,
                              .strict = cluster.strict,
                              .now = ReadClock,
                              .pause = [pulse] { return pulse->TakeLongestPause(); },
                              .unix_ms = [] { return ToMicroseconds(ReadUnixClock()) / 1000; }}));
}

}  // namespace furrow::server
