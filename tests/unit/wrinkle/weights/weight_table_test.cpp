// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/weight_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "tests/unit/wrinkle/oracle/combine.h"
#include "wrinkle/solver/explain.h"

namespace furrow::wrinkle {
namespace {

TEST(CombineSources, GivesTheWorkedValues) {
  const std::vector<float> values = {0.9f, 0.2f, 0.5f};
  const std::vector<WeightSource> sources = {{1, 2.0f}, {2, 0.5f}};  // terms 0.4 and 0.25
  EXPECT_FLOAT_EQ(CombineSources(Combine::kMax, sources, values), 0.4f);
  EXPECT_FLOAT_EQ(CombineSources(Combine::kSum, sources, values), 0.65f);
  EXPECT_FLOAT_EQ(CombineSources(Combine::kMean, sources, values), 0.65f / 2.5f);
  const std::vector<WeightSource> strong = {{0, 3.0f}, {2, 1.0f}};
  EXPECT_EQ(CombineSources(Combine::kMax, strong, values), 1.0f);
  EXPECT_EQ(CombineSources(Combine::kSum, strong, values), 1.0f);
  EXPECT_FLOAT_EQ(CombineSources(Combine::kMean, strong, values), 3.2f / 4.0f);
}

// The same worked values from the solver: three blend shapes feed one region.
TEST(WrinkleWeights, AreCombinedAsWorked) {
  const auto weight = [](Combine combine, std::vector<Feed::Source> sources) {
    Rig rig;
    for (const char* name : {"a", "b", "c"}) {
      Driver& driver = rig.drivers.emplace_back();
      driver.name = name;
      driver.kind = Driver::Kind::kBlendShape;
      driver.blend_shape.blend_shape = name;
    }
    Region& region = rig.regions.emplace_back();
    region.name = "region";
    region.combine = combine;
    region.modulation = Modulation::kLinear;
    region.feeds = {{"map", std::move(sources)}};
    BoundRig bound(rig, Skeleton(), {"a", "b", "c"});
    LocalPose pose;
    pose.blend_shapes = {0.9f, 0.2f, 0.5f};
    bound.Solve(pose);
    return bound.Weight("region.map");
  };
  const std::vector<Feed::Source> sources = {{"b", "value", 2.0f}, {"c", "value", 0.5f}};
  EXPECT_FLOAT_EQ(weight(Combine::kMax, sources), 0.4f);
  EXPECT_FLOAT_EQ(weight(Combine::kSum, sources), 0.65f);
  EXPECT_FLOAT_EQ(weight(Combine::kMean, sources), 0.65f / 2.5f);
  const std::vector<Feed::Source> strong = {{"a", "value", 3.0f}, {"c", "value", 1.0f}};
  EXPECT_EQ(weight(Combine::kMax, strong), 1.0f);
  EXPECT_EQ(weight(Combine::kSum, strong), 1.0f);
  EXPECT_FLOAT_EQ(weight(Combine::kMean, strong), 3.2f / 4.0f);
}

// 4.2 as printed: clamp(sum of lambda_i theta(I_i)). Worked values of theta = (1 - cos(pi x)) / 2
// and of the cubic.
TEST(WrinkleWeights, SumOfModulatedSources) {
  Rig rig;
  std::vector<std::string> names;
  for (const char* name : {"a", "b", "c"}) {
    Driver& driver = rig.drivers.emplace_back();
    driver.name = name;
    driver.kind = Driver::Kind::kBlendShape;
    driver.blend_shape.blend_shape = name;
    names.push_back(name);
  }
  const auto add = [&](const char* name, Combine combine, Modulation modulation,
                       std::vector<Feed::Source> sources) {
    Region& region = rig.regions.emplace_back();
    region.name = name;
    region.combine = combine;
    region.modulation = modulation;
    region.feeds = {{.map = "map", .sources = std::move(sources)}};
  };
  constexpr Modulation kCosine = Modulation::kCosine;
  const std::vector<Feed::Source> both = {{"a", "value", 1.0f}, {"b", "value", 0.5f}};
  add("each", Combine::kSumModulated, kCosine, both);
  add("together", Combine::kSum, kCosine, both);
  add("cubic", Combine::kSumModulated, Modulation::kCubic, both);
  add("one", Combine::kSumModulated, kCosine, {{"a", "value", 1.0f}});
  add("largest", Combine::kMax, kCosine, both);
  add("over", Combine::kSumModulated, kCosine,
      {{"a", "value", 3.0f}, {"b", "value", 1.0f}, {"c", "value", 2.0f}});
  rig.regions[2].feeds.push_back({.map = "curve", .sources = both});
  rig.regions[2].feeds[1].curve = {{0.0f, 0.2f}, {1.0f, 0.4f}};  // 0.2 + x / 5
  BoundRig bound(rig, Skeleton(), names);
  LocalPose pose;
  pose.blend_shapes = {0.25f, 0.5f, 0.75f};
  bound.Solve(pose);
  // theta(0.25) = (1 - sqrt(1/2)) / 2, theta(0.5) = 1/2
  EXPECT_NEAR(bound.Weight("each.map"), 0.1464466f + 0.25f, 1e-6f);
  EXPECT_NEAR(bound.Weight("together.map"), 0.5f, 1e-6f);  // theta(0.25 + 0.25)
  // 2.62235 / 4 - 4.87773 / 16 + 3.26168 / 64 = 0.4016934, and half of 0.4994525
  EXPECT_NEAR(bound.Weight("cubic.map"), 0.4016934f + 0.2497263f, 1e-6f);
  EXPECT_NEAR(bound.Weight("cubic.curve"), 0.25f + 0.5f * 0.3f, 1e-6f);
  EXPECT_NEAR(bound.Weight("one.map"), 0.1464466f, 1e-6f);
  EXPECT_NEAR(bound.Weight("largest.map"), 0.1464466f, 1e-6f);
  EXPECT_EQ(bound.Weight("over.map"), 1.0f);  // 0.44 + 0.5 + 1.71
  // The parts of an explanation add up to the weight.
  Explanation explanation;
  ASSERT_EQ(Explain(*bound.binding(), pose, &explanation), JobStatus::kOk);
  const Explanation::Weight& each = explanation.weights[0];
  EXPECT_NEAR(each.contributions[0].modulated, 0.1464466f, 1e-6f);
  EXPECT_NEAR(each.contributions[0].product, 0.1464466f, 1e-6f);
  EXPECT_NEAR(each.contributions[1].product, 0.25f, 1e-6f);
  EXPECT_NEAR(each.modulated, each.contributions[0].product + each.contributions[1].product, 1e-6f);
  EXPECT_EQ(explanation.weights[1].contributions[0].modulated, 0.25f);
}

// Weights of driver values alone: four blend shapes feed two opposed maps of two neighbours, "l"
// and "r", and of "far", which borders on neither.
Rig BrowRig(Modulation modulation = Modulation::kLinear) {
  Rig rig;
  rig.wrinkle_maps = {{.name = "stretch"}, {.name = "squash", .opposes = "stretch"}};
  for (const std::string region : {"l", "r", "far"}) {
    Region r;
    r.name = region;
    r.modulation = modulation;
    for (const std::string map : {"stretch", "squash"}) {
      Driver driver;
      driver.name = region + "_" + map;
      driver.kind = Driver::Kind::kBlendShape;
      driver.blend_shape.blend_shape = driver.name;
      rig.drivers.push_back(driver);
      r.feeds.push_back({.map = map, .sources = {{driver.name, "value"}}});
    }
    rig.regions.push_back(r);
  }
  rig.regions[1].neighbours = {"l"};  // said by one side of the border alone
  return rig;
}

class Incongruence : public testing::Test {
 protected:
  // Values in the order l.stretch, l.squash, r.stretch, r.squash, far.stretch, far.squash.
  std::vector<float> Weights(std::vector<float> values) {
    LocalPose pose;
    pose.blend_shapes = std::move(values);
    rig_.Solve(pose);
    return rig_.weights();
  }
  BoundRig rig_{BrowRig(),
                Skeleton(),
                {"l_stretch", "l_squash", "r_stretch", "r_squash", "far_stretch", "far_squash"}};
};

TEST_F(Incongruence, LeavesAgreementAlone) {
  const std::vector<float> values = {0.9f, 0.0f, 0.8f, 0.0f, 0.0f, 1.0f};
  EXPECT_EQ(Weights(values), values);
}

TEST_F(Incongruence, AttenuatesTheWeakerOfOpposedNeighbours) {
  const std::vector<float> weights = Weights({0.9f, 0.0f, 0.0f, 0.25f, 0.0f, 1.0f});
  EXPECT_NEAR(weights[0], 0.9f, 1e-6f);
  EXPECT_NEAR(weights[3], 0.0f, 1e-6f);
  EXPECT_EQ(weights[5], 1.0f);  // far away
}

TEST_F(Incongruence, SettlesATieAtHalfEach) {
  const std::vector<float> weights = Weights({0.0f, 0.8f, 0.8f, 0.0f, 0.0f, 0.0f});
  EXPECT_FLOAT_EQ(weights[1], 0.4f);
  EXPECT_FLOAT_EQ(weights[2], 0.4f);
}

TEST_F(Incongruence, LetsOneRegionMixItsOwnMaps) {
  const std::vector<float> values = {0.6f, 0.5f, 0.0f, 0.0f, 0.7f, 0.7f};
  EXPECT_EQ(Weights(values), values);
}

TEST_F(Incongruence, AtMostOneDominatesAndNothingJumpsInTime) {
  std::vector<float> before;
  float worst = 0.0f;
  for (int i = 0; i <= 20000; ++i) {
    const float t = static_cast<float>(i) * 1e-3f;
    const auto wave = [&](float rate) { return 0.5f + 0.5f * std::sin(rate * t); };
    const std::vector<float> weights =
        Weights({wave(1.0f), wave(1.3f), wave(1.7f), wave(2.1f), 0.0f, 0.0f});
    EXPECT_LE(std::min(weights[0], weights[3]), 0.5f + 1e-6f);
    EXPECT_LE(std::min(weights[1], weights[2]), 0.5f + 1e-6f);
    for (std::size_t k = 0; k < before.size(); ++k) {
      worst = std::max(worst, std::abs(weights[k] - before[k]));
    }
    before = weights;
  }
  std::printf("incongruence: at most %.6f for inputs that move %.6f\n", worst, 1.05e-3);
  EXPECT_LE(worst, 5e-3f);
}

// Worked values of the cubic: 0.4994525 at 1/2, and 1 where the printed formula leaves the range.
TEST(WrinkleWeights, CubicGivesTheWorkedValues) {
  BoundRig rig(BrowRig(Modulation::kCubic), Skeleton(),
               {"l_stretch", "l_squash", "r_stretch", "r_squash", "far_stretch", "far_squash"});
  LocalPose pose;
  pose.blend_shapes = {0.0f, 0.0f, 0.0f, 0.0f, 0.5f, 1.0f};
  rig.Solve(pose);
  EXPECT_NEAR(rig.Weight("far.stretch"), 0.4994525f, 1e-6f);
  EXPECT_EQ(rig.Weight("far.squash"), 1.0f);
}

TEST(WrinkleWeights, AreModulatedAfterCombining) {
  BoundRig rig(BrowRig(Modulation::kCosine), Skeleton(),
               {"l_stretch", "l_squash", "r_stretch", "r_squash", "far_stretch", "far_squash"});
  LocalPose pose;
  pose.blend_shapes = {0.0f, 0.0f, 0.0f, 0.0f, 0.25f, 0.0f};
  rig.Solve(pose);
  EXPECT_NEAR(rig.Weight("far.stretch"), 0.1464466f, 1e-6f);
}

TEST(JointInfluence, ReachesTheJointsOfSkinningRegions) {
  BoundRig rig(MakeRig(), MakeBody());
  LocalPose pose = RestPose(rig.skeleton());
  Turn(rig.skeleton(), "shin_l", AngleAxis(90.0f, {1, 0, 0}), &pose);
  Move(rig.skeleton(), "cheek_l", {0.0f, 0.02f, 0.005f}, &pose);
  Turn(rig.skeleton(), "neck", AngleAxis(45.0f, {0, 1, 0}), &pose);
  rig.Solve(pose);
  const auto masks = rig.binding()->dynamic_masks();
  ASSERT_EQ(masks.size(), 2u);  // of squash and of folds; stretch has no skinning region
  EXPECT_EQ(masks[0].map, 1);
  EXPECT_EQ(masks[1].map, 2);
  std::vector<float> influences(rig.skeleton().num_joints() * masks.size(), -1.0f);
  const JointInfluenceJob job{
      .binding = rig.binding().get(), .driver_values = rig.values(), .influences = influences};
  ASSERT_EQ(job.Run(), JobStatus::kOk);
  const auto at = [&](const char* joint, std::size_t mask) {
    return influences[static_cast<std::size_t>(rig.skeleton().Find(joint)) * masks.size() + mask];
  };
  EXPECT_NEAR(at("cheek_l", 0), 1.0f, 1e-5f);
  EXPECT_NEAR(at("shin_l", 1), rig.Weight("knee_l_inner.folds"), 1e-6f);
  EXPECT_NEAR(at("neck", 1), 0.5f, 1e-4f);  // cosine of half way
  EXPECT_NEAR(at("neck_upper", 1), 0.5f, 1e-4f);
  EXPECT_EQ(at("brow_l", 0), 0.0f);  // a texture region's
  EXPECT_EQ(std::count_if(influences.begin(), influences.end(), [](float f) { return f != 0.0f; }),
            4);
}

// Each region has its own lambda, even if another region uses the same map.
TEST(JointInfluence, HasAColumnForEveryMapAndLambda) {
  Rig rig = MakeRig();
  const auto region = [&](const char* name) {
    return std::find_if(rig.regions.begin(), rig.regions.end(),
                        [&](const Region& candidate) { return candidate.name == name; });
  };
  region("neck_left")->mask.lambda = LambdaMode::kLinear;
  region("neck_left")->mask.smooth_width = 0.7f;  // says nothing about a linear one
  BoundRig bound(rig, MakeBody());
  const auto masks = bound.binding()->dynamic_masks();
  ASSERT_EQ(masks.size(), 3u);
  EXPECT_EQ(masks[1], (DynamicMask{2, LambdaMode::kSmooth, 0.25f}));
  EXPECT_EQ(masks[2], (DynamicMask{2, LambdaMode::kLinear, 0.25f}));
  LocalPose pose = RestPose(bound.skeleton());
  Turn(bound.skeleton(), "neck", AngleAxis(45.0f, {0, 1, 0}), &pose);
  bound.Solve(pose);
  std::vector<float> influences(bound.skeleton().num_joints() * masks.size());
  const JointInfluenceJob job{
      .binding = bound.binding().get(), .driver_values = bound.values(), .influences = influences};
  ASSERT_EQ(job.Run(), JobStatus::kOk);
  const std::size_t neck = static_cast<std::size_t>(bound.skeleton().Find("neck")) * masks.size();
  EXPECT_EQ(influences[neck + 1], 0.0f);
  EXPECT_NEAR(influences[neck + 2], 0.5f, 1e-4f);
}

}  // namespace
}  // namespace furrow::wrinkle
