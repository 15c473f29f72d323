// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/playback/player.h"

namespace furrow::server {

// Shows and controls the timeline of furrowd --play: GET and PATCH /api/playback.
class PlaybackApi {
 public:
  // `player`: null without --play; every request is then answered with 409.
  explicit PlaybackApi(Player* player) : player_(player) {}

  // The state of the timeline.
  [[nodiscard]] ApiReply Show(Time now) const;
  // Changes the members that the body names, or none if one is invalid. Returns the new state.
  [[nodiscard]] ApiReply Patch(const ApiRequest& request, Time now);

 private:
  Player* const player_;
};

}  // namespace furrow::server
