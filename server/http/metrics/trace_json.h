// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include "server/core/time.h"
#include "server/session/trace/pose_trace.h"

namespace furrow::server {

// What turns the daemon's clock into that of the world.
struct TraceClock {
  Time now{0};       // on the daemon's clock
  Time unix_now{0};  // the same moment, since 1970
};

// The trace as OTLP/JSON (OpenTelemetry protocol 1.x, ExportTraceServiceRequest): a span "pose"
// with its stages, and a span "picture" with those of the first picture that shows it. `session`:
// of the daemon. Equal arguments give equal ids.
[[nodiscard]] nlohmann::ordered_json ToOtlp(const PoseTrace& trace, const TraceClock& clock,
                                            std::uint64_t session);

}  // namespace furrow::server
