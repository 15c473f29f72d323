// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/settings_api.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "render/settings/settings_file.h"
#include "server/http/api/setting_json.h"
#include "server/http/request/json_reply.h"
#include "server/session/subscriptions/view_settings.h"

namespace furrow::server {

ApiReply SettingsApi::Settings(const Hub& hub) const {
  Json list = Json::array();
  const render::Settings defaults = DefaultSettings();
  for (const render::SettingInfo& info : render::AllSettings()) {
    list.push_back(SettingJson(info, render::GetSetting(info.name, hub.own_settings()),
                               render::GetSetting(info.name, defaults)));
  }
  return JsonReply({{"settings", std::move(list)}});
}

ApiReply SettingsApi::SettingsFile(const Hub& hub) const {
  return {.type = "application/toml",
          .body = render::SettingsToToml(hub.own_settings()),
          .file_name = "look.toml"};
}

ApiReply SettingsApi::PatchSettings(const ApiRequest& request, Hub& hub, Time now) {
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  // A copy that replaces the settings only if all values are valid.
  render::Settings settings = hub.own_settings();
  for (const auto& [name, value] : object->items()) {
    const Result<std::string> text = SettingText(name, value);
    if (!text.ok()) return ErrorReply(text.status());
    if (Status status = render::SetSetting(name, *text, &settings); !status.ok()) {
      // An unknown setting is an error of the body, not of the URL: 400 instead of 404.
      return ErrorReply(400, "invalid_argument", name, status.what(), status.todo());
    }
  }
  // SetSetting() parses; this checks the ranges of all of them.
  if (Status status = render::CheckSettings(settings); !status.ok()) return ErrorReply(status);
  hub.SetOwnSettings(settings, now);
  return Settings(hub);
}

ApiReply SettingsApi::Cameras() const {
  if (pictures_ == nullptr) return NotOfferedReply("this daemon renders no pictures");
  Json list = Json::array();
  for (const std::string_view name : render::CameraPresetNames()) {
    const Result<render::Camera> camera = pictures_->Preset(name);
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
