// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "server/core/metrics.h"
#include "server/http/request/api_types.h"
#include "server/pipeline/picture_source.h"
#include "server/session/hub.h"

namespace furrow::server {

class Player;

using Json = nlohmann::ordered_json;

// The JSON routes of docs/HTTP-API.md, on the hub's thread: each is a short look at the hub, or a
// change of it. Knows no HTTP but methods, paths and status numbers.
class Api {
 public:
  struct Parts {
    std::uint64_t session = 0;
    Time started{0};
    const Metrics* metrics = nullptr;
    PictureSource* pictures = nullptr;  // null: nothing is drawn
    bool wants_pictures = false;        // a daemon that was asked to draw
    std::string renderer;               // what draws, for people
    Player* player = nullptr;           // null: nothing plays
    std::function<int()> connections;   // of the web side
    std::function<int()> viewers;
  };
  explicit Api(Parts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] ApiReply Answer(const ApiRequest& request, Hub& hub, Time now);

 private:
  // What a capture changed, so that it can be taken back.
  struct Capture {
    std::string pose;                           // "neutral", or the reference pose's name
    std::string subject;                        // whose neutral it was
    std::uint64_t skeleton_hash = 0;            // its skeleton then
    std::optional<wrinkle::LocalPose> neutral;  // before
    std::shared_ptr<const wrinkle::Rig> rig;    // before; null: a neutral was captured
  };
  struct Route;

  ApiReply Subjects(const ApiRequest& request, Hub& hub, Time now);
  ApiReply ShowStatus(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Settings(const ApiRequest& request, Hub& hub, Time now);
  ApiReply PatchSettings(const ApiRequest& request, Hub& hub, Time now);
  ApiReply SettingsFile(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Cameras(const ApiRequest& request, Hub& hub, Time now);
  ApiReply ShowRig(const ApiRequest& request, Hub& hub, Time now);
  ApiReply RigFile(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Explain(const ApiRequest& request, Hub& hub, Time now);
  ApiReply PostCapture(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Undo(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Playback(const ApiRequest& request, Hub& hub, Time now);
  ApiReply PatchPlayback(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Health(const ApiRequest& request, Hub& hub, Time now);
  ApiReply Ready(const ApiRequest& request, Hub& hub, Time now);
  ApiReply MetricsText(const ApiRequest& request, Hub& hub, Time now);

  ApiReply CaptureNeutral(Hub& hub, Subject& subject, bool preview, Time now);
  ApiReply CapturePose(Hub& hub, Subject& subject, const std::string& pose, bool preview, Time now);
  // The oldest is forgotten where there are too many to undo.
  void Remember(Capture capture);
  [[nodiscard]] Json Captures() const;

  Parts parts_;
  std::vector<Capture> captures_;  // the newest last
};

// 200 with a document. Text that is not UTF-8 is shown with replacement characters.
[[nodiscard]] ApiReply JsonReply(const Json& json);
// The object that a request's body holds. Errors: kParse, kSchema.
[[nodiscard]] Result<Json> ObjectOf(const ApiRequest& request);
// 404, naming who is there.
[[nodiscard]] ApiReply NoSuchSubject(const Hub& hub, std::string_view name);

}  // namespace furrow::server
