// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/api.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "server/http/pictures/picture_replies.h"

namespace furrow::server {

Api::Api(Parts parts)
    : metrics_(parts.metrics),
      status_({.session = parts.session,
               .started = parts.started,
               .metrics = parts.metrics,
               .wants_pictures = parts.wants_pictures,
               .pictures = parts.pictures,
               .video = parts.video,
               .playback = parts.playback,
               .max_upload_bytes = std::move(parts.max_upload_bytes),
               .connections = std::move(parts.connections),
               .viewers = std::move(parts.viewers),
               .recording_is_paused = std::move(parts.recording_is_paused),
               .config_is_refused = std::move(parts.config_is_refused),
               .waiting = parts.waiting,
               .open_to_network = parts.open_to_network,
               .cluster = parts.cluster}),
      settings_(parts.pictures),
      rig_(&captures_),
      playback_(parts.playback),
      osc_(parts.osc),
      tokens_(parts.gate, parts.metrics),
      cluster_(parts.cluster, &tokens_),
      sources_(std::move(parts.sources)),
      traces_(parts.session),
      routes_(AllRoutes()) {}

std::vector<Api::Route> Api::StatusRoutes() {
  return {
      {"GET", "/api/subjects", Need::kToken,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return status_.Subjects(request, hub, now);
       }},
      {"GET", "/api/status", Need::kToken,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return status_.ShowStatus(request, hub, now);
       }},
      {"GET", "/api/sources", Need::kToken,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return sources_.Show(request, hub, now);
       }},
      {"POST", "/api/sources", Need::kDirect,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return sources_.Accept(request, hub, now);
       }},
      {"GET", "/healthz", Need::kNothing,
       [this](const ApiRequest&, Hub&, Time) { return status_.Health(); }},
      {"GET", "/readyz", Need::kNothing,
       [this](const ApiRequest&, Hub& hub, Time now) { return status_.Ready(hub, now); }},
      {"GET", "/metrics", Need::kOperate,
       [this](const ApiRequest&, Hub& hub, Time now) { return status_.MetricsText(hub, now); }},
  };
}

std::vector<Api::Route> Api::LookRoutes() {
  return {
      {"GET", "/api/settings", Need::kToken,
       [this](const ApiRequest&, Hub& hub, Time) { return settings_.Settings(hub); }},
      {"PATCH", "/api/settings", Need::kDirect,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return settings_.PatchSettings(request, hub, now);
       }},
      {"GET", "/api/settings.toml", Need::kToken,
       [this](const ApiRequest&, Hub& hub, Time) { return settings_.SettingsFile(hub); }},
      {"GET", "/api/cameras", Need::kToken,
       [this](const ApiRequest&, Hub&, Time) { return settings_.Cameras(); }},
      {"GET", "/api/rig", Need::kToken,
       [this](const ApiRequest&, Hub& hub, Time) { return rig_.ShowRig(hub); }},
      {"GET", "/api/rig.json", Need::kToken,
       [this](const ApiRequest&, Hub& hub, Time) { return rig_.RigFile(hub); }},
      {"GET", "/api/explain", Need::kWatch,
       [this](const ApiRequest& request, Hub& hub, Time) { return rig_.Explain(request, hub); }},
      {"POST", "/api/capture", Need::kDirect,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return captures_.PostCapture(request, hub, now);
       }},
      {"POST", "/api/capture/undo", Need::kDirect,
       [this](const ApiRequest&, Hub& hub, Time now) { return captures_.Undo(hub, now); }},
      {"HEAD", "/mjpeg", Need::kToken, HeadOfPictures},
      {"HEAD", "/snapshot.png", Need::kToken, HeadOfPictures},
  };
}

std::vector<Api::Route> Api::PlaybackRoutes() {
  return {
      {"GET", "/api/playback", Need::kToken,
       [this](const ApiRequest&, Hub&, Time now) { return playback_.Show(now); }},
      {"PATCH", "/api/playback", Need::kDirect,
       [this](const ApiRequest& request, Hub&, Time now) { return playback_.Patch(request, now); }},
      {"POST", "/api/playback", Need::kDirect,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return playback_.Play(request, hub, now);
       }},
      {"DELETE", "/api/playback", Need::kDirect,
       [this](const ApiRequest&, Hub&, Time now) { return playback_.Close(now); }},
  };
}

std::vector<Api::Route> Api::OperatorRoutes() {
  return {
      {"GET", "/api/osc", Need::kOperate,
       [this](const ApiRequest&, Hub&, Time) { return osc_.List(); }},
      {"POST", "/api/osc", Need::kOperate,
       [this](const ApiRequest& request, Hub&, Time) { return osc_.Add(request); }},
      {"DELETE", "/api/osc", Need::kOperate,
       [this](const ApiRequest& request, Hub&, Time) { return osc_.Remove(request); }},
      {"POST", "/api/token", Need::kOperate,
       [this](const ApiRequest& request, Hub&, Time now) { return tokens_.Make(request, now); }},
      {"POST", "/api/trace", Need::kOperate,
       [this](const ApiRequest& request, Hub& hub, Time) { return traces_.Request(request, hub); }},
      {"GET", "/api/trace", Need::kOperate,
       [this](const ApiRequest& request, Hub& hub, Time now) {
         return traces_.Show(request, hub, now);
       }},
      {"GET", "/api/place", Need::kToken,
       [this](const ApiRequest& request, Hub&, Time now) {
         return cluster_.FindPlace(request, now);
       }},
      {"GET", "/api/cluster", Need::kOperate,
       [this](const ApiRequest&, Hub&, Time now) { return cluster_.Show(now); }},
  };
}

std::vector<Api::Route> Api::AllRoutes() {
  std::vector<Route> all;
  for (auto part : {StatusRoutes(), LookRoutes(), PlaybackRoutes(), OperatorRoutes()}) {
    std::ranges::move(part, std::back_inserter(all));
  }
  return all;
}

bool Api::Permits(Need need, const Access& access) {
  switch (need) {
    case Need::kNothing: return true;
    case Need::kToken: return access.admitted();
    case Need::kWatch: return access.Has(Role::kWatch);
    case Need::kDirect: return access.Has(Role::kDirect);
    case Need::kOperate: return access.Has(Role::kOperate);
  }
  return false;
}

ApiReply Api::Forbid(Need need, const ApiRequest& request) {
  const bool directs = need == Need::kDirect;
  const Counter counter = directs                ? Counter::kRefusedDirect
                          : need == Need::kWatch ? Counter::kRefusedWatch
                                                 : Counter::kRefusedOperate;
  metrics_->Add(counter);
  const char* const role = directs ? "direct" : need == Need::kWatch ? "watch" : "operate";
  return NeedsRole(role, request.url.path, request.access);
}

ApiReply Api::Answer(const ApiRequest& request, Hub& hub, Time now) {
  // Collects the methods of a path while it looks for the right one: RFC 9110 requires Allow with
  // 405.
  std::string allowed;
  // Few routes, so a search is fast enough.
  for (const Route& route : routes_) {
    if (route.path != request.url.path) continue;
    if (route.method == request.method) {
      if (Permits(route.need, request.access)) return route.answer(request, hub, now);
      return Forbid(route.need, request);
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
    if (route.method == "GET") allowed += ", HEAD";
  }
  if (!allowed.empty()) return MethodReply(request.method, request.url.path, std::move(allowed));
  return ErrorReply(404, "not_found", "", request.url.path + " does not exist");
}

}  // namespace furrow::server
