// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/http/request/json_reply.h"
#include "server/pipeline/neutral_part.h"
#include "server/session/hub.h"

namespace furrow::server {

// Captures the live pose of a subject as its neutral pose or as a reference pose of the rig, and
// undoes captures: POST /api/capture and /api/capture/undo.
class CaptureApi {
 public:
  // Both require the hub's exclusive lock. After an error reply nothing has changed.
  [[nodiscard]] ApiReply PostCapture(const ApiRequest& request, Hub& hub, Time now);
  [[nodiscard]] ApiReply Undo(Hub& hub, Time now);

  // The captures that Undo() can revert, oldest first, as JSON. Those before captures that came
  // from another node cannot be undone: that would remove the others, too. Nor can those before
  // another rig was read from its file.
  [[nodiscard]] Json History(const Hub& hub) const;

 private:
  struct Capture {
    std::string pose;                           // "neutral", or the name of the reference pose
    std::string subject;                        // the captured subject
    std::uint64_t skeleton_hash = 0;            // its skeleton at the time
    std::optional<wrinkle::LocalPose> neutral;  // the neutral pose before
    std::shared_ptr<const wrinkle::Rig> rig;    // the rig before; null: a neutral was captured
    bool added = false;                         // the rig had no such reference pose before
    std::uint64_t replacements = 0;             // Hub::num_rig_replacements() at the time
  };

  // `wanted`: empty for DefaultNeutralPart().
  [[nodiscard]] ApiReply CaptureNeutral(Hub& hub, Subject& subject,
                                        std::optional<NeutralPart> wanted, bool preview, Time now);
  [[nodiscard]] ApiReply CapturePose(Hub& hub, Subject& subject, const std::string& pose,
                                     bool preview, Time now);
  void Remember(Capture capture);
  void Forget(const Capture& last, Hub& hub);

  std::vector<Capture> captures_;  // newest last
};

}  // namespace furrow::server
