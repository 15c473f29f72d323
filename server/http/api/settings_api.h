// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/pipeline/picture_source.h"
#include "server/session/hub.h"

namespace furrow::server {

// Shows and changes what pictures look like: /api/settings, /api/settings.toml and /api/cameras.
class SettingsApi {
 public:
  // `pictures`: null if the daemon renders nothing.
  explicit SettingsApi(PictureSource* pictures) : pictures_(pictures) {}

  [[nodiscard]] ApiReply Settings(const Hub& hub) const;
  [[nodiscard]] ApiReply SettingsFile(const Hub& hub) const;
  // Changes all settings in the body, or none if one is invalid.
  [[nodiscard]] ApiReply PatchSettings(const ApiRequest& request, Hub& hub, Time now);
  [[nodiscard]] ApiReply Cameras() const;

 private:
  PictureSource* const pictures_;
};

}  // namespace furrow::server
