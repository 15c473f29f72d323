// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/expression_list.h"

#include <utility>

#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;
using Version = ExpressionObject::Version;

std::vector<ExpressionObject> ListVersion0(const Value& groups) {
  std::vector<ExpressionObject> list;
  const std::size_t count = groups.IsArray() ? groups.ArrayLen() : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Value& group = groups.Get(static_cast<int>(i));
    std::string preset = TextOf(Member(group, "presetName"));
    const bool is_preset = !preset.empty() && preset != "unknown";
    list.push_back({CutText(is_preset ? preset : TextOf(Member(group, "name")), kMaxNameBytes),
                    is_preset, Version::kVrm0, &group});
  }
  return list;
}

std::vector<ExpressionObject> ListVersion1(const Value& expressions) {
  std::vector<ExpressionObject> list;
  for (const bool is_preset : {true, false}) {
    const Value& named = Member(expressions, is_preset ? "preset" : "custom");
    if (!named.IsObject()) continue;
    for (const std::string& name : named.Keys()) {
      list.push_back({CutText(name, kMaxNameBytes), is_preset, Version::kVrm1, &named.Get(name)});
    }
  }
  return list;
}

}  // namespace

std::vector<ExpressionObject> ListExpressions(const Document& document) {
  const auto& extensions = document.model().extensions;
  if (const auto found = extensions.find("VRMC_vrm"); found != extensions.end()) {
    return ListVersion1(Member(found->second, "expressions"));
  }
  if (const auto found = extensions.find("VRM"); found != extensions.end()) {
    return ListVersion0(Member(Member(found->second, "blendShapeMaster"), "blendShapeGroups"));
  }
  return {};
}

}  // namespace furrow::gltf
