// SPDX-License-Identifier: Apache-2.0
#include "server/http/metrics/trace_json.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

namespace furrow::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kInternal = 1;  // SpanKind
constexpr int kServer = 2;

// The JSON of OTLP writes 64-bit numbers as texts.
Json Attribute(const char* key, std::uint64_t value) {
  return {{"key", key}, {"value", {{"intValue", std::to_string(value)}}}};
}
Json Attribute(const char* key, const std::string& value) {
  return {{"key", key}, {"value", {{"stringValue", value}}}};
}
Json Attribute(const char* key, double value) {
  return {{"key", key}, {"value", {{"doubleValue", value}}}};
}

class SpanList {
 public:
  SpanList(std::string trace, const TraceClock& clock) : trace_(std::move(trace)), clock_(clock) {}

  // Returns the id of the span. `parent`: empty for the first one.
  std::string Add(const std::string& parent, const char* name, Time begin, Time end,
                  Json attributes = Json::array()) {
    std::string id = fmt::format("{:016x}", spans_.size() + 1);
    Json span{{"traceId", trace_}, {"spanId", id}};
    if (!parent.empty()) span["parentSpanId"] = parent;
    span["name"] = name;
    span["kind"] = parent.empty() ? kServer : kInternal;
    span["startTimeUnixNano"] = UnixText(begin);
    span["endTimeUnixNano"] = UnixText(end);
    if (!attributes.empty()) span["attributes"] = std::move(attributes);
    spans_.push_back(std::move(span));
    return id;
  }
  [[nodiscard]] Json Take() { return std::move(spans_); }

 private:
  [[nodiscard]] std::string UnixText(Time time) const {
    return std::to_string((clock_.unix_now - (clock_.now - time)).count());
  }

  const std::string trace_;
  const TraceClock clock_;
  Json spans_ = Json::array();
};

void AddPicture(const PoseTrace::Picture& picture, const std::string& pose, SpanList* spans) {
  const std::string id =
      spans->Add(pose, "picture", picture.submitted, picture.sent,
                 {Attribute("furrow.sequence", std::uint64_t{picture.sequence}),
                  Attribute("furrow.width", static_cast<std::uint64_t>(picture.width)),
                  Attribute("furrow.height", static_cast<std::uint64_t>(picture.height)),
                  Attribute("furrow.bytes", std::uint64_t{picture.bytes}),
                  Attribute("furrow.viewers", std::uint64_t{picture.viewers}),
                  Attribute("furrow.format", std::string(picture.is_video ? "video" : "file"))});
  spans->Add(id, "wait for the renderer", picture.submitted, picture.taken);
  spans->Add(id, "draw", picture.taken, picture.drawn);
  spans->Add(id, "encode", picture.drawn, picture.encoded);
  spans->Add(id, "send", picture.encoded, picture.sent);
}

}  // namespace

Json ToOtlp(const PoseTrace& trace, const TraceClock& clock, std::uint64_t session) {
  const auto received = static_cast<std::uint64_t>(trace.received.count());
  SpanList spans(fmt::format("{:016x}{:016x}", session, received), clock);
  Json attributes{Attribute("furrow.subject", trace.subject),
                  Attribute("furrow.sequence", std::uint64_t{trace.sequence}),
                  Attribute("furrow.buffer_ms", ToSeconds(trace.buffered) * 1e3)};
  if (trace.late) attributes.push_back(Attribute("furrow.late_ms", ToSeconds(*trace.late) * 1e3));
  const std::string pose = spans.Add({}, "pose", trace.received, trace.sent, std::move(attributes));
  spans.Add(pose, "decode", trace.received, trace.accepted);
  spans.Add(pose, "wait for the batch", trace.accepted, trace.solving);
  spans.Add(pose, "solve", trace.solving, trace.solved,
            {Attribute("furrow.poses", std::uint64_t{trace.batch})});
  spans.Add(pose, "encode", trace.solved, trace.published);
  spans.Add(pose, "send", trace.published, trace.sent);
  if (trace.picture) AddPicture(*trace.picture, pose, &spans);
  const Json resource{{"attributes",
                       {Attribute("service.name", std::string("furrowd")),
                        Attribute("service.version", std::string(FURROW_VERSION)),
                        Attribute("service.instance.id", fmt::format("{:016x}", session))}}};
  return {
      {"resourceSpans", Json::array({{{"resource", resource},
                                      {"scopeSpans", Json::array({{{"scope", {{"name", "furrow"}}},
                                                                   {"spans", spans.Take()}}})}}})}};
}

}  // namespace furrow::server
