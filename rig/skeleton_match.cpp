// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_match.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>

#include "base/status.h"
#include "base/text.h"
#include "wrinkle/rig/rig_joints.h"

namespace furrow::rig {
namespace {

using wrinkle::JointRole;

// The joint that a role stands for in a rig: the first joint of the role's chain.
const std::string* FirstOf(JointRole role, const wrinkle::JointRoles& roles,
                           std::span<const std::string> names) {
  const auto found = std::ranges::find(roles, role);
  return found == roles.end() ? nullptr : &names[static_cast<std::size_t>(found - roles.begin())];
}

// The joints of drivers whose values are sums over joints. There, a sum over a whole chain has the
// same meaning.
std::set<std::string> JointsThatDriversAdd(const wrinkle::Rig& rig) {
  std::set<std::string> joints;
  for (const wrinkle::Driver& driver : rig.drivers) {
    wrinkle::VisitFields(driver, [&](const auto& fields) {
      if (!fields.kAddsJoints) return;
      const std::vector<std::string> read = JointsRead(fields);
      joints.insert(read.begin(), read.end());
    });
  }
  return joints;
}

bool Has(const wrinkle::JointRoles& roles, JointRole role) {
  return std::ranges::find(roles, role) != roles.end();
}

// The roles of a stream that do the part of one role of a rig. Skeletons divide the spine
// differently: a role that only the stream has belongs to the next role below it, and a role that
// only the rig has is played by the next one below, or else above. A neck without joints turns with
// the head.
class RoleParts {
 public:
  RoleParts(const wrinkle::JointRoles& rig, const wrinkle::JointRoles& stream)
      : rig_(rig), stream_(stream) {}

  [[nodiscard]] std::vector<JointRole> Of(JointRole role) const {
    if (role == JointRole::kNeck && !Has(stream_, role)) return {JointRole::kHead};
    if (std::ranges::find(kTorso, role) == std::end(kTorso)) return {role};
    if (!Has(stream_, role)) return {Nearest(role, stream_)};
    std::vector<JointRole> parts;
    for (const JointRole part : kTorso) {
      if (Has(stream_, part) && Nearest(part, rig_) == role) parts.push_back(part);
    }
    return parts;
  }

 private:
  static constexpr JointRole kTorso[] = {JointRole::kSpine, JointRole::kChest,
                                         JointRole::kUpperChest};

  // The role itself if `roles` has it, or the next below, or else above. kNone: no torso.
  static JointRole Nearest(JointRole role, const wrinkle::JointRoles& roles) {
    JointRole nearest = JointRole::kNone;
    bool is_above = false;
    for (const JointRole known : kTorso) {
      if (Has(roles, known) && (!is_above || nearest == JointRole::kNone)) nearest = known;
      is_above = is_above || known == role;
    }
    return nearest;
  }

  const wrinkle::JointRoles& rig_;
  const wrinkle::JointRoles& stream_;
};

// "+X" for a direction along a model axis.
std::string AxisName(const glm::vec3& direction) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(direction[i]) > std::abs(direction[axis])) axis = i;
  }
  return std::string(1, direction[axis] < 0.0f ? '-' : '+') + "XYZ"[axis];
}

// How joints are matched without roles. A few joints of Furrow's own names need no map, so the
// text says what is found before it names what no map knows.
std::string DescribeEqualNames(const SkeletonMatch& match) {
  const int num_joints = match.fit.num_joints;
  if (match.num_equal_names > 0) {
    const std::string share =
        "joints are matched by equal names: " + std::to_string(match.num_equal_names) + " of " +
        Counted(static_cast<std::uint64_t>(num_joints), "joint");
    if (match.num_equal_names == num_joints) return share;
    return share + "; no skeleton map fits the others (--skeleton-map chooses one)";
  }
  std::string roles;
  if (match.most_roles > 0 && match.most_roles < kMinRoles) {
    roles = " (the best finds " + Counted(static_cast<std::uint64_t>(match.most_roles), "role") +
            " of the " + std::to_string(kMinRoles) + " that it needs)";
  }
  return "no skeleton map fits" + roles +
         ", so joints are matched by equal names (--skeleton-map chooses one)";
}

}  // namespace

bool SkeletonMatch::Reads(std::string_view stream_joint) const {
  const auto is_alias = [&](const auto& alias) { return alias.second == stream_joint; };
  const auto has_joint = [&](const wrinkle::RoleChain& chain) {
    return std::ranges::count(chain.skeleton_joints, stream_joint) > 0;
  };
  return std::ranges::any_of(aliases, is_alias) || std::ranges::any_of(role_chains, has_joint);
}

