// SPDX-License-Identifier: Apache-2.0
// The part of Api that concerns pictures: the renderer's settings and camera presets.
#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "render/settings/settings_file.h"
#include "server/http/api/api.h"
#include "server/http/api/setting_json.h"

namespace furrow::server {

ApiReply Api::Settings(const ApiRequest&, Hub& hub, Time) {
  Json list = Json::array();
  for (const render::SettingInfo& info : render::AllSettings()) {
    list.push_back(SettingJson(info, render::GetSetting(info.name, hub.own_settings())));
  }
  return JsonReply({{"settings", std::move(list)}});
}

ApiReply Api::SettingsFile(const ApiRequest&, Hub& hub, Time) {
  return {.type = "application/toml",
          .body = render::SettingsToToml(hub.own_settings()),
          .file_name = "look.toml"};
}

ApiReply Api::PatchSettings(const ApiRequest& request, Hub& hub, Time now) {
  const Result<Json> object = ObjectOf(request);
  if (!object.ok()) return ErrorReply(object.status());
  render::Settings settings = hub.own_settings();
  for (const auto& [name, value] : object->items()) {
    const Result<std::string> text = SettingText(name, value);
    if (!text.ok()) return ErrorReply(text.status());
    if (Status status = render::SetSetting(name, *text, &settings); !status.ok()) {
      // Not there is the request's fault here, not the address's.
      return ErrorReply(400, "invalid_argument", name, status.what(), status.todo());
    }
  }
  if (Status status = render::CheckSettings(settings); !status.ok()) return ErrorReply(status);
  hub.SetOwnSettings(settings, now);
  return Settings(request, hub, now);
}

ApiReply Api::Cameras(const ApiRequest&, Hub&, Time) {
  if (parts_.pictures == nullptr) {
    return ErrorReply(503, "unavailable", "", "this daemon draws no pictures");
  }
  Json list = Json::array();
  for (const std::string_view name : render::CameraPresetNames()) {
    const Result<render::Camera> camera = parts_.pictures->Preset(name);
    if (!camera.ok()) continue;
    const glm::vec3& eye = camera->position;
    const glm::vec3& target = camera->target;
    list.push_back({{"name", name},
                    {"eye", {eye.x, eye.y, eye.z}},
                    {"target", {target.x, target.y, target.z}},
                    {"fov_degrees", camera->fov_y_degrees},
                    {"follows", camera->follow_joint >= 0}});
  }
  return JsonReply({{"cameras", std::move(list)}});
}

}  // namespace furrow::server
