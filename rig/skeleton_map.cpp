// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/ascii.h"
#include "base/data_dir.h"
#include "base/files.h"
#include "base/status.h"
#include "rig/shipped_maps.h"
#include "wrinkle/hierarchy/hierarchy_roles.h"

namespace furrow::rig {
namespace {

namespace fs = std::filesystem;
using wrinkle::JointRole;

constexpr char kFolder[] = "skeleton_maps";

// Lowercase if the map ignores case, so that names compare byte by byte.
std::string Folded(std::string_view name, bool ignore_case) {
  std::string folded(name);
  if (ignore_case) folded = AsciiLower(std::move(folded));
  return folded;
}

// Maya writes "namespace:joint". The last colon ends the namespace.
std::string_view WithoutNamespace(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

// The start of a name that ends with a counter: "_12" (Sketchfab) or ".001" (Blender). Empty: none.
std::string_view BeforeCounter(std::string_view name) {
  const std::size_t digits = name.find_last_not_of("0123456789");
  if (digits == std::string_view::npos || digits == 0 || digits + 1 == name.size()) return {};
  const bool is_counter =
      name[digits] == '_' || (name[digits] == '.' && name.size() - digits - 1 == 3);
  return is_counter ? name.substr(0, digits) : std::string_view();
}

// The names without their counters, if all have one; else none. Sketchfab adds a root and nodes
// above it, without counters.
std::vector<std::string> WithoutCounters(std::span<const std::string> names) {
  const bool is_of_sketchfab = std::ranges::find(names, "_rootJoint") != names.end();
  std::vector<std::string> plain;
  for (const std::string& name : names) {
    const std::string_view start = BeforeCounter(name);
    if (start.empty() && !is_of_sketchfab) return {};
    plain.emplace_back(start.empty() ? name : start);
  }
  return plain;
}

// Removes `prefix` from `name`. Both have been folded to one case. Other names are returned
// unchanged.
std::string_view WithoutPrefix(std::string_view name, std::string_view prefix) {
  // "*_" and the like match anything up to the last occurrence of the mark.
  if (prefix.starts_with('*')) {
    const std::string_view mark = prefix.substr(1);
    const std::size_t at = name.rfind(mark);
    return mark.empty() || at == std::string_view::npos ? name : name.substr(at + mark.size());
  }
  return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

// Index of a map by joint name: the entry, and the place in its chain that the name fills.
struct Place {
  std::size_t entry;
  std::size_t of_chain;
  std::size_t alternative;
};
using Places = std::unordered_multimap<std::string, Place>;

// A name may fill places of several entries, hence the multimap.
Places PlacesOf(const SkeletonMap& map) {
  Places places;
  for (std::size_t e = 0; e < map.entries.size(); ++e) {
    const auto& chain = map.entries[e].chain;
    for (std::size_t c = 0; c < chain.size(); ++c) {
      for (std::size_t a = 0; a < chain[c].size(); ++a) {
        places.emplace(Folded(chain[c][a], map.ignore_case), Place{e, c, a});
      }
    }
  }
  return places;
}

// The joint that fills each place of each entry, or -1. The earliest alternative name wins, then
// the first joint.
std::vector<std::vector<std::pair<int, std::size_t>>> FillPlaces(
    const SkeletonMap& map, const Places& places, std::string_view prefix,
    std::span<const std::string> joint_names) {
  std::vector<std::vector<std::pair<int, std::size_t>>> filled;
  // -1: no joint yet.
  for (const auto& entry : map.entries) filled.emplace_back(entry.chain.size(), std::pair(-1, 0));
  for (std::size_t j = 0; j < joint_names.size(); ++j) {
    const std::string name = Folded(WithoutNamespace(joint_names[j]), map.ignore_case);
    const auto [first, last] = places.equal_range(std::string(WithoutPrefix(name, prefix)));
    for (auto it = first; it != last; ++it) {
      auto& [joint, alternative] = filled[it->second.entry][it->second.of_chain];
      if (joint >= 0 && alternative <= it->second.alternative) continue;
      joint = static_cast<int>(j);
      alternative = it->second.alternative;
    }
  }
  return filled;
}

SkeletonRoles ApplyWithPrefix(const SkeletonMap& map, const Places& places, std::string_view prefix,
                              std::span<const std::string> joint_names) {
  SkeletonRoles result;
  result.map = map.name;
  result.toes_height = map.toes_height;
  // One role per joint. The first entry that claims a joint keeps it.
  result.roles.assign(joint_names.size(), JointRole::kNone);
  const auto filled = FillPlaces(map, places, prefix, joint_names);
  for (std::size_t e = 0; e < filled.size(); ++e) {
    bool found = false;
    for (const auto& [joint, alternative] : filled[e]) {
      if (joint < 0 || result.roles[static_cast<std::size_t>(joint)] != JointRole::kNone) continue;
      result.roles[static_cast<std::size_t>(joint)] = map.entries[e].role;
      ++result.num_joints;
      found = true;
    }
    if (found) {
      ++result.num_roles;
    } else {
      result.missing.push_back(map.entries[e].role);
    }
  }
  return result;
}

// The points of a map's roles; `parents` may be empty (SkeletonMaps::RolesOf()). Fingers count less
// than the body: CMU's files have an index finger of Mixamo's name, and a spine of their own.
int Points(const wrinkle::JointRoles& roles, std::span<const std::int16_t> parents) {
  constexpr int kOfBody = 4;
  constexpr int kOfFingersOrFace = 1;
  constexpr int kLeftOut = -2;
  int points = 0;
  for (const JointRole role : roles) {
    if (role == JointRole::kNone) continue;
    points += wrinkle::IsFinger(role) || wrinkle::IsOfFace(role) ? kOfFingersOrFace : kOfBody;
  }
  // Parents come first, so one pass marks the joints below a role, and one pass back those above.
  std::vector<bool> below(parents.size(), false);
  std::vector<bool> above(parents.size(), false);
  for (std::size_t j = 0; j < parents.size(); ++j) {
    if (parents[j] < 0) continue;
    const auto parent = static_cast<std::size_t>(parents[j]);
    below[j] = below[parent] || roles[parent] != JointRole::kNone;
  }
  for (std::size_t j = parents.size(); j-- > 0;) {
    if (parents[j] < 0) continue;
    const auto parent = static_cast<std::size_t>(parents[j]);
    above[parent] = above[parent] || above[j] || roles[j] != JointRole::kNone;
  }
  for (std::size_t j = 0; j < parents.size(); ++j) {
    if (roles[j] == JointRole::kNone && below[j] && above[j]) points += kLeftOut;
  }
  return points;
}

// The share of a map's roles that a skeleton has. The more specific of two maps has more.
double Share(const SkeletonRoles& found, const SkeletonMap& map) {
  return static_cast<double>(found.num_roles) / static_cast<double>(map.entries.size());
}

// How many joints have a name of the map in its own case. VMC's names are VRM's, capitalised.
int NumSpelledAlike(const SkeletonMap& map, std::span<const std::string> joint_names) {
  std::unordered_set<std::string_view> known;
  for (const SkeletonMap::Entry& entry : map.entries) {
    for (const std::vector<std::string>& place : entry.chain) {
      for (const std::string& name : place) known.insert(name);
    }
  }
  return static_cast<int>(std::ranges::count_if(joint_names, [&](const std::string& name) {
    return known.contains(WithoutNamespace(name));
  }));
}

bool IsEnough(const SkeletonRoles& found, bool needs_limbs) {
  if (found.num_roles < kMinRoles) return false;
  if (!needs_limbs || std::ranges::any_of(found.roles, wrinkle::IsOfLimb)) return true;
  return 4 * static_cast<std::size_t>(found.num_joints) >= 3 * found.roles.size();
}

// Sets the two numbers of roles that no map gave.
void CountRoles(SkeletonRoles* found) {
  std::set<JointRole> distinct;
  for (const JointRole role : found->roles) {
    if (role == JointRole::kNone) continue;
    distinct.insert(role);
    ++found->num_joints;
  }
  found->num_roles = static_cast<int>(distinct.size());
}

// How many of wrinkle::kEssentialRoles some joint has.
std::ptrdiff_t NumEssential(const wrinkle::JointRoles& roles) {
  return std::ranges::count_if(wrinkle::kEssentialRoles, [&](JointRole role) {
    return std::ranges::find(roles, role) != roles.end();
  });
}

// True if a guess gives their named role to at least nine of ten joints whose names tell a part of
// a limb. A guess that exchanges the sides does not, nor does one that is a joint off. `named`:
// empty, or one per joint.
bool Confirms(const wrinkle::JointRoles& guess, const wrinkle::JointRoles& named) {
  int num_limbs = 0;
  int num_same = 0;
  for (std::size_t j = 0; j < named.size(); ++j) {
    if (!wrinkle::IsOfLimb(named[j])) continue;
    ++num_limbs;
    num_same += guess[j] == named[j] ? 1 : 0;
  }
  return 10 * num_same >= 9 * num_limbs;
}

// The roles that the hierarchy tells, and those of fingers and face that the names tell. Empty if
// the hierarchy tells none.
SkeletonRoles GuessRoles(const wrinkle::Skeleton& skeleton, const wrinkle::JointRoles& named) {
  SkeletonRoles guess;
  guess.roles = wrinkle::RolesFromHierarchy(skeleton);
  if (guess.roles.empty()) return guess;
  for (std::size_t j = 0; j < named.size(); ++j) {
    const bool is_detail = wrinkle::IsFinger(named[j]) || wrinkle::IsOfFace(named[j]);
    if (is_detail && guess.roles[j] == JointRole::kNone) guess.roles[j] = named[j];
  }
  guess.map = kFromHierarchy;
  CountRoles(&guess);
  return guess;
}

SkeletonRoles ApplyToNames(const SkeletonMap& map, std::span<const std::string> joint_names) {
  const Places places = PlacesOf(map);
  // All joints of a skeleton share a prefix, so one prefix is tried on all of them. On a tie, the
  // earlier one wins.
  SkeletonRoles best = ApplyWithPrefix(map, places, "", joint_names);
  for (const std::string& prefix : map.prefixes) {
    SkeletonRoles found =
        ApplyWithPrefix(map, places, Folded(prefix, map.ignore_case), joint_names);
    if (found.num_joints > best.num_joints) best = std::move(found);
  }
  return best;
}

Result<SkeletonMap> LoadFile(const fs::path& path) {
  const auto text = ReadFile(path, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseSkeletonMap(*text, path.string());
}

}  // namespace

SkeletonRoles ApplySkeletonMap(const SkeletonMap& map, std::span<const std::string> joint_names) {
  SkeletonRoles found = ApplyToNames(map, joint_names);
  const std::vector<std::string> plain = WithoutCounters(joint_names);
  if (plain.empty()) return found;
  SkeletonRoles of_plain = ApplyToNames(map, plain);
  return of_plain.num_joints > found.num_joints ? of_plain : found;
}

SkeletonRoles RolesOfPackage(wrinkle::JointRoles roles) {
  SkeletonRoles found;
  found.map = kFromPackage;
  found.roles = std::move(roles);
  CountRoles(&found);
  return found;
}

SkeletonMaps::SkeletonMaps(std::vector<SkeletonMap> maps, bool chosen)
    : maps_(std::move(maps)), chosen_(chosen) {
  // A tie between maps goes by their names, whatever their files are called.
  std::ranges::sort(maps_, {}, &SkeletonMap::name);
}

Result<SkeletonMaps> SkeletonMaps::LoadShipped() {
  const auto files = ListDataFiles(kFolder, ".json");
  FURROW_RETURN_IF_ERROR(files);
  std::vector<SkeletonMap> maps;
  for (const fs::path& file : *files) {
    auto map = LoadFile(file);
    FURROW_RETURN_IF_ERROR(map);
    maps.push_back(*std::move(map));
  }
  return SkeletonMaps(std::move(maps));
}

Result<SkeletonMaps> SkeletonMaps::Load(const std::string& name_or_file) {
  if (name_or_file.empty()) return LoadShipped();
  const auto path = FindMap(kFolder, name_or_file);
  FURROW_RETURN_IF_ERROR(path);
  auto map = LoadFile(*path);
  FURROW_RETURN_IF_ERROR(map);
  std::vector<SkeletonMap> maps;
  maps.push_back(*std::move(map));
  return SkeletonMaps(std::move(maps), /*chosen=*/true);
}

SkeletonRoles SkeletonMaps::RolesOf(const wrinkle::Skeleton& skeleton) const {
  return Best(skeleton.joint_names(), skeleton.joint_parents(), /*needs_limbs=*/true);
}

SkeletonRoles SkeletonMaps::RolesOf(std::span<const std::string> joint_names) const {
  return Best(joint_names, {}, /*needs_limbs=*/true);
}

SkeletonRoles SkeletonMaps::RolesOfRig(std::span<const std::string> joint_names) const {
  return Best(joint_names, {}, /*needs_limbs=*/false);
}

int SkeletonMaps::MostRoles(std::span<const std::string> joint_names) const {
  int most = 0;
  for (const SkeletonMap& map : maps_) {
    most = std::max(most, ApplySkeletonMap(map, joint_names).num_roles);
  }
  return most;
}

bool SkeletonMaps::KnowEye(const std::string& joint_name) const {
  return std::ranges::any_of(maps_, [&](const SkeletonMap& map) {
    const JointRole role = ApplySkeletonMap(map, std::span(&joint_name, 1)).roles.front();
    return role == JointRole::kLeftEye || role == JointRole::kRightEye;
  });
}

SkeletonRoles SkeletonMaps::Best(std::span<const std::string> joint_names,
                                 std::span<const std::int16_t> parents, bool needs_limbs) const {
  SkeletonRoles best;
  std::tuple<int, double, int> best_score;
  for (const SkeletonMap& map : maps_) {
    SkeletonRoles found = ApplySkeletonMap(map, joint_names);
    // A map that the user chose needs no minimum. For shipped maps, a few matches may be
    // coincidence.
    if (!chosen_ && !IsEnough(found, needs_limbs)) continue;
    const std::tuple score(Points(found.roles, parents), Share(found, map),
                           NumSpelledAlike(map, joint_names));
    if (!best.map.empty() && score <= best_score) continue;
    best = std::move(found);
    best_score = score;
  }
  return best;
}

SkeletonRoles SkeletonMaps::RolesOrGuess(const wrinkle::Skeleton& skeleton) const {
  SkeletonRoles found = RolesOf(skeleton);
  const std::ptrdiff_t num_named = NumEssential(found.roles);
  if (chosen_ || maps_.empty() || num_named == std::ssize(wrinkle::kEssentialRoles)) return found;
  SkeletonRoles guess = GuessRoles(skeleton, found.roles);
  const bool is_better = NumEssential(guess.roles) > num_named;
  return is_better && Confirms(guess.roles, found.roles) ? guess : found;
}

std::string ProposeSkeletonMap(std::string_view name, std::span<const std::string> joint_names,
                               const wrinkle::JointRoles& roles) {
  nlohmann::ordered_json joints = nlohmann::ordered_json::object();
  for (int i = 1; i < wrinkle::kNumJointRoles; ++i) {
    std::vector<std::string> chain;
    for (std::size_t j = 0; j < std::min(roles.size(), joint_names.size()); ++j) {
      // A namespace is never part of a map.
      if (roles[j] == static_cast<JointRole>(i))
        chain.emplace_back(WithoutNamespace(joint_names[j]));
    }
    const std::string role(wrinkle::ToString(static_cast<JointRole>(i)));
    if (chain.size() == 1) joints[role] = chain.front();
    if (chain.size() > 1) joints[role] = chain;
  }
  const nlohmann::ordered_json map = {{"version", 1}, {"name", name}, {"joints", joints}};
  return map.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string JoinRoles(std::span<const JointRole> roles) {
  std::string text;
  for (const JointRole role : roles) {
    text += (text.empty() ? "" : ", ") + std::string(wrinkle::ToString(role));
  }
  return text;
}

}  // namespace furrow::rig
