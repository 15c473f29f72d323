// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/api.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>
#include <spdlog/fmt/fmt.h>

namespace furrow::server {
namespace {

std::string_view StateOf(const Subject& subject) {
  if (subject.ended) return "ended";
  if (!subject.pipeline->has_pose()) return "waiting";
  return subject.lost ? "lost" : "live";
}

prometheus::MetricFamily Family(std::string_view name, prometheus::MetricType type, double value) {
  prometheus::MetricFamily family;
  family.name = name;
  family.help = type == prometheus::MetricType::Counter ? "Since the daemon started." : "Now.";
  family.type = type;
  prometheus::ClientMetric metric;
  if (type == prometheus::MetricType::Counter) {
    metric.counter.value = value;
  } else {
    metric.gauge.value = value;
  }
  family.metric.push_back(metric);
  return family;
}

}  // namespace

struct Api::Route {
  std::string_view method;
  std::string_view path;
  ApiReply (Api::*answer)(const ApiRequest&, Hub&, Time);
};

ApiReply Api::Answer(const ApiRequest& request, Hub& hub, Time now) {
  static constexpr std::array kRoutes = {
      Route{"GET", "/api/subjects", &Api::Subjects},
      Route{"GET", "/api/status", &Api::ShowStatus},
      Route{"GET", "/api/settings", &Api::Settings},
      Route{"PATCH", "/api/settings", &Api::PatchSettings},
      Route{"GET", "/api/settings.toml", &Api::SettingsFile},
      Route{"GET", "/api/cameras", &Api::Cameras},
      Route{"GET", "/api/rig", &Api::ShowRig},
      Route{"GET", "/api/rig.json", &Api::RigFile},
      Route{"GET", "/api/explain", &Api::Explain},
      Route{"POST", "/api/capture", &Api::PostCapture},
      Route{"POST", "/api/capture/undo", &Api::Undo},
      Route{"GET", "/api/playback", &Api::Playback},
      Route{"PATCH", "/api/playback", &Api::PatchPlayback},
      Route{"GET", "/healthz", &Api::Health},
      Route{"GET", "/readyz", &Api::Ready},
      Route{"GET", "/metrics", &Api::MetricsText},
  };
  std::string methods;
  for (const Route& route : kRoutes) {
    if (route.path != request.url.path) continue;
    if (route.method == request.method) return (this->*route.answer)(request, hub, now);
    methods += (methods.empty() ? "" : ", ") + std::string(route.method);
    if (route.method == "GET") methods += ", HEAD";
  }
  if (!methods.empty()) return MethodReply(request.method, request.url.path, std::move(methods));
  return ErrorReply(404, "not_found", "", request.url.path + " is not served here");
}

ApiReply JsonReply(const Json& json) {
  return {.body = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Result<Json> ObjectOf(const ApiRequest& request) {
  // Nothing that is asked for has a depth of its own, and what is copied is copied recursively.
  constexpr int kMaxDepth = 8;
  bool is_deep = false;
  const auto is_wanted = [&](int depth, Json::parse_event_t, const Json&) {
    is_deep = is_deep || depth > kMaxDepth;
    return !is_deep;
  };
  Json json = Json::parse(request.body, is_wanted, /*allow_exceptions=*/false);
  if (is_deep) return Status(StatusCode::kSchema, "the body is nested too deeply", "body");
  if (json.is_discarded()) return Status(StatusCode::kParse, "the body is no JSON", "body");
  if (!json.is_object()) return Status(StatusCode::kSchema, "the body is no JSON object", "body");
  return json;
}

ApiReply NoSuchSubject(const Hub& hub, std::string_view name) {
  const std::string known = hub.subjects().Names();
  return ErrorReply(404, "not_found", "subject",
                    name.empty() ? "there is no subject" : fmt::format("no subject '{}'", name),
                    known.empty() ? "none is here" : "here are: " + known);
}

ApiReply Api::Subjects(const ApiRequest&, Hub& hub, Time now) {
  Json list = Json::array();
  for (const auto& subject : hub.subjects().all()) {
    const SubjectPipeline& pipeline = *subject->pipeline;
    const SubjectStats& stats = subject->stats;
    list.push_back({{"name", subject->name},
                    {"state", StateOf(*subject)},
                    {"source", hub.SourceOf(*subject)},
                    {"skeleton", fmt::format("{:016x}", subject->skeleton_hash)},
                    {"joints", pipeline.stream().skeleton.num_joints()},
                    {"blend_shapes", pipeline.stream().blend_shapes.size()},
                    {"sequence", pipeline.sequence()},
                    {"rate_hz", stats.rate_hz(now)},
                    {"poses", stats.poses()},
                    {"lost", stats.lost()},
                    {"late", stats.late()},
                    {"jitter_ms", stats.jitter_seconds(now) * 1e3},
                    {"age_ms", ToSeconds(now - subject->last_pose) * 1e3},
                    {"neutral", pipeline.neutral_pose().has_value()}});
  }
  return JsonReply({{"subjects", std::move(list)}});
}

ApiReply Api::ShowStatus(const ApiRequest&, Hub& hub, Time now) {
  return JsonReply({{"version", FURROW_VERSION},
                    {"session", fmt::format("{:016x}", parts_.session)},
                    {"uptime_s", ToSeconds(now - parts_.started)},
                    {"render", parts_.pictures != nullptr},
                    {"renderer", parts_.renderer},
                    {"viewers", parts_.viewers()},
                    {"subscriptions", hub.num_subscriptions()},
                    {"subjects", hub.num_subjects()},
                    {"pictures_rendered", parts_.metrics->Get(Counter::kPicturesRendered)},
                    {"pictures_encoded", parts_.metrics->Get(Counter::kPicturesEncoded)},
                    {"pictures_dropped", parts_.metrics->Get(Counter::kPicturesDroppedSlow)},
                    {"playback", parts_.player != nullptr},
                    {"draining", hub.draining()}});
}

// That it answers at all is the point: the hub's loop turns.
ApiReply Api::Health(const ApiRequest&, Hub&, Time) { return JsonReply({{"ok", true}}); }

ApiReply Api::Ready(const ApiRequest&, Hub& hub, Time) {
  if (hub.draining()) return ErrorReply(503, "unavailable", "", "the daemon is shutting down");
  if (parts_.wants_pictures && parts_.pictures == nullptr) {
    return ErrorReply(503, "unavailable", "", "pictures are asked for and cannot be drawn");
  }
  return JsonReply({{"ok", true}});
}

ApiReply Api::MetricsText(const ApiRequest&, Hub& hub, Time) {
  using prometheus::MetricType;
  std::vector<prometheus::MetricFamily> families;
  for (int i = 0; i < static_cast<int>(Counter::kCount); ++i) {
    const auto counter = static_cast<Counter>(i);
    families.push_back(Family(CounterName(counter), MetricType::Counter,
                              static_cast<double>(parts_.metrics->Get(counter))));
  }
  const std::pair<std::string_view, double> gauges[] = {
      {"furrow_subjects", static_cast<double>(hub.num_subjects())},
      {"furrow_subscriptions", static_cast<double>(hub.num_subscriptions())},
      {"furrow_http_connections", static_cast<double>(parts_.connections())},
      {"furrow_http_viewers", static_cast<double>(parts_.viewers())}};
  for (const auto& [name, value] : gauges) {
    families.push_back(Family(name, MetricType::Gauge, value));
  }
  return {.type = "text/plain; version=0.0.4; charset=utf-8",
          .body = prometheus::TextSerializer().Serialize(families)};
}

}  // namespace furrow::server
