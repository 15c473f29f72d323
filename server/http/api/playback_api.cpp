// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/playback_api.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "server/http/request/json_reply.h"

namespace furrow::server {
namespace {

ApiReply NoPlayer() {
  return ErrorReply(409, "conflict", "", "no recording is playing",
                    "drop a recording on the page, or start furrowd with --play FILE");
}

Json StateOf(const Playback& playback, Time now) {
  const Player::State state = playback.player()->state(now);
  return {{"file", state.file},
          {"subject", state.subject},
          {"uploaded", playback.is_uploaded()},
          {"frames", state.frames},
          {"seconds", state.seconds},
          {"rate_hz", state.rate_hz},
          {"position_s", state.position},
          {"frame", state.frame},
          {"playing", state.playing},
          {"loop", state.loop},
          {"speed", state.speed}};
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

std::optional<ApiReply> RefuseSubject(const std::string& subject, const Access& access) {
  if (access.Concerns(subject)) return std::nullopt;
  return ErrorReply(403, "forbidden", "",
                    "not permitted to play '" + subject + "'; " + access.Text(),
                    "rename the file to a subject of the token");
}

ApiReply PlaybackApi::Show(Time now) const {
  if (playback_->player() == nullptr) return NoPlayer();
  return JsonReply(StateOf(*playback_, now));
}

ApiReply PlaybackApi::Patch(const ApiRequest& request, Time now) {
  if (playback_->player() == nullptr) return NoPlayer();
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  const Result<Player::Change> change = ParseChange(*object);
  if (!change.ok()) return ErrorReply(change.status());
  if (Status status = playback_->player()->Apply(*change, now); !status.ok()) {
    return ErrorReply(status);
  }
  return Show(now);
}

ApiReply PlaybackApi::Play(const ApiRequest& request, const Hub& hub, Time now) {
  if (request.recording == nullptr || request.recording->player == nullptr) {
    return ErrorReply(400, "invalid_argument", "", "the request has no recording",
                      "send the bytes of the file as the body");
  }
  const std::string& subject = request.recording->player->subject();
  if (auto refusal = RefuseSubject(subject, request.access)) return *std::move(refusal);
  if (hub.draining()) {
    return ErrorReply(503, "unavailable", "", "the daemon is shutting down");
  }
  if (Status status = playback_->Play(std::move(request.recording->player), now); !status.ok()) {
    return ErrorReply(409, "conflict", "", status.what(),
                      "the recording is named after its file: rename the file");
  }
  Json state = StateOf(*playback_, now);
  state["warnings"] = request.recording->warnings;
  return JsonReply(state);
}

ApiReply PlaybackApi::Close(Time now) {
  if (!playback_->Close(now)) {
    return ErrorReply(409, "conflict", "", "no uploaded recording is playing",
                      "the recording of --play ends with the daemon");
  }
  return JsonReply(Json::object());
}

}  // namespace furrow::server
