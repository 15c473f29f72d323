// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_cases.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "base/ascii.h"
#include "base/scalar.h"
#include "tests/unit/render/test_character.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/full_pose.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::observer {
namespace {

using character::Character;
using wrinkle::Driver;
using wrinkle::Feed;
using wrinkle::Rig;

constexpr float kLeastBendDegrees = 20.0f;
constexpr float kMiddle = 0.02f;  // metres: half the width of the strip that is on no side

bool IsCloth(const Rig& rig, const Feed& feed) {
  const auto map = std::ranges::find(rig.wrinkle_maps, feed.map, &wrinkle::WrinkleMap::name);
  return map != rig.wrinkle_maps.end() && map->surface == wrinkle::WrinkleMap::Surface::kCloth;
}

const Driver* FindDriver(const Rig& rig, const std::string& name) {
  const auto driver = std::ranges::find(rig.drivers, name, &Driver::name);
  return driver == rig.drivers.end() ? nullptr : &*driver;
}

// Calls `function` with each region's index, feed and index of the feed's wrinkle weight.
template <class Function>
void ForEachFeed(const Rig& rig, const Function& function) {
  std::size_t weight = 0;
  for (std::size_t region = 0; region < rig.regions.size(); ++region) {
    for (const Feed& feed : rig.regions[region].feeds) function(region, feed, weight++);
  }
}

std::size_t NumWeights(const Rig& rig) {
  std::size_t count = 0;
  for (const wrinkle::Region& region : rig.regions) count += region.feeds.size();
  return count;
}

Result<wrinkle::LocalPose> PoseOf(const Character& character, const wrinkle::ReferencePose& full) {
  wrinkle::LocalPose pose;
  pose.SetRest(character.skeleton);
  FURROW_RETURN_IF_ERROR(wrinkle::ApplyReferencePose(full, character.skeleton, pose.joints));
  return pose;
}

// The character's shape of a blend-shape driver at full strength; empty without such a shape.
std::vector<float> ShapesOf(const Character& character, const Driver& driver) {
  if (driver.kind != Driver::Kind::kBlendShape) return {};
  const auto shape = std::ranges::find_if(character.shapes, [&](const std::string& name) {
    return EqualsIgnoreCase(name, driver.blend_shape.blend_shape);
  });
  if (shape == character.shapes.end()) return {};
  std::vector<float> weights(character.shapes.size());
  weights[static_cast<std::size_t>(shape - character.shapes.begin())] = driver.blend_shape.full;
  return weights;
}

// The full pose of the strongest source that has one; the rest pose if none does. `shapes` receives
// the weights of the character's shapes, if they pose it.
Result<wrinkle::LocalPose> PoseOf(const Character& character, const Feed& feed,
                                  std::vector<float>* shapes) {
  std::vector<Feed::Source> sources = feed.sources;
  std::ranges::stable_sort(sources, std::ranges::greater(), &Feed::Source::gain);
  for (const Feed::Source& source : sources) {
    const Driver* driver = FindDriver(character.rig, source.driver);
    if (driver == nullptr) continue;
    *shapes = ShapesOf(character, *driver);
    if (!shapes->empty()) break;
    const auto full = wrinkle::FullPose(character.rig, *driver, source.value, character.skeleton);
    if (full.status().code() == StatusCode::kUnsupported) continue;
    FURROW_RETURN_IF_ERROR(full);
    return PoseOf(character, *full);
  }
  return PoseOf(character, wrinkle::ReferencePose());
}

bool Bends(const wrinkle::Skeleton& skeleton, const wrinkle::LocalPose& pose) {
  const float least = std::sin(0.5f * kLeastBendDegrees * kDegrees);  // of a quaternion's vector
  for (std::size_t joint = 0; joint < pose.joints.size(); ++joint) {
    const glm::quat turn =
        glm::conjugate(skeleton.rest_pose()[joint].rotation) * pose.joints[joint].rotation;
    if (glm::length(glm::vec3(turn.x, turn.y, turn.z)) >= least) return true;
  }
  return false;
}

int SideOf(const wrinkle::Skeleton& skeleton, const wrinkle::ReferencePose& pose) {
  float sum = 0.0f;
  for (const wrinkle::JointDelta& delta : pose.joints) {
    const int joint = skeleton.Find(delta.joint);
    if (joint != wrinkle::kNoJoint) sum += skeleton.rest_model()[joint][3].x;
  }
  return std::abs(sum) < kMiddle ? 0 : sum > 0.0f ? 1 : -1;
}

// Finds the bends of one driver.
class BendFinder {
 public:
  BendFinder(const Character& character, const Driver& driver)
      : character_(character), driver_(driver) {
    ForEachFeed(character.rig, [&](std::size_t region, const Feed& feed, std::size_t) {
      if (IsCloth(character.rig, feed) && Reads(feed, {}) &&
          (regions_.empty() || regions_.back() != region)) {
        regions_.push_back(region);
      }
    });
  }

