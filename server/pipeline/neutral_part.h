// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "server/pipeline/stream_definition.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::server {

// The part of a performer whose neutral pose is captured.
enum class NeutralPart {
  kFace,  // the joints below the head, eyes and jaw, and all blend shapes
  kBody,  // all other joints
  kBoth,
};

// One entry per joint of the stream: true for joints of kFace. Without roles, no joint is known to
// be of the face.
[[nodiscard]] std::vector<bool> FaceJoints(const StreamDefinition& stream);

// "face", "body" or "both"; nullopt for any other text.
[[nodiscard]] std::optional<NeutralPart> ParseNeutralPart(std::string_view text);
[[nodiscard]] std::string_view ToString(NeutralPart part);

// The part that a capture means if nobody says so: the face of streams that have one, since people
// relax their face with their arms in any position; else both.
[[nodiscard]] NeutralPart DefaultNeutralPart(const StreamDefinition& stream);

// The neutral pose after a capture of `part` from `now`. Other parts keep `former`, or the rest
// pose and blend shapes at 0 if there is none. Poses must fit the stream.
[[nodiscard]] wrinkle::LocalPose CaptureNeutralPart(
    NeutralPart part, const StreamDefinition& stream, const wrinkle::LocalPose& now,
    const std::optional<wrinkle::LocalPose>& former);

}  // namespace furrow::server
