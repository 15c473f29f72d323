// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_poses.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "authoring/bake/surface/bake_surface.h"
#include "authoring/shapes/shape_combinations.h"
#include "base/ascii.h"
#include "base/joined.h"
#include "base/scalar.h"
#include "base/status.h"
#include "wrinkle/fields/rig_field.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/full_pose.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/reference_pose.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::authoring {
namespace {

using wrinkle::Driver;
using wrinkle::FieldAt;
using wrinkle::Rig;
using wrinkle::Transform;

// A pose folds nothing if its joints turn by less than kLeastTurn (radians) and move by less than
// kLeastMove (fraction of the skeleton's size).
constexpr float kLeastTurn = 1e-3f;
constexpr float kLeastMove = 1e-5f;

// Weaker sources take the folds of the stronger ones. Folds of their own would run across those.
constexpr float kLeastShapeGain = 0.7f;
constexpr float kLeastAngleGain = 0.6f;  // for feeds by angle

constexpr int kBisections = 20;  // of an angle

constexpr float kStepAngle = 8.0f * kDegrees;  // between the steps on the way to a pose

bool Wants(std::span<const std::string> maps, const std::string& map) {
  return maps.empty() || std::find(maps.begin(), maps.end(), map) != maps.end();
}

const Driver* FindDriver(const Rig& rig, const std::string& name) {
  const auto found = std::find_if(rig.drivers.begin(), rig.drivers.end(),
                                  [&](const Driver& driver) { return driver.name == name; });
  return found == rig.drivers.end() ? nullptr : &*found;
}

// The vector part of a quaternion is the sine of half the angle, hence the factor 0.5.
bool IsRest(std::span<const Transform> locals, const wrinkle::Skeleton& skeleton) {
  const float least = kLeastMove * wrinkle::SkeletonSize(skeleton);
  for (std::size_t i = 0; i < locals.size(); ++i) {
    const Transform& rest = skeleton.rest_pose()[i];
    const glm::quat turn = glm::conjugate(rest.rotation) * locals[i].rotation;
    if (glm::length(glm::vec3(turn.x, turn.y, turn.z)) > 0.5f * kLeastTurn) return false;
    if (glm::distance(locals[i].translation, rest.translation) > least) return false;
  }
  return true;
}

bool Moves(const wrinkle::ReferencePose& pose, const std::string& joint) {
  return std::ranges::find(pose.joints, joint, &wrinkle::JointDelta::joint) != pose.joints.end();
}

// Precondition: the pose moves the joint.
const wrinkle::JointDelta& DeltaOf(const wrinkle::ReferencePose& pose, const std::string& joint) {
  return *std::ranges::find(pose.joints, joint, &wrinkle::JointDelta::joint);
}

// Turns the driver values that feed a map into full poses of the character's own skeleton.
class PoseCollector {
 public:
  PoseCollector(const character::Character& character, const ArkitFace& face)
      : character_(character), face_(face) {
    for (const wrinkle::ReferencePose& pose : character.rig.reference_poses) {
      if (pose.name == wrinkle::kClothesFitPose) fit_ = pose;
    }
    std::erase_if(fit_.joints, [&](const wrinkle::JointDelta& delta) {
      return character.skeleton.Find(delta.joint) == wrinkle::kNoJoint;
    });
  }

  Status Add(const wrinkle::Region& region, const wrinkle::Feed& feed,
             const wrinkle::Feed::Source& source) {
    const std::string value = source.driver + "." + source.value;
    const Driver* driver = FindDriver(character_.rig, source.driver);
    if (driver == nullptr) return {StatusCode::kNotFound, "there is no driver '" + value + "'"};
    const bool states_angle = &source == &feed.sources.front();
    if (!feed.angles.empty() && !states_angle && source.gain < kLeastAngleGain) return {};
    if (driver->kind == Driver::Kind::kBlendShape && !character_.shapes.empty()) {
      AddShape(region, feed, source, driver->blend_shape);
      return {};
    }
    const std::optional<float> degrees = AngleOf(feed, source);
    const auto pose =
        wrinkle::FullPose(character_.rig, *driver, source.value, character_.skeleton, degrees);
    if (pose.status().code() == StatusCode::kUnsupported) {
      Note(value + " has no joint pose; only strokes can give " + region.name + "." + feed.map +
           " its folds");
      return {};
    }
    FURROW_RETURN_IF_ERROR(pose);
    std::vector<Transform> locals(character_.skeleton.rest_pose().begin(),
                                  character_.skeleton.rest_pose().end());
    FURROW_RETURN_IF_ERROR(wrinkle::ApplyReferencePose(*pose, character_.skeleton, locals));
    std::vector<float> shape_weights = PoseShapes(*pose, locals);
    const bool has_shapes =
        std::any_of(shape_weights.begin(), shape_weights.end(), [](float w) { return w != 0.0f; });
    // A feed that states an angle may well mean the rest pose: cloth has slack there.
    if (!degrees && !has_shapes && IsRest(locals, character_.skeleton)) {
      return AtRest(*driver, value, *pose);
    }
    if (!has_shapes) shape_weights.clear();
    AddPose({.map = feed.map,
             .region = region.name,
             .skin_matrices = SkinMatrices(locals),
             .path = FoldsCloth(character_, feed) ? PathTo(*pose)
                                                  : std::vector<std::vector<glm::mat4>>(),
             .shape_weights = std::move(shape_weights),
             .weight = std::min(source.gain, 1.0f)});
    return {};
  }

