// SPDX-License-Identifier: Apache-2.0
#include "rig/near_names.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/ascii.h"

namespace furrow::rig {
namespace {

// Shorter names are parts of many words.
constexpr std::size_t kLeastLetters = 4;

// The letters and digits of a name, in lowercase.
std::string Letters(std::string_view name) {
  std::string letters;
  for (const char c : AsciiLower(std::string(name))) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) letters += c;
  }
  return letters;
}

// A name of a map, as it is and as it is compared.
using Known = std::pair<std::string, std::string>;

std::vector<Known> NamesOf(const SkeletonMap& map) {
  std::vector<Known> names;
  for (const SkeletonMap::Entry& entry : map.entries) {
    for (const auto& alternatives : entry.chain) {
      for (const std::string& name : alternatives) {
        std::string letters = Letters(name);
        if (letters.size() >= kLeastLetters) names.emplace_back(name, std::move(letters));
      }
    }
  }
  // The longest first: "LeftHandIndex1" is not the hand.
  std::stable_sort(names.begin(), names.end(), [](const Known& a, const Known& b) {
    return a.second.size() > b.second.size();
  });
  return names;
}

}  // namespace

SkeletonRoles RolesOfNearNames(std::span<const SkeletonMap> maps,
                               std::span<const std::string> joint_names) {
  SkeletonRoles best;
  for (const SkeletonMap& map : maps) {
    const std::vector<Known> known = NamesOf(map);
    // The joints under the names that the map knows; it drops its prefixes itself.
    std::vector<std::string> renamed;
    for (const std::string& joint : joint_names) {
      const std::string letters = Letters(joint);
      const auto found = std::find_if(known.begin(), known.end(), [&](const Known& name) {
        return letters.find(name.second) != std::string::npos;
      });
      renamed.push_back(found == known.end() ? std::string() : found->first);
    }
    SkeletonRoles roles = ApplySkeletonMap(map, renamed);
    if (roles.num_roles >= kMinRoles && roles.num_roles > best.num_roles) best = std::move(roles);
  }
  return best;
}

}  // namespace furrow::rig
