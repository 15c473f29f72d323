// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/trace_api.h"

#include <string>

#include <nlohmann/json.hpp>

#include "server/http/metrics/trace_json.h"
#include "server/http/request/json_reply.h"
#include "server/net/clock.h"

namespace furrow::server {
ApiReply TraceApi::Request(const ApiRequest& request, Hub& hub) const {
  const std::string name(request.url.Value("subject"));
  const Subject* subject = hub.Trace(name, request.access);
  if (subject == nullptr) return NoSuchSubject(hub, name, request.access);
  ApiReply reply = JsonReply({{"subject", subject->name}});
  reply.status = 202;
  return reply;
}

ApiReply TraceApi::Show(const ApiRequest& request, const Hub& hub, Time now) const {
  const PoseTracer* tracer = hub.tracer();
  const bool is_known = tracer != nullptr && tracer->state() != PoseTracer::State::kNone &&
                        request.access.Concerns(tracer->trace().subject);
  if (!is_known) {
    return ErrorReply(404, "not_found", "", "no pose has been traced",
                      "POST /api/trace?subject=NAME traces the next one");
  }
  if (tracer->state() == PoseTracer::State::kWaiting) {
    return ErrorReply(503, "unavailable", "subject",
                      "no pose of '" + tracer->trace().subject + "' has arrived since",
                      "ask again, or look at the subject's state in /api/subjects");
  }
  return JsonReply(ToOtlp(tracer->trace(), {now, ReadUnixClock()}, session_));
}

}  // namespace furrow::server