  // Adds the combinations of shapes that the sources of a feed lead.
  void AddCombinations(const wrinkle::Region& region, const wrinkle::Feed& feed) {
    if (character_.shapes.empty()) return;
    for (const ShapeCombination& combination : ShapeCombinations()) {
      float gain = 0.0f;
      for (const std::string& lead : ShapesOf(combination.lead)) {
        gain = std::max(gain, GainOf(feed, lead));
      }
      if (gain < kLeastShapeGain) continue;
      std::vector<ArkitFace::Coefficient> coefficients;
      for (const ShapeCombination::Part& part : combination.parts) {
        for (std::string& name : ShapesOf(part.shape)) {
          coefficients.emplace_back(std::move(name), part.weight);
        }
      }
      const bool complete = std::all_of(coefficients.begin(), coefficients.end(),
                                        [&](const auto& c) { return face_.Has(c.first); });
      if (complete) AddShapes(region, feed, face_.Weights(coefficients), gain);
    }
  }

  CollectedPoses Take() {
    if (!missing_.empty()) {
      Note("no shape of the character means " + Joined(missing_) +
           "; only strokes can give these folds");
    }
    return std::move(found_);
  }

 private:
  // The largest gain with which a blend shape feeds a map; 0 if it does not.
  [[nodiscard]] float GainOf(const wrinkle::Feed& feed, const std::string& shape) const {
    float gain = 0.0f;
    for (const wrinkle::Feed::Source& source : feed.sources) {
      const Driver* driver = FindDriver(character_.rig, source.driver);
      if (driver == nullptr || driver->kind != Driver::Kind::kBlendShape) continue;
      if (!EqualsIgnoreCase(driver->blend_shape.blend_shape, shape)) continue;
      gain = std::max(gain, source.gain);
    }
    return gain;
  }

  void AddShape(const wrinkle::Region& region, const wrinkle::Feed& feed,
                const wrinkle::Feed::Source& source, const wrinkle::BlendShapeDriver& driver) {
    if (!face_.Has(driver.blend_shape)) {
      missing_.insert(driver.blend_shape);
      return;
    }
    if (source.gain < kLeastShapeGain) return;
    // Where the driver reaches 1. Coefficients beyond 1 are not a face.
    const bool usual = driver.full > 0.0f && driver.full <= 1.0f;
    const ArkitFace::Coefficient full(driver.blend_shape, usual ? driver.full : 1.0f);
    AddShapes(region, feed, face_.Weights(std::span(&full, 1)), source.gain);
  }

  // Poses the blend shapes of a reference pose, as a stream's are: by shapes of the character,
  // returned as their weights, or else by its joints.
  std::vector<float> PoseShapes(const wrinkle::ReferencePose& pose, std::span<Transform> locals) {
    std::vector<ArkitFace::Coefficient> by_shapes;
    std::vector<std::string> by_joints;
    std::vector<float> coefficients;
    for (const wrinkle::ShapeValue& shape : pose.shapes) {
      if (face_.Has(shape.blend_shape)) {
        by_shapes.emplace_back(shape.blend_shape, shape.value);
      } else {
        by_joints.push_back(shape.blend_shape);
        coefficients.push_back(shape.value);
      }
    }
    std::string lacking;
    for (std::size_t i = 0; i < by_joints.size(); ++i) {
      const auto one = wrinkle::BlendShapePose::Create(character_.rig, character_.skeleton,
                                                       std::span(by_joints).subspan(i, 1));
      // The rig is checked, and `locals` has all joints.
      (void)one.Run(std::span(coefficients).subspan(i, 1), locals);
      if (one.empty()) lacking += (lacking.empty() ? "" : ", ") + by_joints[i];
    }
    if (!lacking.empty()) {
      Note("reference pose '" + pose.name + "' names blend shapes that move nothing on this " +
           "character: " + lacking);
    }
    return by_shapes.empty() ? std::vector<float>() : face_.DrawnWeights(by_shapes);
  }

