// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/api/capture_api.h"
#include "server/http/request/api_types.h"
#include "server/session/hub.h"

namespace furrow::server {

// Shows the rig in use and explains wrinkle weights: /api/rig, /api/rig.json and /api/explain.
class RigApi {
 public:
  // `captures`: provides the undo history that /api/rig shows; must outlive this object.
  explicit RigApi(const CaptureApi* captures) : captures_(captures) {}

  // All functions require the hub's exclusive lock.
  // A summary of the rig: regions, maps, drivers.
  [[nodiscard]] ApiReply ShowRig(const Hub& hub) const;
  // The rig as a file to save.
  [[nodiscard]] ApiReply RigFile(const Hub& hub) const;
  // Explains one weight of a subject's current pose. Evaluates the subject in full from now on.
  [[nodiscard]] ApiReply Explain(const ApiRequest& request, Hub& hub) const;

 private:
  const CaptureApi* const captures_;
};

}  // namespace furrow::server
