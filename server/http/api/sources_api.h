// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/net/mocap_report.h"

namespace furrow::server {

// Reports where phones and trackers send to, and what has arrived from them: /api/sources.
class SourcesApi {
 public:
  struct Parts {
    std::string bind;  // the numeric address that the daemon listens on
    // The numeric addresses of senders; empty: any sender. Called on the hub's thread.
    std::function<std::vector<std::string>()> allow;
    // What has arrived at the port; empty, or absent: it is off. Called on the hub's thread.
    std::function<std::optional<MocapReport>(Time)> livelink_face;
    std::function<std::optional<MocapReport>(Time)> vmc;
  };
  explicit SourcesApi(Parts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] ApiReply Show(Time now) const;

 private:
  const Parts parts_;
};

}  // namespace furrow::server