  void AddShapes(const wrinkle::Region& region, const wrinkle::Feed& feed,
                 std::vector<float> weights, float gain) {
    const auto rest = character_.skeleton.rest_pose();
    found_.poses.push_back(
        {.map = feed.map,
         .region = region.name,
         .skin_matrices = SkinMatrices(std::vector<Transform>(rest.begin(), rest.end())),
         .shape_weights = std::move(weights),
         .weight = std::min(gain, 1.0f)});
  }

  // A pose driver at rest is a mistake of the rig, unless the character lacks the blend shapes of
  // the pose. Other drivers have values without a pose, for which folds must be drawn.
  Status AtRest(const Driver& driver, const std::string& value,
                const wrinkle::ReferencePose& pose) {
    if (driver.kind == Driver::Kind::kPose && !pose.shapes.empty()) {
      Note(value + " has no pose on this character; only strokes can give it folds");
      return {};
    }
    if (driver.kind == Driver::Kind::kPose) {
      return {StatusCode::kInvalidArgument,
              "reference pose '" + pose.name + "' equals the rest pose, so it cannot fold anything",
              {},
              "define how its joints move, or remove it from the rig"};
    }
    Note(value + " is the rest pose; only strokes can give it folds");
    return {};
  }

  // The angle of a source where the feed has its largest weight: for the first source, the first
  // such angle; for others, the angle of the same value. Nothing if the feed states no angles, or
  // the source has none.
  [[nodiscard]] std::optional<float> AngleOf(const wrinkle::Feed& feed,
                                             const wrinkle::Feed::Source& source) const {
    if (feed.angles.empty()) return std::nullopt;
    const float degrees = std::ranges::max_element(feed.angles, {}, &wrinkle::CurvePoint::y)->x;
    const wrinkle::Feed::Source& first = feed.sources.front();
    if (&source == &first) return degrees;
    const Driver* driver = FindDriver(character_.rig, first.driver);
    const Driver* own = FindDriver(character_.rig, source.driver);
    if (driver == nullptr || own == nullptr) return std::nullopt;
    const auto value = wrinkle::DriverValueAtAngle(*driver, first.value, degrees);
    const auto at = [&](float angle) {
      return wrinkle::DriverValueAtAngle(*own, source.value, angle);
    };
    if (!value || !at(0.0f)) return std::nullopt;
    const float wanted = std::min(first.gain * *value / source.gain, 1.0f);
    const bool rises = *at(0.0f) < *at(180.0f);
    float low = 0.0f, high = 180.0f;
    for (int k = 0; k < kBisections; ++k) {
      const float middle = 0.5f * (low + high);
      ((*at(middle) < wanted) == rises ? low : high) = middle;
    }
    return high;
  }

  // Straight limbs are one pose, whichever side they would bend to.
  void AddPose(BakePose pose) {
    const auto found = std::ranges::find_if(found_.poses, [&](const BakePose& other) {
      return other.map == pose.map && other.region == pose.region &&
             other.skin_matrices == pose.skin_matrices && other.shape_weights == pose.shape_weights;
    });
    if (found == found_.poses.end()) {
      found_.poses.push_back(std::move(pose));
    } else {
      found->weight = std::max(found->weight, pose.weight);
    }
  }

