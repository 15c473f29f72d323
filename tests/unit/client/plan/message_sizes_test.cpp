// SPDX-License-Identifier: Apache-2.0
#include "client/plan/message_sizes.h"

#include <gtest/gtest.h>

namespace furrow::plan {
namespace {

constexpr double kHeaders = 14 + 4 + 8 + 12 + 20 + 8;  // Ethernet with preamble and gap, IPv4, UDP

// By hand from protocol/STANDARD.md: a packed rotation has 6 bytes and a bit in the mask of joints,
// a blend shape 2.
TEST(MessageSizes, GrowByTheBytesOfTheWire) {
  const double few = PoseSize({.joints = 50}).bytes;
  EXPECT_NEAR(PoseSize({.joints = 150}).bytes - few, 612.5, 8.0);
  EXPECT_NEAR(PoseSize({.joints = 50, .blend_shapes = 52}).bytes - few, 104.0, 40.0);
  EXPECT_NEAR(PoseSize({.joints = 60, .floats = true}).bytes -
                  PoseSize({.joints = 50, .floats = true}).bytes,
              160.0, 8.0);
  const double weights = WeightsSize({.weights = 37}).bytes;
  EXPECT_NEAR(WeightsSize({.weights = 137}).bytes - weights, 400.0, 8.0);
  EXPECT_NEAR(WeightsSize({.weights = 137, .u8 = true}).bytes -
                  WeightsSize({.weights = 37, .u8 = true}).bytes,
              100.0, 8.0);
}

// 224 bytes is what bench_fanout sends for the default rig.
TEST(MessageSizes, CountAllHeaders) {
  EXPECT_NEAR(WeightsSize({}).bytes, 224.0 + kHeaders, 8.0);
  EXPECT_EQ(WeightsSize({}).datagrams, 1);
  const double sealed = WeightsSize({.is_sealed = true}).bytes - WeightsSize({}).bytes;
  EXPECT_EQ(sealed, 32.0) << "header and tag of STANDARD.md section 15";
}

TEST(MessageSizes, LargePosesAreCut) {
  const Demand demand{.joints = 400, .floats = true};  // 16 bytes a rotation
  const MessageSize size = PoseSize(demand);
  EXPECT_EQ(size.datagrams, 6);
  EXPECT_GT(size.bytes, 6400.0 + 6 * kHeaders);
  EXPECT_LT(size.bytes, 6400.0 + 6 * (kHeaders + 60) + 300.0);
}

TEST(MessageSizes, APoseMayBeEmpty) {
  EXPECT_EQ(PoseSize({.joints = 0}).datagrams, 1);
  EXPECT_LT(PoseSize({.joints = 0}).bytes, PoseSize({.joints = 1}).bytes);
}

}  // namespace
}  // namespace furrow::plan
