// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/rig_proposal.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/import/model/face_frame.h"
#include "base/joined.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::authoring {
namespace {

using wrinkle::Driver;
using wrinkle::JointRole;
using wrinkle::kNoJoint;
using wrinkle::Rig;

glm::vec3 PlaceOf(const KnownSkeleton& known, int joint) {
  return glm::vec3(known.skeleton->rest_model()[static_cast<std::size_t>(joint)][3]);
}

const std::string& NameOf(const KnownSkeleton& known, int joint) {
  return known.skeleton->joint_names()[static_cast<std::size_t>(joint)];
}

// Transfers a rig to another skeleton.
class Proposer {
 public:
  Proposer(const Rig& from, const KnownSkeleton& model, const KnownSkeleton& target)
      : from_(from),
        model_(model),
        target_(target),
        face_(MatchFaces(*model.skeleton, *model.joints, PointsOf(from, *model.skeleton),
                         *target.skeleton, *target.joints)) {}

  Result<RigProposal> Run() {
    Rig& rig = proposal_.rig;
    rig.name = "proposed";
    rig.filter = from_.filter;
    if (const int head = target_.joints->First(JointRole::kHead); head != kNoJoint) {
      rig.anchor = NameOf(target_, head);
    }
    for (const Driver& driver : from_.drivers) AddDriver(driver);
    if (rig.drivers.empty()) {
      return Status(StatusCode::kNotFound, "no joint is recognised by its name or by its position",
                    {},
                    "rename the joints to VRM, Mixamo or another known skeleton, or write a "
                    "skeleton map (docs/SKELETONS.md)");
    }
    AddPoses();
    for (const wrinkle::Region& region : from_.regions) AddRegion(region);
    KeepNeighbours();
    AddMaps();
    AddSizeReference();
    Remark();
    return std::move(proposal_);
  }

 private:
  // The position that counts for each joint: its control point, or its origin if no driver uses it.
  static std::vector<glm::vec3> PointsOf(const Rig& rig, const wrinkle::Skeleton& skeleton) {
    std::vector<glm::vec3> points;
    for (const glm::mat4& model : skeleton.rest_model()) points.emplace_back(model[3]);
    for (const Driver& driver : rig.drivers) {
      if (driver.kind != Driver::Kind::kPose) continue;
      for (const wrinkle::ControlPoint& point : driver.pose.points) {
        const int joint = skeleton.Find(point.joint);
        if (joint == kNoJoint || point.kind != wrinkle::ControlPoint::Kind::kTail) continue;
        const auto index = static_cast<std::size_t>(joint);
        points[index] =
            glm::vec3(skeleton.rest_model()[index] * glm::vec4(skeleton.tails()[index], 1.0f));
      }
    }
    return points;
  }

  // The target's joint with the role of a joint of the model. Where several joints of the target
  // have the role, the first one is used. With `above` the last one is used: the joint is then the
  // upper end of a bone that ends at another joint.
  [[nodiscard]] int ByRole(const std::string& name, bool above) const {
    const int joint = model_.skeleton->Find(name);
    if (joint == kNoJoint) return kNoJoint;
    const JointRole role = model_.joints->roles[static_cast<std::size_t>(joint)];
    if (role == JointRole::kNone) return kNoJoint;
    for (const JointRole substitute : Substitutes(role)) {
      const int found =
          above ? target_.joints->Last(substitute) : target_.joints->First(substitute);
      if (found != kNoJoint) return found;
    }
    return kNoJoint;
  }

  // Spines have different numbers of joints. A missing joint is replaced by a neighbour.
  static std::vector<JointRole> Substitutes(JointRole role) {
    switch (role) {
      case JointRole::kChest: return {JointRole::kUpperChest, JointRole::kChest, JointRole::kSpine};
      case JointRole::kSpine: return {JointRole::kSpine, JointRole::kChest};
      case JointRole::kNeck: return {JointRole::kNeck, JointRole::kHead};
      default: return {role};
    }
  }

  void AddDriver(const Driver& from) {
    std::optional<Driver> driver;
    switch (from.kind) {
      case Driver::Kind::kPose: driver = CarryPose(from); break;
      case Driver::Kind::kHinge: driver = CarryHinge(from); break;
      case Driver::Kind::kBall: driver = CarryBall(from); break;
      case Driver::Kind::kTwist: driver = CarryTwist(from); break;
      default: return;  // the other kinds belong to a tracker or to one mesh
    }
    if (driver) {
      drivers_.insert(from.name);
      proposal_.rig.drivers.push_back(std::move(*driver));
    } else {
      left_out_.push_back(from.name);
    }
  }