  // Equal steps of at most kStepAngle from the pose that the clothes were cut for to `pose`. Joints
  // that `pose` does not name stay as they were.
  [[nodiscard]] std::vector<std::vector<glm::mat4>> PathTo(
      const wrinkle::ReferencePose& pose) const {
    wrinkle::ReferencePose from = fit_, to = pose;
    for (const wrinkle::JointDelta& delta : to.joints) {
      if (!Moves(from, delta.joint)) from.joints.push_back({.joint = delta.joint});
    }
    for (const wrinkle::JointDelta& delta : fit_.joints) {
      if (!Moves(to, delta.joint)) to.joints.push_back(delta);
    }
    float largest = 0.0f;
    for (const wrinkle::JointDelta& delta : to.joints) {
      const glm::quat turn = glm::conjugate(DeltaOf(from, delta.joint).rotation) * delta.rotation;
      largest = std::max(largest, 2.0f * std::acos(std::min(std::abs(turn.w), 1.0f)));
    }
    const int steps = std::max(static_cast<int>(std::ceil(largest / kStepAngle)), 1);
    std::vector<std::vector<glm::mat4>> path;
    for (int k = 0; k <= steps; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      wrinkle::ReferencePose part = to;
      for (wrinkle::JointDelta& delta : part.joints) {
        const wrinkle::JointDelta& begin = DeltaOf(from, delta.joint);
        delta.rotation = glm::slerp(begin.rotation, delta.rotation, t);
        delta.translation = glm::mix(begin.translation, delta.translation, t);
        delta.unscaled_translation =
            glm::mix(begin.unscaled_translation, delta.unscaled_translation, t);
      }
      std::vector<Transform> locals(character_.skeleton.rest_pose().begin(),
                                    character_.skeleton.rest_pose().end());
      // A joint that the skeleton lacks leaves the rest pose, which has no folds. The joints of the
      // pose itself have been found before.
      static_cast<void>(wrinkle::ApplyReferencePose(part, character_.skeleton, locals));
      path.push_back(SkinMatrices(locals));
    }
    return path;
  }

  // Parents precede children, so one pass in place turns local into model matrices.
  std::vector<glm::mat4> SkinMatrices(std::span<const Transform> locals) const {
    std::vector<glm::mat4> matrices(locals.size());
    for (std::size_t i = 0; i < locals.size(); ++i) {
      matrices[i] = wrinkle::ToMatrix(locals[i]);
      const int parent = character_.skeleton.joint_parents()[i];
      if (parent >= 0) matrices[i] = matrices[static_cast<std::size_t>(parent)] * matrices[i];
    }
    for (std::size_t i = 0; i < matrices.size(); ++i) {
      matrices[i] = matrices[i] * character_.inverse_bind_matrices[i];
    }
    return matrices;
  }

  // Many feeds share a driver; each note appears once.
  void Note(const std::string& note) {
    if (std::find(found_.notes.begin(), found_.notes.end(), note) == found_.notes.end()) {
      found_.notes.push_back(note);
    }
  }

  const character::Character& character_;
  const ArkitFace& face_;
  wrinkle::ReferencePose fit_;  // the rest pose if the rig has none
  CollectedPoses found_;
  std::set<std::string> missing_;  // blend shapes of drivers
};

Status CheckMaps(const Rig& rig, std::span<const std::string> maps) {
  const std::string known = Joined(rig.wrinkle_maps, &wrinkle::WrinkleMap::name);
  for (const std::string& wanted : maps) {
    const auto named = [&](const wrinkle::WrinkleMap& map) { return map.name == wanted; };
    if (std::any_of(rig.wrinkle_maps.begin(), rig.wrinkle_maps.end(), named)) continue;
    return {StatusCode::kNotFound,
            "the rig has no wrinkle map '" + wanted + "'",
            {},
            "available maps: " + known};
  }
  return {};
}

}  // namespace

Result<CollectedPoses> CollectBakePoses(const character::Character& character,
                                        std::span<const std::string> maps) {
  return CollectBakePoses(character, maps, ArkitFace(character, rig::ShapeMatcher()));
}

Result<CollectedPoses> CollectBakePoses(const character::Character& character,
                                        std::span<const std::string> maps, const ArkitFace& face) {
  const Rig& rig = character.rig;
  if (rig.wrinkle_maps.empty() || rig.regions.empty()) {
    return Status(StatusCode::kNotFound, "the character has no wrinkle rig with regions and maps",
                  {}, "add one with --rig");
  }
  FURROW_RETURN_IF_ERROR(CheckMaps(rig, maps));
  PoseCollector collector(character, face);
  for (std::size_t r = 0; r < rig.regions.size(); ++r) {
    const wrinkle::Region& region = rig.regions[r];
    for (std::size_t f = 0; f < region.feeds.size(); ++f) {
      const wrinkle::Feed& feed = region.feeds[f];
      if (!Wants(maps, feed.map)) continue;
      for (std::size_t s = 0; s < feed.sources.size(); ++s) {
        if (!(feed.sources[s].gain > 0.0f)) continue;
        const Status status = collector.Add(region, feed, feed.sources[s]);
        if (!status.ok()) {
          return status.At(FieldAt(FieldAt("regions", r) + ".feeds", f) + FieldAt(".sources", s));
        }
      }
      collector.AddCombinations(region, feed);
    }
  }
  return collector.Take();
}

}  // namespace furrow::authoring
