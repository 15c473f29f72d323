// SPDX-License-Identifier: Apache-2.0
// Levels of detail: requested outputs are the same as with all drivers.
#include "wrinkle/solver/driver_level.h"

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/solver/batch_solver.h"

namespace furrow::wrinkle {
namespace {

constexpr double kFrame = 1.0 / 60.0;

std::shared_ptr<const RigBinding> BindShared(const Rig& rig) {
  return BoundRig(rig, MakeBody(3)).binding();
}

std::uint32_t IndexOf(std::span<const std::string> names, std::string_view name) {
  return static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
}

TEST(DriverLevel, NothingNeedsNoDriverAndEverythingAll) {
  const Rig rig = MakeRig();
  const auto binding = BindShared(rig);
  EXPECT_EQ(DriversOfWeights(*binding, {}), 0u);
  EXPECT_EQ(DriversOfValues(*binding, {}), 0u);
  std::vector<std::uint32_t> values(binding->driver_value_names().size());
  for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = i;
  EXPECT_EQ(DriversOfValues(*binding, values), rig.drivers.size());
}

TEST(DriverLevel, AValueNeedsTheDriversUpToItsOwn) {
  const Rig rig = MakeRig();
  const auto binding = BindShared(rig);
  const auto names = binding->driver_value_names();
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    const std::string driver = names[i].substr(0, names[i].find('.'));
    const auto own = std::ranges::find(rig.drivers, driver, &Driver::name) - rig.drivers.begin();
    EXPECT_EQ(DriversOfValues(*binding, {&i, 1}), static_cast<std::size_t>(own) + 1) << names[i];
  }
}

TEST(DriverLevel, AWeightNeedsWhatItGivesWayTo) {
  Rig rig = MakeRig();
  const auto binding = BindShared(rig);
  rig.regions[0].neighbours.clear();
  const auto alone = BindShared(rig);
  const std::uint32_t brow = IndexOf(binding->weight_names(), "brow_l.squash");
  ASSERT_LT(brow, binding->weight_names().size());
  EXPECT_EQ(DriversOfWeights(*alone, {&brow, 1}), 1u);
  EXPECT_EQ(DriversOfWeights(*binding, {&brow, 1}), 2u) << "brow_r's stretch opposes it";
}

// Drivers in any order, any weights.
TEST(DriverLevel, WeightsThatAreAskedForAreTheSameToTheBit) {
  std::mt19937 random(11);
  for (int round = 0; round < 40; ++round) {
    Rig rig = MakeRig();
    std::shuffle(rig.drivers.begin(), rig.drivers.end(), random);
    const auto binding = BindShared(rig);
    std::vector<std::uint32_t> asked;
    for (std::uint32_t i = 0; i < binding->weight_names().size(); ++i) {
      if (random() % 4 == 0) asked.push_back(i);
    }
    SubjectSolver whole(binding);
    SubjectSolver cut(binding);
    cut.set_num_drivers(DriversOfWeights(*binding, asked));
    LocalPose pose;
    for (int frame = 0; frame < 10; ++frame) {
      RandomPose(binding->skeleton(), &random, &pose);
      BatchUpdate updates[] = {{.solver = &whole, .pose = &pose, .dt = kFrame},
                               {.solver = &cut, .pose = &pose, .dt = kFrame}};
      BatchSolver().Run(updates);
      for (const std::uint32_t i : asked) {
        EXPECT_EQ(cut.wrinkle_weights()[i], whole.wrinkle_weights()[i])
            << binding->weight_names()[i];
      }
    }
  }
}

class LevelChange : public testing::Test {
 protected:
  LevelChange() {
    std::mt19937 random(5);
    for (LocalPose& pose : poses_) RandomPose(binding_->skeleton(), &random, &pose);
    for (const LocalPose& pose : poses_) EXPECT_EQ(Update(&solver_, pose, kFrame), JobStatus::kOk);
  }
  JobStatus Update(SubjectSolver* solver, const LocalPose& pose, double dt) {
    BatchUpdate update{.solver = solver, .pose = &pose, .dt = dt};
    batch_.Run({&update, 1});
    return update.status;
  }
  std::vector<float> Filtered() const {
    return {solver_.filtered_values().begin(), solver_.filtered_values().end()};
  }
  void SetLevel(std::size_t count) {
    EXPECT_EQ(solver_.SetLevel(poses_.back(), count), JobStatus::kOk);
  }

  BatchSolver batch_;
  const std::shared_ptr<const RigBinding> binding_ = BindShared(MakeRig());
  std::vector<LocalPose> poses_ = std::vector<LocalPose>(5);
  SubjectSolver solver_ = [this] {
    SubjectSolver solver(binding_);
    solver.set_num_drivers(2);  // brow_l, brow_r: two values each
    return solver;
  }();
};

TEST_F(LevelChange, DriversThatJoinBeginAtThePoseAndTheOthersStay) {
  const std::vector<float> before = Filtered();
  SetLevel(kAllDrivers);
  SubjectSolver fresh(binding_);  // this is its first pose
  ASSERT_EQ(Update(&fresh, poses_.back(), 0.0), JobStatus::kOk);
  float joined = 0.0f;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(solver_.filtered_values()[i], i < 4 ? before[i] : fresh.filtered_values()[i]);
    if (i >= 4) joined += fresh.filtered_values()[i];
  }
  EXPECT_GT(joined, 0.1f) << "the pose moves none of them";
  // They stay while the pose stays.
  const std::vector<float> after = Filtered();
  ASSERT_EQ(Update(&solver_, poses_.back(), kFrame), JobStatus::kOk);
  for (std::size_t i = 4; i < after.size(); ++i) {
    EXPECT_NEAR(solver_.filtered_values()[i], after[i], 1e-6f);
  }
}

// A subject that was always evaluated in full has the same bits in the same pose.
TEST_F(LevelChange, TheWeightsAreThoseOfTheNewValues) {
  solver_.Reset();
  ASSERT_EQ(Update(&solver_, poses_.back(), 0.0), JobStatus::kOk);
  SetLevel(kAllDrivers);
  SubjectSolver whole(binding_);
  ASSERT_EQ(Update(&whole, poses_.back(), 0.0), JobStatus::kOk);
  EXPECT_TRUE(std::ranges::equal(whole.wrinkle_weights(), solver_.wrinkle_weights()));
  EXPECT_TRUE(std::ranges::equal(whole.driver_values(), solver_.driver_values()));
}

TEST_F(LevelChange, WithoutPosesASubjectKeepsDecaying) {
  ASSERT_EQ(solver_.Decay(0.1), JobStatus::kOk);
  const std::vector<float> before = Filtered();
  SetLevel(kAllDrivers);
  EXPECT_EQ(Filtered(), before);
}

}  // namespace
}  // namespace furrow::wrinkle
