// SPDX-License-Identifier: Apache-2.0
// The rigs that ship, on recordings: their weights depend neither on the unit of length nor much on
// the frame rate.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/recordings/recordings.h"
#include "motion/clip/resample.h"
#include "motion/clip_file.h"
#include "motion/pose_source.h"
#include "rig/rig_file.h"
#include "rig/skeleton_match.h"
#include "tests/unit/rig/shipped_matcher.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/skeleton/size_reference.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::rig {
namespace {

namespace fs = std::filesystem;
using motion::Clip;

const fs::path kRigs = fs::path(FURROW_SOURCE_DIR) / "rig/rigs";
const fs::path kData = FURROW_SHARED_DATA;

// The rig, or nullopt if it needs data that is not here.
std::optional<wrinkle::Rig> Shipped(const std::string& name) {
  const fs::path poses = kData / "makehuman/poseunits";
  if (name == "makehuman" && !fs::exists(poses)) return std::nullopt;
  setenv("FURROW_ASSET_PATH", poses.c_str(), 1);
  auto rig = LoadRig(kRigs / (name + ".json"), motion::CachedPoseSource());
  unsetenv("FURROW_ASSET_PATH");
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  return *std::move(rig);
}

Clip Generated(const std::string& name) {
  Clip clip;
  clip.skeleton = authoring::MakeSkeleton();
  const auto recording = authoring::MakeRecording(name, *Shipped("default"), clip.skeleton);
  EXPECT_TRUE(recording.ok()) << recording.status().ToString();
  for (const auto& frame : recording->frames) {
    clip.times.push_back(static_cast<double>(clip.times.size()) / authoring::kFramesPerSecond);
    clip.locals.insert(clip.locals.end(), frame.begin(), frame.end());
  }
  return clip;
}

// The clip in another unit of length.
Clip Scaled(const Clip& clip, float scale) {
  std::vector<wrinkle::JointDesc> joints;
  for (int i = 0; i < clip.skeleton.num_joints(); ++i) {
    wrinkle::JointDesc joint{clip.skeleton.joint_names()[i], clip.skeleton.joint_parents()[i],
                             clip.skeleton.rest_pose()[i], scale * clip.skeleton.tails()[i]};
    joint.rest.translation *= scale;
    joints.push_back(joint);
  }
  Clip scaled = clip;
  scaled.skeleton = *wrinkle::Skeleton::Create(std::move(joints));
  for (wrinkle::Transform& local : scaled.locals) local.translation *= scale;
  return scaled;
}

class ShippedRigs : public testing::Test {
 protected:
  void SetUp() override {
    auto matcher = ShippedMatcher();
    ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
    matcher_ = *std::move(matcher);
  }

  std::shared_ptr<const wrinkle::RigBinding> Bind(const wrinkle::Rig& rig, const Clip& clip) const {
    const SkeletonMatch match = matcher_.Match(clip.skeleton, rig, nullptr);
    auto binding = wrinkle::RigBinding::Create(rig, clip.skeleton, {}, match.Options(true));
    EXPECT_TRUE(binding.ok()) << binding.status().ToString();
    return std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
  }

  // The wrinkle weights of every `step`th frame, without filter.
  std::vector<float> Weights(const wrinkle::Rig& rig, const Clip& clip, int step) const {
    wrinkle::SubjectSolver solver(Bind(rig, clip), false);
    std::vector<float> weights;
    wrinkle::LocalPose pose;
    for (int frame = 0; frame < clip.num_frames(); frame += step) {
      clip.GetPose(frame, &pose);
      EXPECT_EQ(solver.Update(pose, 0.0), wrinkle::JobStatus::kOk);
      const auto now = solver.wrinkle_weights();
      weights.insert(weights.end(), now.begin(), now.end());
    }
    return weights;
  }

  // All driver values of every 7th frame, without filter.
  std::vector<float> Drivers(const wrinkle::Rig& rig, const Clip& clip) const {
    wrinkle::SubjectSolver solver(Bind(rig, clip), false);
    std::vector<float> values;
    wrinkle::LocalPose pose;
    for (int frame = 0; frame < clip.num_frames(); frame += 7) {
      clip.GetPose(frame, &pose);
      EXPECT_EQ(solver.Update(pose, 0.0), wrinkle::JobStatus::kOk);
      const auto now = solver.driver_values();
      values.insert(values.end(), now.begin(), now.end());
    }
    return values;
  }

