// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_humanoid.h"

#include <algorithm>
#include <cstddef>

#include <tiny_gltf.h>

#include "base/ascii.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

// VRM 1.0 names a thumb's bones like the anatomy does; 0.x like the other fingers.
std::string NameInVrm1(const std::string& vrm0) {
  for (const std::string side : {"left", "right"}) {
    if (vrm0 == side + "ThumbProximal") return side + "ThumbMetacarpal";
    if (vrm0 == side + "ThumbIntermediate") return side + "ThumbProximal";
  }
  return vrm0;
}

bool IsCalledJaw(const std::string& name) {
  return std::ranges::any_of(
      std::initializer_list<const char*>{"jaw", "chin", "mouth", "顎", "あご"},
      [lower = AsciiLower(name)](const char* word) {
        return lower.find(word) != std::string::npos;
      });
}

class HumanoidReader {
 public:
  explicit HumanoidReader(Document* document) : document_(*document) {}

  std::vector<std::pair<std::string, int>> Run() {
    const auto& extensions = document_.model().extensions;
    if (const auto found = extensions.find("VRMC_vrm"); found != extensions.end()) {
      ReadVrm1(Member(Member(found->second, "humanoid"), "humanBones"));
    } else if (const auto old = extensions.find("VRM"); old != extensions.end()) {
      ReadVrm0(Member(Member(old->second, "humanoid"), "humanBones"));
    }
    return std::move(bones_);
  }

 private:
  // {"hips": {"node": 3}, ...}
  void ReadVrm1(const Value& bones) {
    if (!bones.IsObject()) return;
    for (const std::string& name : bones.Keys()) {
      if (!HasRoom()) return;
      Add("extensions.VRMC_vrm.humanoid.humanBones." + name, name, bones.Get(name));
    }
  }

  // [{"bone": "hips", "node": 3}, ...]
  void ReadVrm0(const Value& bones) {
    for (std::size_t i = 0; i < LengthOf(bones); ++i) {
      if (!HasRoom()) return;
      const Value& bone = bones.Get(static_cast<int>(i));
      Add("extensions.VRM.humanoid.humanBones[" + std::to_string(i) + "]",
          NameInVrm1(TextOf(Member(bone, "bone"))), bone);
    }
  }

  bool HasRoom() {
    if (++num_entries_ <= kMaxVrmNodes) return true;
    document_.Warn("humanBones", "only the first " + std::to_string(kMaxVrmNodes) + " are read");
    return false;
  }

  void Add(const std::string& field, const std::string& name, const Value& from) {
    const Value& value = Member(from, "node");
    const auto& nodes = document_.model().nodes;
    const int node = value.IsInt() ? value.GetNumberAsInt() : -1;
    if (node < 0 || node >= static_cast<int>(nodes.size())) {
      // VRM 0.x writes -1 for a bone that the avatar lacks.
      if (!value.IsInt() || node != -1) document_.Warn(field, "the node does not exist");
      return;
    }
    if (std::ranges::find(bones_, name, &std::pair<std::string, int>::first) != bones_.end()) {
      document_.Warn(field, "the bone is stated twice; the first counts");
      return;
    }
    if (name == "jaw" && !IsCalledJaw(nodes[static_cast<std::size_t>(node)].name)) {
      document_.Warn(field, "the joint is not called a jaw, so it is taken for none");
      return;
    }
    bones_.emplace_back(name, node);
  }

  Document& document_;
  std::vector<std::pair<std::string, int>> bones_;
  std::size_t num_entries_ = 0;
};

}  // namespace

std::vector<std::pair<std::string, int>> ReadVrmHumanoid(Document* document) {
  return HumanoidReader(document).Run();
}

}  // namespace furrow::gltf
