// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/frame_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;

TEST(FrameTimes, TakesTheKeysOfAllJoints) {
  FrameTimes times;
  times.Add({1.0, 0.0});
  times.Add({0.5});
  times.Add({});
  EXPECT_THAT(times.Finish(1.0), ElementsAre(0.0, 0.5, 1.0));
}

TEST(FrameTimes, CloseKeysAreOneFrame) {
  FrameTimes times;
  times.Add({0.0, 0.5, 0.5001});
  times.Add({0.4999, 1.0});
  EXPECT_THAT(times.Finish(1.0), ElementsAre(0.0, 0.5, 1.0));
}

TEST(FrameTimes, CutsAtTheTakesStartAndEnd) {
  FrameTimes times;
  times.Add({-1.0, -0.2, 0.3, 0.6, 2.0});
  EXPECT_THAT(times.Finish(1.0), ElementsAre(0.0, 0.3, 0.6, 1.0));
}

TEST(FrameTimes, WithoutKeysThereIsOneFrame) {
  EXPECT_THAT(FrameTimes().Finish(0.0), ElementsAre(0.0));
}

TEST(FrameTimes, FewJointsAddNoFramesToADenseRecording) {
  FrameTimes times;
  for (int joint = 0; joint < 3; ++joint) times.Add({0.0, 0.04, 0.08, 0.12});
  times.Add({0.0, 0.04, 0.055, 0.07, 0.08, 0.12});
  EXPECT_THAT(times.Finish(0.12), ElementsAre(0.0, 0.04, 0.08, 0.12));
}

TEST(FrameTimes, FewJointsAddFramesBetweenSparseKeys) {
  FrameTimes times;
  for (int joint = 0; joint < 3; ++joint) times.Add({0.0, 1.0});
  times.Add({0.0, 0.5, 1.0, 1.2});
  EXPECT_THAT(times.Finish(2.0), ElementsAre(0.0, 0.5, 1.0, 1.2));
}

}  // namespace
}  // namespace furrow::authoring