  // Adds the bend of a value, unless it is none.
  Status Add(const std::string& value, render::test::Subject* subject, std::vector<FoldCase>* cases,
             std::vector<std::string>* unfolded) const {
    bool feeds = false;
    std::optional<float> degrees;  // where the folds end, if their feeds state it
    ForEachFeed(character_.rig, [&](std::size_t, const Feed& feed, std::size_t) {
      if (!IsCloth(character_.rig, feed) || !Reads(feed, value)) return;
      feeds = true;
      const Feed::Source& first = feed.sources.front();
      if (feed.angles.empty() || first.driver != driver_.name || first.value != value) return;
      // A straight limb is straight, whatever its value says.
      if (feed.angles.back().y < feed.angles.front().y && value == "extended") return;
      degrees = std::max(degrees.value_or(0.0f), feed.angles.back().x);
    });
    if (!feeds) return {};
    const auto full =
        wrinkle::FullPose(character_.rig, driver_, value, character_.skeleton, degrees);
    if (full.status().code() == StatusCode::kUnsupported) return {};
    FURROW_RETURN_IF_ERROR(full);
    Result<wrinkle::LocalPose> pose = PoseOf(character_, *full);
    FURROW_RETURN_IF_ERROR(pose);
    if (!Bends(character_.skeleton, *pose)) return {};
    FoldCase bend{.name = driver_.name + "." + value,
                  .regions = regions_,
                  .pose = std::move(*pose),
                  .side = SideOf(character_.skeleton, *full)};
    subject->pose.joints = bend.pose.joints;
    subject->Solve();
    bend.wrinkle_weights = OfRegions(subject->weights);
    const bool folds =
        std::ranges::any_of(bend.wrinkle_weights, [](float weight) { return weight > 0.0f; });
    if (folds) {
      cases->push_back(std::move(bend));
    } else if (unfolded != nullptr) {
      unfolded->push_back(bend.name);
    }
    return {};
  }

 private:
  // An empty value: any value of the driver.
  [[nodiscard]] bool Reads(const Feed& feed, const std::string& value) const {
    return std::ranges::any_of(feed.sources, [&](const Feed::Source& source) {
      return source.driver == driver_.name && source.gain > 0.0f &&
             (value.empty() || source.value == value);
    });
  }

  [[nodiscard]] std::vector<float> OfRegions(const std::vector<float>& weights) const {
    std::vector<float> kept(weights.size());
    ForEachFeed(character_.rig, [&](std::size_t region, const Feed& feed, std::size_t weight) {
      if (IsCloth(character_.rig, feed) && std::ranges::count(regions_, region) > 0) {
        kept[weight] = weights[weight];
      }
    });
    return kept;
  }

  const Character& character_;
  const Driver& driver_;
  std::vector<std::size_t> regions_;
};

}  // namespace

Result<std::vector<FoldCase>> FaceCases(const Character& character) {
  std::vector<FoldCase> cases;
  Status failure;
  ForEachFeed(character.rig, [&](std::size_t region, const Feed& feed, std::size_t weight) {
    if (IsCloth(character.rig, feed) || !failure.ok()) return;
    std::vector<float> shapes;
    Result<wrinkle::LocalPose> pose = PoseOf(character, feed, &shapes);
    if (!pose.ok()) {
      failure = pose.status();
      return;
    }
    FoldCase one{.name = character.rig.regions[region].name + "." + feed.map,
                 .regions = {region},
                 .pose = std::move(*pose),
                 .shapes = std::move(shapes),
                 .wrinkle_weights = std::vector<float>(NumWeights(character.rig))};
    one.wrinkle_weights[weight] = 1.0f;
    cases.push_back(std::move(one));
  });
  if (!failure.ok()) return failure;
  return cases;
}

Result<std::vector<FoldCase>> BendCases(const Character& character,
                                        std::vector<std::string>* unfolded) {
  std::vector<FoldCase> cases;
  render::test::Subject subject(character);
  for (const Driver& driver : character.rig.drivers) {
    const BendFinder finder(character, driver);
    for (const std::string& value : wrinkle::DriverValueNames(driver)) {
      FURROW_RETURN_IF_ERROR(finder.Add(value, &subject, &cases, unfolded));
    }
  }
  return cases;
}

}  // namespace furrow::observer
