// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation/vrm_animation.h"

#include <tiny_gltf.h>

#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

// The node index in {"node": 3}.
Result<int> NodeOf(const Document& document, const tinygltf::Value& object,
                   const std::string& field) {
  const tinygltf::Value& node = Member(object, "node");
  const auto count = static_cast<int>(document.model().nodes.size());
  if (!node.IsInt() || node.GetNumberAsInt() < 0 || node.GetNumberAsInt() >= count) {
    return Status(StatusCode::kSchema, "the node is missing or does not exist", field + ".node");
  }
  return node.GetNumberAsInt();
}

// Reads {"hips": {"node": 3}, ...}, the form of human bones and of expressions.
Status ReadNamedNodes(const Document& document, const tinygltf::Value& map,
                      const std::string& field, std::vector<std::pair<std::string, int>>* named) {
  const std::vector<std::string> names = map.Keys();
  if (names.size() > kMaxVrmNodes) {
    return {StatusCode::kLimit, "more than " + std::to_string(kMaxVrmNodes) + " entries", field};
  }
  for (const std::string& name : names) {
    const Result<int> node = NodeOf(document, map.Get(name), field + "." + name);
    FURROW_RETURN_IF_ERROR(node);
    named->emplace_back(name, *node);
  }
  return {};
}

}  // namespace

Result<VrmAnimation> ReadVrmAnimation(const Document& document) {
  VrmAnimation vrm;
  const auto& extensions = document.model().extensions;
  const auto found = extensions.find("VRMC_vrm_animation");
  if (found == extensions.end() || !found->second.IsObject()) return vrm;
  vrm.present = true;
  const std::string field = "extensions.VRMC_vrm_animation";
  FURROW_RETURN_IF_ERROR(ReadNamedNodes(document,
                                        Member(Member(found->second, "humanoid"), "humanBones"),
                                        field + ".humanoid.humanBones", &vrm.human_bones));
  for (const char* kind : {"preset", "custom"}) {
    FURROW_RETURN_IF_ERROR(ReadNamedNodes(document,
                                          Member(Member(found->second, "expressions"), kind),
                                          field + ".expressions." + kind, &vrm.expressions));
  }
  const tinygltf::Value& look_at = Member(found->second, "lookAt");
  if (look_at.IsObject()) {
    const Result<int> node = NodeOf(document, look_at, field + ".lookAt");
    FURROW_RETURN_IF_ERROR(node);
    vrm.look_at = *node;
  }
  return vrm;
}

}  // namespace furrow::gltf
