// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/stream_json.h"

#include <optional>

#include <nlohmann/json.hpp>

#include "base/time/timecode.h"

namespace furrow::server {
namespace {

// Such as "10:00:00;00".
Json TimecodeJson(const std::optional<Timecode>& timecode) {
  return timecode ? Json(TimecodeText(*timecode)) : Json();
}

// Frames per second.
Json TimecodeRateJson(const std::optional<Timecode>& timecode) {
  return timecode ? Json(static_cast<double>(timecode->rate_numerator) / timecode->rate_denominator)
                  : Json();
}

}  // namespace

Json StreamJson(const Subject& subject, Hub& hub, Time now) {
  const StreamDefinition& stream = subject.pipeline->stream();
  const SubjectStats& stats = subject.stats;
  return {{"name", subject.name},
          {"source", hub.SourceOf(subject)},
          {"joints", stream.skeleton.num_joints()},
          {"blend_shapes", stream.blend_shapes.size()},
          {"rate_hz", stats.rate_hz(now)},
          {"poses", stats.poses()},
          {"lost", stats.lost()},
          {"late", stats.late()},
          {"jitter_ms", stats.jitter_seconds(now) * 1e3},
          {"age_ms", ToSeconds(now - subject.last_pose) * 1e3},
          {"timecode", TimecodeJson(subject.timecode)},
          {"timecode_rate_hz", TimecodeRateJson(subject.timecode)}};
}

}  // namespace furrow::server
