// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/view_settings.h"

#include <utility>

#include "base/status.h"
#include "render/settings/named_settings.h"
#include "render/settings/settings_file.h"

namespace furrow::server {

render::Settings DefaultSettings() {
  render::Settings settings;
  settings.shading = render::Shading::kSkin;
  return settings;
}

Result<SharedSettings> ViewSettings::Get(std::span<const std::string> overrides) {
  render::Settings settings = own_;
  for (const std::string& assignment : overrides) {
    FURROW_RETURN_IF_ERROR(render::SetSetting(assignment, &settings));
  }
  FURROW_RETURN_IF_ERROR(render::CheckSettings(settings));
  settings.view = render::View::kFinal;  // PictureSpec holds the view
  // Two texts such as "exposure=1" and "exposure=1.0" have the same settings, so the key is the
  // result.
  std::string key = render::SettingsToToml(settings);
  if (const auto known = known_.find(key); known != known_.end()) {
    if (SharedSettings shared = known->second.lock(); shared != nullptr) return shared;
  }
  // Requests bring arbitrary overrides; unused entries must not accumulate.
  std::erase_if(known_, [](const auto& entry) { return entry.second.expired(); });
  auto shared = std::make_shared<const render::Settings>(std::move(settings));
  known_.insert_or_assign(std::move(key), shared);
  return SharedSettings(std::move(shared));
}

}  // namespace furrow::server