  std::optional<Driver> CarryHinge(Driver driver) {
    wrinkle::HingeDriver& hinge = driver.hinge;
    const int parent = ByRole(hinge.parent, true);
    const int joint = ByRole(hinge.joint, false);
    const int end = ByRole(hinge.end, false);
    if (parent == kNoJoint || joint == kNoJoint || end == kNoJoint) return std::nullopt;
    const JointRole role = target_.joints->roles[static_cast<std::size_t>(joint)];
    const int start =
        target_.joints->First(target_.joints->roles[static_cast<std::size_t>(parent)]);
    hinge.axis = HingeAxis(role, PlaceOf(target_, joint) - PlaceOf(target_, start),
                           PlaceOf(target_, end) - PlaceOf(target_, joint));
    hinge.parent = NameOf(target_, parent);
    hinge.joint = NameOf(target_, joint);
    hinge.end = NameOf(target_, end);
    return driver;
  }

  // The axis of flexion. If the limb is bent at rest, the axis is perpendicular to both bones.
  // Otherwise it is perpendicular to the upper bone, such that a shin moves back and a forearm
  // moves forward and up.
  static glm::vec3 HingeAxis(JointRole role, const glm::vec3& upper, const glm::vec3& lower) {
    constexpr float kBent = 0.2f;  // sine of the angle from which a limb counts as bent
    const bool leg = role == JointRole::kLeftLowerLeg || role == JointRole::kRightLowerLeg;
    const glm::vec3 bone = glm::length(upper) > 0.0f ? glm::normalize(upper) : glm::vec3(0, -1, 0);
    const glm::vec3 toward =
        leg ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::normalize(glm::vec3(0.0f, 0.5f, 0.866f));
    glm::vec3 axis = glm::cross(bone, toward);
    const glm::vec3 bend =
        glm::length(lower) > 0.0f ? glm::cross(bone, glm::normalize(lower)) : glm::vec3(0.0f);
    if (glm::length(bend) > kBent && glm::dot(bend, axis) > 0.0f) axis = bend;
    return glm::length(axis) > 1e-3f ? glm::normalize(axis) : glm::vec3(1.0f, 0.0f, 0.0f);
  }

  std::optional<Driver> CarryBall(Driver driver) {
    wrinkle::BallDriver& ball = driver.ball;
    const int parent = ByRole(ball.parent, true);
    const int joint = ByRole(ball.joint, false);
    const int end = ByRole(ball.end, false);
    if (parent == kNoJoint || joint == kNoJoint || end == kNoJoint || parent == joint ||
        joint == end) {
      return std::nullopt;
    }
    ball.parent = NameOf(target_, parent);
    ball.joint = NameOf(target_, joint);
    ball.end = NameOf(target_, end);
    return driver;
  }

  // All joints with the roles of the model's twist, each once.
  std::optional<Driver> CarryTwist(Driver driver) {
    wrinkle::TwistDriver& twist = driver.twist;
    std::vector<std::string> names = {twist.joint};
    names.insert(names.end(), twist.through.begin(), twist.through.end());
    std::set<int> joints;
    for (const std::string& name : names) {
      const int joint = model_.skeleton->Find(name);
      if (joint == kNoJoint) continue;
      const JointRole role = model_.joints->roles[static_cast<std::size_t>(joint)];
      const bool is_chest = role == JointRole::kChest;
      for (int j = 0; j < target_.skeleton->num_joints(); ++j) {
        const JointRole has = target_.joints->roles[static_cast<std::size_t>(j)];
        const bool same = has == role || (is_chest && has == JointRole::kUpperChest);
        if (same && has != JointRole::kNone) joints.insert(j);
      }
    }
    if (joints.empty()) return std::nullopt;
    twist.joint = NameOf(target_, *joints.begin());
    twist.through.clear();
    for (auto it = std::next(joints.begin()); it != joints.end(); ++it) {
      twist.through.push_back(NameOf(target_, *it));
    }
    return driver;
  }

  std::optional<Driver> CarryPose(Driver driver) {
    for (wrinkle::ControlPoint& point : driver.pose.points) {
      const int from = model_.skeleton->Find(point.joint);
      const int joint = face_.Of(from);
      if (joint == kNoJoint) return std::nullopt;
      const bool same = NameOf(target_, joint) == point.joint;
      point.joint = NameOf(target_, joint);
      if (same) continue;
      point.kind = face_.by_tail[static_cast<std::size_t>(from)]
                       ? wrinkle::ControlPoint::Kind::kTail
                       : wrinkle::ControlPoint::Kind::kOrigin;
    }
    for (const auto& value : driver.pose.values) poses_.insert(value.reference_pose);
    return driver;
  }

