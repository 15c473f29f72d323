// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/net/mocap_report.h"
#include "server/session/hub.h"

namespace furrow::server {

// Reports where phones and trackers send to, what has arrived from them, and what the subjects of
// all senders lack: /api/sources.
class SourcesApi {
 public:
  struct Parts {
    std::string bind;  // the numeric address that the daemon listens on
    // The numeric addresses of senders; empty: any sender. Called on the hub's thread.
    std::function<std::vector<std::string>()> allow;
    // What has arrived at the port; empty, or absent: it is off. Called on the hub's thread.
    std::function<std::optional<MocapReport>(Time)> livelink_face;
    std::function<std::optional<MocapReport>(Time)> vmc;
    // MocapInputs::Give(). Called on the hub's thread.
    std::function<Status(bool vmc, const std::string& sender, Time now)> give;
    std::function<Time()> unix_now;  // the system's clock, since 1970
  };
  explicit SourcesApi(Parts parts) : parts_(std::move(parts)) {}

  // Names the subjects that the request may know of. Requires the hub's exclusive lock.
  [[nodiscard]] ApiReply Show(const ApiRequest& request, Hub& hub, Time now) const;
  // {"input": "vmc", "sender": "192.0.2.7"}: this sender holds the port from now on. Needs a token
  // for all subjects, if any. Replies as Show() does. Requires the hub's exclusive lock.
  [[nodiscard]] ApiReply Accept(const ApiRequest& request, Hub& hub, Time now) const;

 private:
  const Parts parts_;
};

}  // namespace furrow::server