Result<SkeletonMatcher> SkeletonMatcher::Create(const std::string& name_or_file) {
  auto shipped = SkeletonMaps::LoadShipped();
  FURROW_RETURN_IF_ERROR(shipped);
  SkeletonMatcher matcher;
  matcher.characters_ = *shipped;
  matcher.streams_ = *std::move(shipped);
  if (name_or_file.empty()) return matcher;
  auto chosen = SkeletonMaps::Load(name_or_file);
  FURROW_RETURN_IF_ERROR(chosen);
  // A chosen map may also describe the user's own character, so it joins the maps for characters.
  // For streams it replaces them.
  const auto known = matcher.characters_.maps();
  std::vector<SkeletonMap> all(known.begin(), known.end());
  all.push_back(chosen->maps().front());
  matcher.characters_ = SkeletonMaps(std::move(all));
  matcher.streams_ = *std::move(chosen);
  return matcher;
}

void SkeletonMatcher::SetCharacterRoles(std::span<const std::pair<std::string, JointRole>> roles) {
  const auto has_role = [](const auto& entry) { return entry.second != JointRole::kNone; };
  stated_.clear();
  if (std::ranges::any_of(roles, has_role)) stated_.insert(roles.begin(), roles.end());
}

void SkeletonMatcher::SetCharacterRoles(const wrinkle::Skeleton& character,
                                        const wrinkle::JointRoles& roles) {
  std::vector<std::pair<std::string, JointRole>> named;
  for (std::size_t j = 0; j < roles.size(); ++j) {
    named.emplace_back(character.joint_names()[j], roles[j]);
  }
  SetCharacterRoles(named);
}

SkeletonRoles SkeletonMatcher::RolesOf(const wrinkle::Skeleton& stream) const {
  SkeletonRoles found = streams_.RolesOrGuess(stream);
  if (stated_.empty() || streams_.is_chosen()) return found;
  for (const auto& [name, role] : stated_) {
    if (role != JointRole::kNone && stream.Find(name) == wrinkle::kNoJoint) return found;
  }
  // A map says more than the roles, so it is kept if they are equal.
  SkeletonRoles own = RolesOfCharacter(stream);
  return own.roles == found.roles ? found : own;
}

SkeletonRoles SkeletonMatcher::RolesOfCharacter(const wrinkle::Skeleton& character) const {
  if (stated_.empty()) return characters_.RolesOrGuess(character);
  wrinkle::JointRoles roles;
  for (const std::string& name : character.joint_names()) {
    const auto stated = stated_.find(name);
    roles.push_back(stated == stated_.end() ? JointRole::kNone : stated->second);
  }
  return RolesOfPackage(std::move(roles));
}

// Empty or one per name. A rig has no skeleton, so the roles follow from the names alone.
wrinkle::JointRoles SkeletonMatcher::RolesOfRig(std::span<const std::string> joint_names) const {
  wrinkle::JointRoles roles = characters_.RolesOfRig(joint_names).roles;
  if (stated_.empty()) return roles;
  roles.resize(joint_names.size(), JointRole::kNone);
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    const auto stated = stated_.find(joint_names[i]);
    if (stated != stated_.end()) roles[i] = stated->second;
  }
  return roles;
}

std::optional<wrinkle::RestStance> SkeletonMatcher::StanceOf(
    const wrinkle::Skeleton& skeleton, const wrinkle::JointRoles& roles) const {
  auto stance = wrinkle::FindRestStance(skeleton, roles);
  if (stance) return stance;
  stance = wrinkle::FindRestStance(skeleton, characters_.RolesOrGuess(skeleton).roles);
  if (stance) return stance;
  // A few joints, such as those of a head, are enough to tell up and left.
  int most = 0;
  for (const SkeletonMap& map : characters_.maps()) {
    const SkeletonRoles found = ApplySkeletonMap(map, skeleton.joint_names());
    if (found.num_roles <= most) continue;
    const auto told = wrinkle::FindRestStance(skeleton, found.roles);
    if (!told) continue;
    stance = told;
    most = found.num_roles;
  }
  return stance;
}

