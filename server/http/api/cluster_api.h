// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/cluster/coordinator.h"
#include "server/core/time.h"
#include "server/http/api/token_api.h"
#include "server/http/request/api_types.h"

namespace furrow::server {

// What a node says of its cluster: GET /api/place and GET /api/cluster.
class ClusterApi {
 public:
  // `cluster`: null: the daemon is alone. `tokens`: not null. Both outlive the object.
  ClusterApi(const Coordinator* cluster, TokenApi* tokens) : cluster_(cluster), tokens_(tokens) {}

  // The node that serves ?subject=NAME, or that should be offered it. Holders of the role operate
  // may ask for a token that is valid for this node and subject alone: &roles=watch&for=1h
  [[nodiscard]] ApiReply FindPlace(const ApiRequest& request, Time now);
  // All nodes, and where each subject is served.
  [[nodiscard]] ApiReply Show(Time now) const;

 private:
  const Coordinator* const cluster_;
  TokenApi* const tokens_;
};

}  // namespace furrow::server
