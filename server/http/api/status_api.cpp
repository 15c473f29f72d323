// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/status_api.h"

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>
#include <spdlog/fmt/fmt.h>

#include "server/http/metrics/metric_families.h"
#include "server/http/request/json_reply.h"
#include "server/http/request/stream_json.h"

namespace furrow::server {

using prometheus::MetricFamily;
using prometheus::MetricType;

namespace {

// In order of precedence: a subject that said goodbye may be lost, too.
std::string_view StateOf(const Subject& subject) {
  if (subject.ended) return "ended";
  if (subject.no_face) return "no_face";
  if (!subject.pipeline->has_pose()) return "waiting";
  return subject.lost ? "lost" : "live";
}

// Null: nobody watches, so nobody has looked whether the subject moves.
Json MovedMs(const Subject& subject, Time now) {
  const Time moved = subject.rest.moved_at();
  return moved == Time{0} ? Json() : Json(ToSeconds(now - moved) * 1e3);
}

// Null: nothing is being drawn.
Json DrawingJson(const PictureSource* pictures) {
  const auto drawing = pictures == nullptr ? std::nullopt : pictures->drawing();
  return drawing ? Json{{"done", drawing->done}, {"passes", drawing->passes}} : Json();
}

// Null: the daemon draws nothing.
Json VideoJson(const VideoEncoders* video) {
  if (video == nullptr) return Json();
  const VideoEncoders::State state = video->state();
  return {{"library", state.library},
          {"encoders", state.encoders},
          {"max_encoders", state.max_encoders},
          {"why", state.why}};
}

}  // namespace

ApiReply StatusApi::Subjects(const ApiRequest& request, Hub& hub, Time now) const {
  Json list = Json::array();
  for (const auto& subject : hub.subjects().all()) {
    if (!request.access.Concerns(subject->name)) continue;
    const SubjectPipeline& pipeline = *subject->pipeline;
    Json entry = StreamJson(*subject, hub, now);
    entry.update({{"state", StateOf(*subject)},
                  {"skeleton", fmt::format("{:016x}", subject->skeleton_hash)},
                  {"sequence", pipeline.sequence()},
                  {"buffer_ms", ToSeconds(subject->hold) * 1e3},
                  {"moved_ms", MovedMs(*subject, now)},
                  {"neutral", pipeline.neutral_pose().has_value()}});
    list.push_back(std::move(entry));
  }
  return JsonReply({{"subjects", std::move(list)}});
}

ApiReply StatusApi::ShowStatus(const ApiRequest& request, const Hub& hub, Time now) const {
  const auto may = [&request](Role role) { return request.access.Has(role); };
  return JsonReply({{"version", FURROW_VERSION},
                    {"session", fmt::format("{:016x}", parts_.session)},
                    {"uptime_s", ToSeconds(now - parts_.started)},
                    {"render", parts_.pictures != nullptr},
                    {"renderer", parts_.pictures == nullptr ? "" : parts_.pictures->description()},
                    {"software", parts_.pictures != nullptr && parts_.pictures->is_software()},
                    {"starting", parts_.pictures != nullptr && parts_.pictures->is_starting()},
                    {"drawing", DrawingJson(parts_.pictures)},
                    {"video", VideoJson(parts_.video)},
                    {"viewers", parts_.viewers()},
                    {"subscriptions", hub.num_subscriptions()},
                    {"subjects", hub.num_subjects()},
                    {"pictures_rendered", parts_.metrics->Get(Counter::kPicturesRendered)},
                    {"pictures_encoded", parts_.metrics->Get(Counter::kPicturesEncoded)},
                    {"pictures_dropped", parts_.metrics->Get(Counter::kPicturesDroppedSlow)},
                    {"playback", parts_.playback->player() != nullptr},
                    {"max_upload_bytes", parts_.max_upload_bytes()},
                    {"draining", hub.draining()},
                    {"open", parts_.open_to_network},
                    {"may",
                     {{"publish", may(Role::kPublish)},
                      {"watch", may(Role::kWatch)},
                      {"direct", may(Role::kDirect)},
                      {"operate", may(Role::kOperate)}}}});
}

ApiReply StatusApi::Health() const { return JsonReply({{"ok", true}}); }

ApiReply StatusApi::Ready(const Hub& hub, Time now) const {
  if (hub.draining()) return ErrorReply(503, "unavailable", "", "the daemon is shutting down");
  if (parts_.wants_pictures && parts_.pictures == nullptr) {
    return ErrorReply(503, "unavailable", "",
                      "no renderer could start: pictures are off, weights go on; see the log");
  }
  if (parts_.pictures != nullptr && parts_.pictures->is_stuck()) {
    return ErrorReply(503, "unavailable", "",
                      parts_.pictures->fault() + ": pictures are off, weights go on; see the log");
  }
  if (parts_.recording_is_paused && parts_.recording_is_paused()) {
    return ErrorReply(503, "unavailable", "",
                      "the recording is paused, because its folder cannot be written; see the log");
  }
  if (parts_.cluster != nullptr) {
    if (const std::string fault = parts_.cluster->Fault(now); !fault.empty()) {
      return ErrorReply(503, "unavailable", "",
                        fault + ": sessions go on, and nothing new is placed");
    }
  }
  return JsonReply({{"ok", true}});
}

ApiReply StatusApi::MetricsText(const Hub& hub, Time now) const {
  std::vector<MetricFamily> families;
  AddCounters(*parts_.metrics, &families);
  AddTimings(parts_.metrics->timings(), &families);
  AddProcess(ToSeconds(now - parts_.started), &families);
  const auto add_gauge = [&families](std::string_view name, std::string_view help, double value) {
    families.push_back(Family(name, help, MetricType::Gauge, value));
  };
  add_gauge("furrow_subjects", "Subjects that stream, or have stopped and decay.",
            static_cast<double>(hub.num_subjects()));
  add_gauge("furrow_subscriptions", "Active subscriptions of all peers.",
            static_cast<double>(hub.num_subscriptions()));
  add_gauge("furrow_http_connections", "Open connections of the web port.",
            static_cast<double>(parts_.connections()));
  add_gauge("furrow_http_viewers", "Open WebSockets and picture streams.",
            static_cast<double>(parts_.viewers()));
  if (parts_.waiting != nullptr) {
    add_gauge("furrow_waiting_bytes",
              "What waits for TCP and web clients that read slowly, beyond what is free for each.",
              static_cast<double>(parts_.waiting->taken()));
  }
  if (parts_.video != nullptr) {
    add_gauge("furrow_video_encoders", "Viewers that have an H.264 encoder.",
              static_cast<double>(parts_.video->state().encoders));
  }
  add_gauge("furrow_ready", "1 while /readyz replies with 200, otherwise 0.",
            Ready(hub, now).status == 200 ? 1.0 : 0.0);
  add_gauge(
      "furrow_renderer_running", "1 while a renderer runs and responds, otherwise 0.",
      parts_.pictures != nullptr && !parts_.pictures->is_stuck() && !parts_.pictures->is_starting()
          ? 1.0
          : 0.0);
  add_gauge("furrow_renderer_wanted", "1 if the configuration asks for pictures, otherwise 0.",
            parts_.wants_pictures ? 1.0 : 0.0);
  add_gauge("furrow_recording_paused",
            "1 while the disk has no room for the recording, otherwise 0.",
            parts_.recording_is_paused && parts_.recording_is_paused() ? 1.0 : 0.0);
  add_gauge("furrow_config_refused",
            "1 if the last reload left the configuration as it was, because the new one has a "
            "fault, otherwise 0.",
            parts_.config_is_refused && parts_.config_is_refused() ? 1.0 : 0.0);
  return {.type = "text/plain; version=0.0.4; charset=utf-8",
          .body = prometheus::TextSerializer().Serialize(families)};
}

}  // namespace furrow::server