  // The largest difference between two results of Drivers(), among the drivers that measure
  // lengths: pose and strain.
  float WorstOfFace(const wrinkle::Rig& rig, const Clip& clip, const std::vector<float>& expected,
                    const std::vector<float>& values) const {
    std::vector<bool> of_face;
    for (const wrinkle::Driver& driver : rig.drivers) {
      const bool measures = driver.kind == wrinkle::Driver::Kind::kPose ||
                            driver.kind == wrinkle::Driver::Kind::kStrain;
      of_face.insert(of_face.end(), wrinkle::DriverValueNames(driver).size(), measures);
    }
    EXPECT_EQ(values.size(), expected.size());
    EXPECT_EQ(Bind(rig, clip)->driver_value_names().size(), of_face.size());
    float worst = 0.0f;
    for (std::size_t i = 0; i < std::min(values.size(), expected.size()); ++i) {
      if (of_face[i % of_face.size()]) worst = std::max(worst, std::abs(values[i] - expected[i]));
    }
    return worst;
  }

  void ExpectSameInAnyUnit(const std::string& name, const wrinkle::Rig& rig, const Clip& clip,
                           int step = 7) const {
    const std::vector<float> expected = Weights(rig, clip, step);
    EXPECT_GT(*std::ranges::max_element(expected), 0.3f) << name;
    for (const float scale : {100.0f, 0.01f}) {
      const std::vector<float> scaled = Weights(rig, Scaled(clip, scale), step);
      float worst = 0.0f;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        worst = std::max(worst, std::abs(scaled[i] - expected[i]));
      }
      EXPECT_LE(worst, 1e-4f) << name << " scaled by " << scale;
    }
  }

  // Filtered driver values at 30 Hz, frame after frame, if the solver runs at `rate`.
  std::vector<float> FilteredAt(const wrinkle::Rig& rig, const Clip& clip, int rate) const {
    const Clip resampled = motion::Resample(clip, rate);
    wrinkle::SubjectSolver solver(Bind(rig, clip));
    std::vector<float> values;
    wrinkle::LocalPose pose;
    for (int frame = 0; frame < resampled.num_frames(); ++frame) {
      resampled.GetPose(frame, &pose);
      EXPECT_EQ(solver.Update(pose, frame == 0 ? 0.0 : 1.0 / rate), wrinkle::JobStatus::kOk);
      if (frame % (rate / 30) != 0) continue;
      const auto now = solver.filtered_values();
      values.insert(values.end(), now.begin(), now.end());
    }
    return values;
  }

  void ExpectAlmostSameAtAnyRate(const std::string& name, const wrinkle::Rig& rig,
                                 const Clip& clip) const {
    const std::vector<float> expected = FilteredAt(rig, clip, 240);
    for (const auto& [rate, bound] : {std::pair(30, 0.02f), {60, 0.01f}, {120, 0.003f}}) {
      const std::vector<float> values = FilteredAt(rig, clip, rate);
      float worst = 0.0f;
      for (std::size_t i = 0; i < std::min(values.size(), expected.size()); ++i) {
        worst = std::max(worst, std::abs(values[i] - expected[i]));
      }
      std::printf("filter: %s at %d Hz differs from 240 Hz by at most %.4f\n", name.c_str(), rate,
                  worst);
      EXPECT_LT(worst, bound) << name << " at " << rate << " Hz";
    }
  }

  SkeletonMatcher matcher_;
};

// A new rig has to be added to the tests below.
TEST_F(ShippedRigs, AreTheseFour) {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(kRigs)) {
    const std::string name = file.path().filename().string();
    if (name.find(".strokes.") == std::string::npos) names.push_back(name);
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("arkit.json", "cmu.json", "default.json",
                                                   "makehuman.json"));
}

TEST_F(ShippedRigs, DefaultHasTheSameWeightsInAnyUnit) {
  const wrinkle::Rig rig = *Shipped("default");
  for (const char* recording : {"performance", "squat"}) {
    ExpectSameInAnyUnit(recording, rig, Generated(recording));
  }
}

// A stream of the same performer with some of the joints.
Clip Reduced(const Clip& clip, const std::function<bool(const std::string&)>& keep) {
  const wrinkle::Skeleton& from = clip.skeleton;
  std::vector<wrinkle::JointDesc> joints;
  std::vector<int> kept;
  for (int i = 0; i < from.num_joints(); ++i) {
    if (!keep(from.joint_names()[i])) continue;
    const auto parent = std::ranges::find(kept, int{from.joint_parents()[i]});
    joints.push_back(
        {from.joint_names()[i],
         parent == kept.end() ? wrinkle::kNoJoint : static_cast<int>(parent - kept.begin()),
         from.rest_pose()[i], from.tails()[i]});
    kept.push_back(i);
  }
  Clip reduced;
  reduced.skeleton = *wrinkle::Skeleton::Create(std::move(joints));
  reduced.times = clip.times;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (const int joint : kept) {
      reduced.locals.push_back(
          clip.locals[static_cast<std::size_t>(frame * from.num_joints() + joint)]);
    }
  }
  return reduced;
}

