// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"
#include "render/settings/named_settings.h"

namespace furrow::server {

// Returns one entry of GET /api/settings: the description of a setting, its current `value`, and
// the one that the daemon starts with.
[[nodiscard]] nlohmann::ordered_json SettingJson(const render::SettingInfo& info,
                                                 const std::string& value,
                                                 const std::string& default_value);

// Converts a value from PATCH (text, number or boolean) to the text that render::SetSetting()
// takes. Errors: kSchema, with the name as `where`.
[[nodiscard]] Result<std::string> SettingText(const std::string& name,
                                              const nlohmann::ordered_json& value);

}  // namespace furrow::server
