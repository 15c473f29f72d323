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

// How views are drawn: the daemon's own settings, and what a view says otherwise. Equal settings
// are one object while anybody has them, so that views are compared by pointer at every pose.
class ViewSettings {
 public:
  explicit ViewSettings(render::Settings own) : own_(std::move(own)) {}

  [[nodiscard]] const render::Settings& own() const { return own_; }
  // What was handed out stays as it is: ask again.
  void SetOwn(render::Settings own) { own_ = std::move(own); }

  // The own ones with `overrides`, each "name=value". Errors: render::SetSetting's.
  [[nodiscard]] Result<SharedSettings> Get(std::span<const std::string> overrides);

 private:
  render::Settings own_;
  std::map<std::string, std::weak_ptr<const render::Settings>> known_;  // by their TOML
};

}  // namespace furrow::server