  // Transfers the poses that drivers use to the target's joints.
  void AddPoses() {
    const float size = wrinkle::SkeletonSize(*model_.skeleton);
    for (const wrinkle::ReferencePose& from : from_.reference_poses) {
      if (!poses_.contains(from.name)) continue;
      wrinkle::ReferencePose pose{from.name, {}, from.source_size > 0 ? from.source_size : size};
      for (wrinkle::JointDelta delta : from.joints) {
        const int joint = face_.Of(model_.skeleton->Find(delta.joint));
        if (joint == kNoJoint) continue;
        delta.joint = NameOf(target_, joint);
        // Origin and tail of one joint may match two joints of the model. The first one counts.
        const auto is_same = [&](const auto& known) { return known.joint == delta.joint; };
        if (std::any_of(pose.joints.begin(), pose.joints.end(), is_same)) continue;
        // Unscaled translations are in the units of the model that the poses come from.
        delta.translation += delta.unscaled_translation * (pose.source_size / size);
        delta.unscaled_translation = glm::vec3(0.0f);
        pose.joints.push_back(std::move(delta));
      }
      proposal_.rig.reference_poses.push_back(std::move(pose));
    }
  }

  void AddRegion(wrinkle::Region region) {
    for (wrinkle::Feed& feed : region.feeds) {
      std::erase_if(feed.sources, [&](const auto& s) { return !drivers_.contains(s.driver); });
    }
    std::erase_if(region.feeds, [](const wrinkle::Feed& feed) { return feed.sources.empty(); });
    if (region.feeds.empty()) return;
    region.mask = wrinkle::Mask{.kind = wrinkle::Mask::Kind::kSkinning, .texture = {}};
    proposal_.rig.regions.push_back(std::move(region));
  }

  void KeepNeighbours() {
    std::set<std::string> names;
    for (const wrinkle::Region& region : proposal_.rig.regions) names.insert(region.name);
    for (wrinkle::Region& region : proposal_.rig.regions) {
      std::erase_if(region.neighbours, [&](const auto& name) { return !names.contains(name); });
    }
  }

  void AddMaps() {
    std::set<std::string> fed;
    for (const wrinkle::Region& region : proposal_.rig.regions) {
      for (const wrinkle::Feed& feed : region.feeds) fed.insert(feed.map);
    }
    for (const wrinkle::WrinkleMap& from : from_.wrinkle_maps) {
      if (!fed.contains(from.name)) continue;
      wrinkle::WrinkleMap map;
      map.name = from.name;
      map.amplitude = from.amplitude;
      if (fed.contains(from.opposes)) map.opposes = from.opposes;
      proposal_.rig.wrinkle_maps.push_back(std::move(map));
    }
  }

  // Streams of this character with fewer joints then have its size, too.
  void AddSizeReference() {
    Rig& rig = proposal_.rig;
    wrinkle::SizeReference reference =
        wrinkle::MakeSizeReference(*target_.skeleton, wrinkle::JointsOf(rig));
    if (rig.reference_poses.empty() || reference.joints.size() < 2) return;
    rig.size_reference = std::make_shared<const wrinkle::SizeReference>(std::move(reference));
    for (wrinkle::ReferencePose& pose : rig.reference_poses) {
      pose.size_reference = rig.size_reference;
    }
  }

  void Remark() {
    auto& remarks = proposal_.remarks;
    const std::string& map = target_.joints->map;
    if (map.empty()) {
      proposal_.joints_are_guessed = true;
      remarks.emplace_back(
          "joint roles were guessed from the hierarchy; check the joints of each driver");
    } else if (map != rig::kFromPackage) {
      remarks.push_back("joint names match '" + map + "'");
    }
    if (!left_out_.empty()) {
      remarks.push_back("no joint found for the drivers " + Joined(left_out_));
    }
    if (!poses_.empty()) {
      remarks.emplace_back(
          "facial reference poses were transferred by position; replace them with your own poses");
    }
  }

  const Rig& from_;
  const KnownSkeleton& model_;
  const KnownSkeleton& target_;
  FaceMatch face_;
  RigProposal proposal_;
  std::set<std::string> drivers_;
  std::set<std::string> poses_;
  std::vector<std::string> left_out_;
};

}  // namespace

Result<RigProposal> ProposeRig(const Rig& rig, const KnownSkeleton& model,
                               const KnownSkeleton& target) {
  return Proposer(rig, model, target).Run();
}

}  // namespace furrow::authoring