SkeletonMatch SkeletonMatcher::Match(const wrinkle::Skeleton& stream, const wrinkle::Rig& rig,
                                     const wrinkle::Skeleton* character) const {
  SkeletonMatch match;
  match.stream = RolesOf(stream);
  match.fit = FitOf(match.stream, stream);
  if (character != nullptr) match.character = RolesOfCharacter(*character);
  const std::set<std::string> joints = wrinkle::JointsOf(rig);
  const std::vector<std::string> names(joints.begin(), joints.end());
  match.stance = StanceOf(stream, match.stream.roles);
  const auto has_joint = [&](const std::string& name) {
    return stream.Find(name) != wrinkle::kNoJoint;
  };
  match.assumes_axes = !match.stance && std::ranges::any_of(names, has_joint);
  const auto is_known = [&](const std::string& name) {
    return joints.contains(name) ||
           (character != nullptr && character->Find(name) != wrinkle::kNoJoint);
  };
  match.num_equal_names = static_cast<int>(std::ranges::count_if(stream.joint_names(), is_known));
  if (match.stream.map.empty()) match.most_roles = streams_.MostRoles(stream.joint_names());
  if (match.stream.roles.empty()) return match;

  const wrinkle::JointRoles own = RolesOfRig(names);
  const wrinkle::JointRoles& theirs = match.stream.roles;
  const RoleParts parts(own, theirs);
  const std::set<std::string> added = JointsThatDriversAdd(rig);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const JointRole role = own[i];
    if (role == JointRole::kNone) continue;
    const int namesake = stream.Find(names[i]);
    if (namesake != wrinkle::kNoJoint) {
      // Equal names need no alias.
      const JointRole their_role = theirs[static_cast<std::size_t>(namesake)];
      if (their_role == role || their_role == JointRole::kNone) continue;
    } else if (const std::string* first = FirstOf(role, theirs, stream.joint_names())) {
      match.aliases.emplace_back(names[i], *first);
    }
    if (!added.contains(names[i])) continue;
    wrinkle::RoleChain chain{.joint = names[i], .skeleton_joints = {}};
    const std::vector<JointRole> played_by = parts.Of(role);
    for (std::size_t k = 0; k < theirs.size(); ++k) {
      if (theirs[k] == JointRole::kNone || std::ranges::count(played_by, theirs[k]) == 0) continue;
      chain.skeleton_joints.push_back(stream.joint_names()[k]);
    }
    if (!chain.skeleton_joints.empty()) match.role_chains.push_back(std::move(chain));
  }
  match.assumes_axes = match.assumes_axes || (!match.stance && !match.aliases.empty());
  return match;
}

wrinkle::Retarget MakeRetarget(const SkeletonMatch& match, const wrinkle::Skeleton& stream,
                               const wrinkle::Skeleton& character) {
  return wrinkle::Retarget::Create(stream, match.stream.roles, character, match.character.roles,
                                   match.stream.toes_height);
}

std::string Describe(const SkeletonMatch& match) {
  std::string text = Describe(match.stream);
  if (text.empty() && match.fit.num_joints > 0) text = DescribeEqualNames(match);
  if (match.turn() == wrinkle::RestStance().turn) return text;
  const glm::quat back = glm::conjugate(match.turn());
  return text + (text.empty() ? "the rest pose faces " : "; the rest pose faces ") +
         AxisName(back * glm::vec3(0.0f, 0.0f, 1.0f)) + ", up is " +
         AxisName(back * glm::vec3(0.0f, 1.0f, 0.0f));
}

std::string UnknownAxes() {
  return "the axes of the rest pose are unknown, because no joints with known roles tell up and "
         "left; +Y is taken as up and +Z as ahead; if the values are wrong, map the joints with "
         "a skeleton map (docs/SKELETONS.md), or turn a BVH file with --up-axis";
}

std::vector<std::string> WarningsOf(const SkeletonMatch& match) {
  std::vector<std::string> warnings = WarningsOf(match.fit, match.stream);
  // Guesses do not matter to a rig that finds all joints by their names.
  if (match.stream.map == kFromHierarchy && !match.aliases.empty()) {
    warnings.emplace_back(
        "no skeleton map knows enough of the joint names, so their roles are guessed from the "
        "hierarchy; if the body moves wrong, write a map with 'furrow rig propose-map' and choose "
        "it with --skeleton-map");
  }
  if (match.assumes_axes) warnings.push_back(UnknownAxes());
  if (match.stance && match.stance->is_folded) {
    warnings.emplace_back(
        "a leg points the same way as the trunk at rest, so the rest pose says nothing about the "
        "body; take a frame in which the performer stands upright as the rest pose, with "
        "--rest-frame");
  }
  if (match.stance && match.stance->toes_point_back) {
    warnings.emplace_back(
        "the toes point backwards at rest, so left and right are probably exchanged; choose "
        "another skeleton map, or write one with 'furrow rig propose-map'");
  }
  return warnings;
}

}  // namespace furrow::rig