bool IsFinger(const std::string& name) {
  return std::ranges::any_of(std::array{"thumb_", "index_", "middle_", "ring_", "little_"},
                             [&](const char* finger) { return name.starts_with(finger); });
}

// Facial folds depend on the joints of the face, not on what else a stream has.
TEST_F(ShippedRigs, DefaultHasTheSameFaceWithFewerJoints) {
  const wrinkle::Rig rig = *Shipped("default");
  const Clip whole = Generated("performance");
  const int neck = whole.skeleton.Find("neck");
  const auto of_head = [&](const std::string& name) {
    return whole.skeleton.IsAncestor(neck, whole.skeleton.Find(name));
  };
  const auto no_finger = [](const std::string& name) { return !IsFinger(name); };
  const std::vector<float> expected = Drivers(rig, whole);
  for (const float scale : {1.0f, 100.0f}) {
    EXPECT_LE(WorstOfFace(rig, whole, expected, Drivers(rig, Scaled(whole, scale))), 1e-4f);
    EXPECT_LE(
        WorstOfFace(rig, whole, expected, Drivers(rig, Scaled(Reduced(whole, no_finger), scale))),
        1e-4f);
    EXPECT_LE(
        WorstOfFace(rig, whole, expected, Drivers(rig, Scaled(Reduced(whole, of_head), scale))),
        1e-4f);
  }
}

// The places in the rig are those of the skeleton that the generator makes.
TEST_F(ShippedRigs, DefaultStatesTheSizeOfItsCharacter) {
  const wrinkle::Rig rig = *Shipped("default");
  ASSERT_NE(rig.size_reference, nullptr);
  const wrinkle::Skeleton skeleton = authoring::MakeSkeleton();
  for (const auto& joint : rig.size_reference->joints) {
    const int index = skeleton.Find(joint.name);
    ASSERT_NE(index, wrinkle::kNoJoint) << joint.name;
    EXPECT_LT(glm::distance(joint.position, glm::vec3(skeleton.rest_model()[index][3])), 1e-5f)
        << joint.name;
  }
  EXPECT_NEAR(rig.size_reference->size, wrinkle::SkeletonSize(skeleton), 1e-4f);
  EXPECT_NEAR(wrinkle::SkeletonSizeBy(rig.size_reference.get(), skeleton),
              wrinkle::SkeletonSize(skeleton), 1e-4f);
}

TEST_F(ShippedRigs, CmuHasTheSameWeightsInAnyUnit) {
  ExpectSameInAnyUnit("squat", *Shipped("cmu"), Generated("squat"));
  const fs::path take = kData / "cmu/01_01.bvh";
  if (!fs::exists(take)) GTEST_SKIP() << take << " is missing";
  ExpectSameInAnyUnit("01_01", *Shipped("cmu"), *motion::LoadClip(take), 32);
}

TEST_F(ShippedRigs, MakeHumanHasTheSameWeightsInAnyUnit) {
  const fs::path take = kData / "performances/emotions.bvh";
  const std::optional<wrinkle::Rig> rig = Shipped("makehuman");
  if (!rig || !fs::exists(take)) GTEST_SKIP() << "MakeHuman's data is missing";
  ExpectSameInAnyUnit("emotions", *rig, *motion::LoadClip(take));
}

TEST_F(ShippedRigs, ArkitReadsNoJoints) {
  EXPECT_THAT(wrinkle::JointsOf(*Shipped("arkit")), testing::IsEmpty());
}

TEST_F(ShippedRigs, TheFilterHardlyDependsOnTheFrameRate) {
  ExpectAlmostSameAtAnyRate("performance", *Shipped("default"), Generated("performance"));
  ExpectAlmostSameAtAnyRate("walk", *Shipped("default"), Generated("walk"));
}

TEST_F(ShippedRigs, TheFilterHardlyDependsOnTheFrameRateOfACapture) {
  const fs::path face = kData / "performances/emotions.bvh";
  const fs::path body = kData / "cmu/01_01.bvh";
  const std::optional<wrinkle::Rig> rig = Shipped("makehuman");
  if (!rig || !fs::exists(face) || !fs::exists(body)) GTEST_SKIP() << kData << " is missing";
  ExpectAlmostSameAtAnyRate("emotions", *rig, *motion::LoadClip(face));
  // The capture begins with a T-pose of one frame, from which it jumps. Its markers shake from
  // frame to frame; at 30 Hz, three of four of these movements are missing.
  Clip walk = *motion::LoadClip(body);
  walk.times.erase(walk.times.begin(), walk.times.begin() + 12);
  walk.locals.erase(walk.locals.begin(), walk.locals.begin() + 12 * walk.skeleton.num_joints());
  ExpectAlmostSameAtAnyRate("01_01", *Shipped("cmu"), walk);
}

}  // namespace
}  // namespace furrow::rig
