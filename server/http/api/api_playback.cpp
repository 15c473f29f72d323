// SPDX-License-Identifier: Apache-2.0
// The part of Api that moves the timeline of furrowd --play.
#include <string>

#include <nlohmann/json.hpp>

#include "server/http/api/api.h"
#include "server/playback/player.h"

namespace furrow::server {
namespace {

ApiReply NothingPlays() {
  return ErrorReply(409, "conflict", "", "nothing plays here", "start furrowd with --play FILE");
}

Status MustBe(const char* what, const std::string& field) {
  return Status(StatusCode::kSchema, std::string("must be ") + what, field);
}

Result<Player::Change> ChangeOf(const Json& object) {
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

ApiReply Api::Playback(const ApiRequest&, Hub&, Time now) {
  if (parts_.player == nullptr) return NothingPlays();
  const Player::State state = parts_.player->state(now);
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

ApiReply Api::PatchPlayback(const ApiRequest& request, Hub& hub, Time now) {
  if (parts_.player == nullptr) return NothingPlays();
  const Result<Json> object = ObjectOf(request);
  if (!object.ok()) return ErrorReply(object.status());
  const Result<Player::Change> change = ChangeOf(*object);
  if (!change.ok()) return ErrorReply(change.status());
  if (Status status = parts_.player->Apply(*change, now); !status.ok()) return ErrorReply(status);
  return Playback(request, hub, now);
}

}  // namespace furrow::server
