// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/pipeline/picture_source.h"
#include "server/session/hub.h"

namespace furrow::server {

// Shows and changes the settings of pictures: /api/settings, /api/settings.toml and /api/cameras.
// All functions with a Hub require its exclusive lock.
class SettingsApi {
 public:
  // `pictures`: null if the daemon renders nothing.
  explicit SettingsApi(PictureSource* pictures) : pictures_(pictures) {}

  // All settings as JSON, and as a TOML file to save.
  [[nodiscard]] ApiReply Settings(const Hub& hub) const;
  [[nodiscard]] ApiReply SettingsFile(const Hub& hub) const;
  // Changes all settings in the body, or none if one is invalid.
  [[nodiscard]] ApiReply PatchSettings(const ApiRequest& request, Hub& hub, Time now);
  // The camera presets of the character.
  [[nodiscard]] ApiReply Cameras() const;

 private:
  PictureSource* const pictures_;
};

}  // namespace furrow::server
