// SPDX-License-Identifier: Apache-2.0
// Skeleton maps: an accepted map finds its own names, with one role per joint.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "rig/skeleton_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto map = rig::ParseSkeletonMap(text, "fuzz.json");
  if (!map.ok()) {
    if (!map.status().where().starts_with("fuzz.json")) std::abort();
    return 0;
  }
  std::vector<std::string> names;
  for (const rig::SkeletonMap::Entry& entry : map->entries) {
    if (entry.role == furrow::wrinkle::JointRole::kNone || entry.chain.empty()) std::abort();
    for (const auto& place : entry.chain) names.push_back(place.front());
  }
  const rig::SkeletonRoles found = rig::ApplySkeletonMap(*map, names);
  if (found.roles.size() != names.size() || found.num_joints > static_cast<int>(names.size()) ||
      found.num_roles + static_cast<int>(found.missing.size()) !=
          static_cast<int>(map->entries.size())) {
    std::abort();
  }
  return 0;
}
