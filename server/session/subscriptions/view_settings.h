// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>

#include "base/status.h"
#include "render/settings/settings.h"

namespace furrow::server {

using SharedSettings = std::shared_ptr<const render::Settings>;

// The settings that a daemon starts with: the renderer's own, but with skin shading, because its
// viewers look at faces.
[[nodiscard]] render::Settings DefaultSettings();

// The settings of picture views: the daemon's own settings plus each view's overrides. Equal
// settings share one object while it is in use, so that comparing two views compares pointers.
class ViewSettings {
 public:
  explicit ViewSettings(render::Settings own) : own_(std::move(own)) {}

  [[nodiscard]] const render::Settings& own() const { return own_; }
  // Settings returned by Get() before do not change; call Get() again.
  void SetOwn(render::Settings own) { own_ = std::move(own); }

  // The daemon's settings with `overrides` applied, each "name=value". Errors: those of
  // render::SetSetting() and render::CheckSettings().
  [[nodiscard]] Result<SharedSettings> Get(std::span<const std::string> overrides);

 private:
  render::Settings own_;
  std::map<std::string, std::weak_ptr<const render::Settings>> known_;  // by their TOML text
};

}  // namespace furrow::server
