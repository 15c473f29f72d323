// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/api.h"

#include <utility>

namespace furrow::server {

Api::Api(Parts parts)
    : status_({.session = parts.session,
               .started = parts.started,
               .metrics = parts.metrics,
               .renders = parts.pictures != nullptr,
               .wants_pictures = parts.wants_pictures,
               .plays = parts.player != nullptr,
               .renderer = std::move(parts.renderer),
               .connections = std::move(parts.connections),
               .viewers = std::move(parts.viewers),
               .recording_is_paused = std::move(parts.recording_is_paused)}),
      settings_(parts.pictures),
      rig_(&captures_),
      playback_(parts.player),
      osc_(parts.osc),
      routes_{
          {"GET", "/api/subjects",
           [this](const ApiRequest&, Hub& hub, Time now) { return status_.Subjects(hub, now); }},
          {"GET", "/api/status",
           [this](const ApiRequest&, Hub& hub, Time now) { return status_.ShowStatus(hub, now); }},
          {"GET", "/api/settings",
           [this](const ApiRequest&, Hub& hub, Time) { return settings_.Settings(hub); }},
          {"PATCH", "/api/settings",
           [this](const ApiRequest& request, Hub& hub, Time now) {
             return settings_.PatchSettings(request, hub, now);
           }},
          {"GET", "/api/settings.toml",
           [this](const ApiRequest&, Hub& hub, Time) { return settings_.SettingsFile(hub); }},
          {"GET", "/api/cameras",
           [this](const ApiRequest&, Hub&, Time) { return settings_.Cameras(); }},
          {"GET", "/api/rig",
           [this](const ApiRequest&, Hub& hub, Time) { return rig_.ShowRig(hub); }},
          {"GET", "/api/rig.json",
           [this](const ApiRequest&, Hub& hub, Time) { return rig_.RigFile(hub); }},
          {"GET", "/api/explain",
           [this](const ApiRequest& request, Hub& hub, Time) {
             return rig_.Explain(request, hub);
           }},
          {"POST", "/api/capture",
           [this](const ApiRequest& request, Hub& hub, Time now) {
             return captures_.PostCapture(request, hub, now);
           }},
          {"POST", "/api/capture/undo",
           [this](const ApiRequest&, Hub& hub, Time now) { return captures_.Undo(hub, now); }},
          {"GET", "/api/playback",
           [this](const ApiRequest&, Hub&, Time now) { return playback_.Show(now); }},
          {"PATCH", "/api/playback",
           [this](const ApiRequest& request, Hub&, Time now) {
             return playback_.Patch(request, now);
           }},
          {"GET", "/api/osc", [this](const ApiRequest&, Hub&, Time) { return osc_.List(); }},
          {"POST", "/api/osc",
           [this](const ApiRequest& request, Hub&, Time) { return osc_.Add(request); }},
          {"DELETE", "/api/osc",
           [this](const ApiRequest& request, Hub&, Time) { return osc_.Remove(request); }},
          {"GET", "/healthz", [this](const ApiRequest&, Hub&, Time) { return status_.Health(); }},
          {"GET", "/readyz",
           [this](const ApiRequest&, Hub& hub, Time) { return status_.Ready(hub); }},
          {"GET", "/metrics",
           [this](const ApiRequest&, Hub& hub, Time) { return status_.MetricsText(hub); }}} {}

ApiReply Api::Answer(const ApiRequest& request, Hub& hub, Time now) {
  // Collects the methods of a path while it looks for the right one: RFC 9110 requires Allow with
  // 405.
  std::string allowed;
  // Few routes, so a search is fast enough.
  for (const Route& route : routes_) {
    if (route.path != request.url.path) continue;
    if (route.method == request.method) return route.answer(request, hub, now);
    allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
    if (route.method == "GET") allowed += ", HEAD";
  }
  if (!allowed.empty()) return MethodReply(request.method, request.url.path, std::move(allowed));
  return ErrorReply(404, "not_found", "", request.url.path + " does not exist");
}

}  // namespace furrow::server
