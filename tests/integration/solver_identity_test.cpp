// SPDX-License-Identifier: Apache-2.0
// The daemon and `furrow solve` have one solver: for full poses with the same capture times, their
// weights have the same bits.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon_fixture.h"
#include "motion/clip/capture_time.h"
#include "motion/clip_file.h"
#include "motion/pose_source.h"
#include "rig/rig_file.h"
#include "rig/shapes/rig_shapes.h"
#include "wrinkle/solver/solver.h"

namespace furrow::testing_net {
namespace {

// The weights of every frame, computed as solve_command.cpp does.
std::vector<std::vector<float>> SolveAsTheCommandLine(const motion::Clip& clip,
                                                      const std::string& rig_name) {
  const auto path = std::filesystem::path(FURROW_SOURCE_DIR) / "rig" / "rigs" / rig_name;
  const auto rig = rig::LoadRig(path, motion::CachedPoseSource());
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  const auto matcher = rig::ShapeMatcher::Create("");
  EXPECT_TRUE(matcher.ok()) << matcher.status().ToString();
  const rig::RigShapes shapes(*matcher, clip.blend_shape_names, *rig);
  auto binding = wrinkle::RigBinding::Create(*rig, clip.skeleton, shapes.driver_names(),
                                             {.allow_missing = true});
  EXPECT_TRUE(binding.ok()) << binding.status().ToString();
  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)));
  std::vector<std::vector<float>> weights;
  wrinkle::LocalPose pose;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    clip.GetPose(frame, &pose);
    shapes.Extend(&pose);
    EXPECT_EQ(solver.Update(pose, motion::CaptureStep(clip, frame)), wrinkle::JobStatus::kOk);
    weights.emplace_back(solver.wrinkle_weights().begin(), solver.wrinkle_weights().end());
  }
  return weights;
}

// Plays the clip as `num_subjects` subjects, frame by frame, so that their poses may share batches.
// Every subject's weights must have the bits of the command line.
void ExpectSameBits(const motion::Clip& clip, const std::string& rig, int num_subjects) {
  DaemonThread daemon(WeightsConfig(rig));
  ASSERT_TRUE(daemon.serves());
  const auto expected = SolveAsTheCommandLine(clip, rig);
  TcpClient sender(daemon.ready().tcp);
  std::vector<std::unique_ptr<TcpClient>> viewers;
  for (int i = 0; i < num_subjects; ++i) {
    const std::string name = "subject" + std::to_string(i);
    Offer(sender, OfferOf(clip, name), static_cast<std::uint16_t>(i + 1));
    viewers.push_back(std::make_unique<TcpClient>(daemon.ready().tcp));
    ASSERT_TRUE(Watch(*viewers.back(), {.subject = name}).has_value());
  }
  float largest = 0.0f;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int i = 0; i < num_subjects; ++i) {
      sender.Send(PoseOf(clip, frame, OfferOf(clip, "subject" + std::to_string(i))),
                  static_cast<std::uint16_t>(i + 1), static_cast<std::uint32_t>(frame),
                  motion::CaptureTimeUs(clip, frame));
    }
    const std::vector<float>& weights = expected[static_cast<std::size_t>(frame)];
    for (int i = 0; i < num_subjects; ++i) {
      const auto received = viewers[static_cast<std::size_t>(i)]->Await<protocol::WeightFrame>();
      ASSERT_TRUE(received.has_value()) << frame;
      ASSERT_EQ(received->values.size(), weights.size());
      ASSERT_EQ(
          std::memcmp(received->values.data(), weights.data(), weights.size() * sizeof(float)), 0)
          << "subject " << i << ", frame " << frame;
    }
    for (const float weight : weights) largest = std::max(largest, weight);
  }
  EXPECT_GT(largest, 0.3f) << "the clip moves nothing";
}

TEST(SolverIdentity, FacesHaveTheSameBits) { ExpectSameBits(ArkitClip(120), "arkit.json", 1); }

TEST(SolverIdentity, ManySubjectsAtOnceHaveTheSameBits) {
  ExpectSameBits(ArkitClip(60), "arkit.json", 8);
}

// The coefficients of a phone under the names of VRM presets, which a shape map translates.
TEST(SolverIdentity, MappedFacesHaveTheSameBits) {
  motion::Clip clip = ArkitClip(60);
  const std::vector<std::string> presets = {"Joy", "Angry", "Sorrow", "Fun",     "A",      "I", "U",
                                            "E",   "O",     "Blink",  "Blink_L", "Blink_R"};
  for (std::size_t i = 0; i < clip.blend_shape_names.size(); ++i) {
    clip.blend_shape_names[i] = i < presets.size() ? presets[i] : "custom" + std::to_string(i);
  }
  ExpectSameBits(clip, "arkit.json", 3);
}

TEST(SolverIdentity, BodiesHaveTheSameBits) {
  const auto path = std::filesystem::path(FURROW_SHARED_DATA) / "cmu" / "01_01.bvh";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  auto loaded = motion::LoadClip(path);
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  motion::Clip clip = *std::move(loaded);
  clip.times.resize(300);
  ExpectSameBits(clip, "cmu.json", 1);
}

}  // namespace
}  // namespace furrow::testing_net
