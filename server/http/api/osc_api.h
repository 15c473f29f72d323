// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/api_types.h"
#include "server/osc/osc_control.h"

namespace furrow::server {

// Shows, adds and removes targets of OSC: GET, POST and DELETE /api/osc.
class OscApi {
 public:
  explicit OscApi(OscControl* targets) : targets_(targets) {}

  // All targets, the shipped profiles, and the addresses that may be added.
  [[nodiscard]] ApiReply List() const;
  // Adds the target that the body describes. Replies with all targets.
  [[nodiscard]] ApiReply Add(const ApiRequest& request);
  // Removes the target `id` of the query. Replies with all targets.
  [[nodiscard]] ApiReply Remove(const ApiRequest& request);

 private:
  OscControl* const targets_;
};

}  // namespace furrow::server
