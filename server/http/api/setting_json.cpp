// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/setting_json.h"

#include <nlohmann/json.hpp>

#include "server/http/request/json_reply.h"

namespace furrow::server {
namespace {

using Kind = render::SettingInfo::Kind;

// The control that the page shows for a setting. A count with a fixed list is a choice.
std::string_view SettingKindName(const render::SettingInfo& info) {
  switch (info.kind) {
    case Kind::kNumber: return "number";
    case Kind::kCount: return info.choices.empty() ? "int" : "choice";
    case Kind::kSwitch: return "bool";
    case Kind::kColour: return "colour";
    case Kind::kWord: return "choice";
    case Kind::kViews: return "list";
  }
  return "number";
}

// Only numbers have limits; elsewhere min and max are null.
bool HasRange(const render::SettingInfo& info) {
  return info.kind == Kind::kNumber || info.kind == Kind::kColour ||
         (info.kind == Kind::kCount && info.choices.empty());
}

}  // namespace

Json SettingJson(const render::SettingInfo& info, const std::string& value,
                 const std::string& default_value) {
  // "skin.roughness" belongs to the group "skin".
  const std::size_t dot = info.name.find('.');
  Json json = {{"name", info.name},
               {"group", dot == std::string_view::npos ? "picture" : info.name.substr(0, dot)},
               {"unit", info.unit},
               {"help", info.help},
               {"kind", SettingKindName(info)},
               {"choices", info.choices},
               {"min", nullptr},
               {"max", nullptr},
               {"default", default_value},
               {"value", value}};
  if (HasRange(info)) {
    json["min"] = info.low;
    json["max"] = info.high;
  }
  return json;
}

Result<std::string> SettingText(const std::string& name, const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  return Status(StatusCode::kSchema, "must be text, a number, true or false", name);
}

}  // namespace furrow::server
