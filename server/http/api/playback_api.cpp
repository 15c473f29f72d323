// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/playback_api.h"

#include <string>

#include <nlohmann/json.hpp>

#include "server/http/request/json_reply.h"

namespace furrow::server {
namespace {

ApiReply NoPlayer() {
  return ErrorReply(409, "conflict", "", "no recording is playing",
                    "start furrowd with --play FILE");
}

// The error for a value of the wrong type.
Status MustBe(const char* what, const std::string& field) {
  return Status(StatusCode::kSchema, std::string("must be ") + what, field);
}

// Checks types and names; Player::Apply() checks the ranges. Unknown names are errors, because a
// misspelt one would silently do nothing.
Result<Player::Change> ParseChange(const Json& object) {
  Player::Change change;
  for (const auto& [name, value] : object.items()) {
    if (name == "playing" || name == "loop") {
      if (!value.is_boolean()) return MustBe("true or false", name);
      (name == "loop" ? change.loop : change.playing) = value.get<bool>();
    } else if (name == "speed" || name == "position_s") {
      if (!value.is_number()) return MustBe("a number", name);
      (name == "speed" ? change.speed : change.position) = value.get<double>();
    } else {
      return MustBe("one of playing, loop, speed, position_s", name);
    }
  }
  return change;
}

}  // namespace

ApiReply PlaybackApi::Show(Time now) const {
  if (player_ == nullptr) return NoPlayer();
  const Player::State state = player_->state(now);
  return JsonReply({{"file", state.file},
                    {"subject", state.subject},
                    {"frames", state.frames},
                    {"seconds", state.seconds},
                    {"rate_hz", state.rate_hz},
                    {"position_s", state.position},
                    {"frame", state.frame},
                    {"playing", state.playing},
                    {"loop", state.loop},
                    {"speed", state.speed}});
}

ApiReply PlaybackApi::Patch(const ApiRequest& request, Time now) {
  if (player_ == nullptr) return NoPlayer();
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  const Result<Player::Change> change = ParseChange(*object);
  if (!change.ok()) return ErrorReply(change.status());
  if (Status status = player_->Apply(*change, now); !status.ok()) return ErrorReply(status);
  return Show(now);
}

}  // namespace furrow::server
