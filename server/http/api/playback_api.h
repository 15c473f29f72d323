// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/playback/playback.h"
#include "server/session/hub.h"

namespace furrow::server {

// 403 if `access` is not for the subject that a recording would publish; nothing: it is.
[[nodiscard]] std::optional<ApiReply> RefuseSubject(const std::string& subject,
                                                    const Access& access);

// Shows and controls the timeline of the recording that the daemon plays, and changes it for an
// uploaded one: /api/playback. All functions require the hub's exclusive lock.
class PlaybackApi {
 public:
  // `playback`: not null; outlives this object.
  explicit PlaybackApi(Playback* playback) : playback_(playback) {}

  // GET: the state of the timeline.
  [[nodiscard]] ApiReply Show(Time now) const;
  // PATCH: changes the members that the body names, or none if one is invalid. Returns the new
  // state.
  [[nodiscard]] ApiReply Patch(const ApiRequest& request, Time now);
  // POST: plays the recording of the request instead of what plays now. Returns the new state with
  // the warnings of the reader.
  [[nodiscard]] ApiReply Play(const ApiRequest& request, const Hub& hub, Time now);
  // DELETE: ends the uploaded recording. Returns an empty object; GET shows what plays now.
  [[nodiscard]] ApiReply Close(Time now);

 private:
  Playback* const playback_;
};

}  // namespace furrow::server
