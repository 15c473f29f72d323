// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/resample.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;

// One joint that turns and moves at constant speed, sampled at uneven times.
Clip MakeClip() {
  Clip clip;
  clip.skeleton = *wrinkle::Skeleton::Create({{"a", wrinkle::kNoJoint, {}, {}}});
  clip.blend_shape_names = {"s"};
  for (const double time : {1.0, 1.1, 1.5, 2.0}) {
    const auto t = static_cast<float>(time);
    clip.times.push_back(time);
    clip.locals.push_back({{t, 0, 0}, glm::angleAxis(t, glm::vec3(0, 1, 0)), glm::vec3(1.0f)});
    clip.blend_shapes.push_back(2.0f * t);
  }
  return clip;
}

TEST(Resample, KeepsConstantSpeed) {
  const Clip even = Resample(MakeClip(), 4.0);
  EXPECT_THAT(even.times, ElementsAre(1.0, 1.25, 1.5, 1.75, 2.0));
  EXPECT_TRUE(IsEvenlySpaced(even));
  for (std::size_t f = 0; f < even.times.size(); ++f) {
    const auto t = static_cast<float>(even.times[f]);
    EXPECT_THAT(even.locals[f].translation.x, FloatNear(t, 1e-6f));
    EXPECT_THAT(even.blend_shapes[f], FloatNear(2.0f * t, 1e-6f));
    EXPECT_THAT(2.0f * std::acos(even.locals[f].rotation.w), FloatNear(t, 1e-4f));
  }
}

TEST(Resample, DetectsUnevenSpacing) {
  Clip clip = MakeClip();
  EXPECT_FALSE(IsEvenlySpaced(clip));
  EXPECT_DOUBLE_EQ(MeanFrameTime(clip), 1.0 / 3.0);
  clip.times.resize(1);
  EXPECT_TRUE(IsEvenlySpaced(clip));
  EXPECT_EQ(MeanFrameTime(clip), 0.0);
  EXPECT_EQ(Resample(clip, 10.0).times.size(), 1u);
}

}  // namespace
}  // namespace furrow::motion
