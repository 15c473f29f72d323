// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "protocol/framing/fragment.h"
#include "protocol/messages/quantise.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Encoded;
using test::OpenAndDecode;

template <class Change>
DecodeStatus DecodeChangedPose(const Change& change, const PoseEncoding& encoding = {}) {
  return test::DecodeChanged(test::MakePose(9, 4, 1), change, encoding);
}

TEST(PoseMessage, FloatRoundTripIsExact) {
  PoseFrame pose = test::MakePose(9, 4, 1);
  pose.partial = true;
  pose.scale_joints = {0, 8};
  pose.scales = {{1, 2, 3}, {4, 5, 6}};
  pose.translation_joints = {1, 7, 8};
  pose.translations.resize(3);
  PoseFrame out = test::MakePose(20, 9, 2);
  ASSERT_EQ(OpenAndDecode(Encoded(pose), out), DecodeStatus::kOk);
  EXPECT_EQ(out.skeleton_hash, pose.skeleton_hash);
  EXPECT_TRUE(out.partial);
  EXPECT_EQ(out.num_joints, 9);
  EXPECT_EQ(out.num_blend_shapes, 4);
  EXPECT_EQ(out.rotation_joints, pose.rotation_joints);
  EXPECT_EQ(out.rotations, pose.rotations);
  EXPECT_EQ(out.translation_joints, pose.translation_joints);
  EXPECT_EQ(out.translations, pose.translations);
  EXPECT_EQ(out.scale_joints, pose.scale_joints);
  EXPECT_EQ(out.scales, pose.scales);
  EXPECT_EQ(out.blend_shape_indices, pose.blend_shape_indices);
  EXPECT_EQ(out.blend_shapes, pose.blend_shapes);
}

// 12 bytes, their entry in the table, and what aligns them.
TEST(PoseMessage, TimecodesTravelInAtMost24Bytes) {
  PoseFrame pose = test::MakePose(9, 4, 1);
  const std::size_t alone = Encoded(pose).size();
  PoseFrame out;
  out.timecode = Timecode{.frame = 5};
  ASSERT_EQ(OpenAndDecode(Encoded(pose), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.timecode) << "absent, not 00:00:00:00";
  pose.timecode = Timecode{17'982, 30'000, 1001, 200, /*drop_frame=*/true};
  ASSERT_EQ(OpenAndDecode(Encoded(pose), out), DecodeStatus::kOk);
  EXPECT_EQ(out.timecode, pose.timecode);
  EXPECT_LE(Encoded(pose).size(), alone + 24);
  pose.timecode = Timecode{};
  ASSERT_EQ(OpenAndDecode(Encoded(pose), out), DecodeStatus::kOk);
  EXPECT_EQ(out.timecode, Timecode()) << "00:00:00:00 is a timecode";
}

// The pose is good without it.
TEST(PoseMessage, InvalidTimecodesAreIgnored) {
  for (const Timecode& bad : {Timecode{.frame = 30 * 86'400}, Timecode{.frame = 0xFFFFFFFF},
                              Timecode{.rate_numerator = 0}, Timecode{.rate_denominator = 0},
                              Timecode{.rate_numerator = 0xFFFFFFFF},
                              Timecode{.rate_numerator = 25, .drop_frame = true}}) {
    PoseFrame out;
    PoseFrame pose = test::MakePose(9, 4, 1);
    pose.timecode = bad;
    ASSERT_EQ(OpenAndDecode(Encoded(pose), out), DecodeStatus::kOk);
    EXPECT_FALSE(out.timecode) << bad.frame;
    EXPECT_EQ(out.rotations, pose.rotations);
  }
}

TEST(PoseMessage, PackedNumbersStayWithinStatedErrors) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const PoseFrame pose = test::MakePose(60, 52, seed);
    PoseFrame out;
    ASSERT_EQ(OpenAndDecode(Encoded(pose, PoseEncoding::Small()), out), DecodeStatus::kOk);
    for (std::size_t i = 0; i < pose.rotations.size(); ++i) {
      EXPECT_LE(test::AngleBetween(pose.rotations[i], out.rotations[i]), kMaxRotationError);
      EXPECT_NEAR(out.translations[i].x, pose.translations[i].x, 0.05 / 65534 * 1.01);
      EXPECT_NEAR(out.translations[i].y, pose.translations[i].y, 0.05 / 65534 * 1.01);
      EXPECT_NEAR(out.translations[i].z, pose.translations[i].z, 0.05 / 65534 * 1.01);
    }
    for (std::size_t i = 0; i < pose.blend_shapes.size(); ++i) {
      EXPECT_NEAR(out.blend_shapes[i], pose.blend_shapes[i], 1.0 / 32768 * 1.01);
    }
  }
}

TEST(PoseMessage, IsPackedIfItDoesNotFitADatagramOtherwise) {
  const PoseFrame small = test::MakePose(20, 0, 1);
  EXPECT_EQ(Encoded(small, PoseEncoding::Fitting()), Encoded(small));
  const PoseFrame large = test::MakePose(60, 52, 1);
  ASSERT_GT(NumDatagrams(Encoded(large).size()), 1u);
  const auto fitting = Encoded(large, PoseEncoding::Fitting());
  EXPECT_EQ(fitting, Encoded(large, PoseEncoding::Small()));
  EXPECT_EQ(NumDatagrams(fitting.size()), 1u);
}

TEST(PoseMessage, EmptyIndicesMeanAllInOrder) {
  PoseFrame pose = test::MakePose(9, 4, 1);
  const PoseFrame whole = pose;
  pose.rotation_joints.clear();
  pose.translation_joints.clear();
  pose.blend_shape_indices.clear();
  PoseFrame out;
  ASSERT_EQ(OpenAndDecode(Encoded(pose), out), DecodeStatus::kOk);
  EXPECT_EQ(out.rotation_joints, whole.rotation_joints);
  EXPECT_EQ(out.translation_joints, whole.translation_joints);
  EXPECT_EQ(out.blend_shape_indices, whole.blend_shape_indices);
  EXPECT_EQ(Encoded(pose), Encoded(whole));
}

// STANDARD.md section 7 states these sizes.
TEST(PoseMessage, SizesMatchTheStandard) {
  const std::size_t face = Encoded(test::MakePose(60, 0, 1), PoseEncoding::Small()).size();
  PoseFrame body = test::MakePose(163, 0, 1);
  const std::size_t full = Encoded(body, PoseEncoding::Small()).size();
  const std::size_t floats = Encoded(body).size();
  body.translation_joints = {0};
  body.translations.resize(1);
  const std::size_t moving = Encoded(body, PoseEncoding::Small()).size();
  std::printf(
      "60 joints packed: %zu bytes; 163: %zu with the root's translation, %zu with all "
      "(%zu datagrams), %zu in floats (%zu)\n",
      face, moving, full, NumDatagrams(full), floats, NumDatagrams(floats));
  EXPECT_EQ(face, 824u);
  EXPECT_EQ(moving, 1128u);
  EXPECT_EQ(full, 2064u);
  EXPECT_LE(moving, kMaxDatagramBytes);
  EXPECT_EQ(NumDatagrams(full), 2u);
}

TEST(PoseMessage, RejectsEachFault) {
  EXPECT_EQ(DecodeChangedPose([](auto&) {}), DecodeStatus::kOk);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.rotations[3].x = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.rotations[3].x = 1e30f; }), DecodeStatus::kNotUnit);
  EXPECT_EQ(DecodeChangedPose([](auto& p) {
              p.rotations[3] = {0, 0, 0, 0};
            }),
            DecodeStatus::kNotUnit);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.translations[0].z = INFINITY; }),
            DecodeStatus::kNonFinite);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.translations[0].z = -2e6f; }),
            DecodeStatus::kBadValue);
  EXPECT_EQ(DecodeChangedPose([](auto& p) {
              p.scales.assign(9, {1, NAN, 1});
            }),
            DecodeStatus::kNonFinite);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.blend_shapes[1] = -INFINITY; }),
            DecodeStatus::kNonFinite);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.rotations.pop_back(); }), DecodeStatus::kBadCount);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.blend_shapes.push_back(0); }),
            DecodeStatus::kBadCount);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.scales = {{1, 1, 1}}; }), DecodeStatus::kBadCount);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.num_joints = 1025; }), DecodeStatus::kLimit);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.num_blend_shapes = 513; }), DecodeStatus::kLimit);
  // Masks with another number of bits than values.
  EXPECT_EQ(DecodeChangedPose([](auto& p) {
              p.rotation_joints = {1, 2};
            }),
            DecodeStatus::kBadCount);
  EXPECT_EQ(DecodeChangedPose([](auto& p) { p.translation_joints.pop_back(); }),
            DecodeStatus::kBadCount);
  const auto packed_nan = [](auto& p) { p.translations[0].x = INFINITY; };
  EXPECT_EQ(DecodeChangedPose(packed_nan, PoseEncoding::Small()), DecodeStatus::kNonFinite)
      << "translation range";
}

TEST(PoseMessage, RejectsMaskBitsBeyondTheLastJoint) {
  PoseFrame pose = test::MakePose(9, 0, 1);
  pose.translations.clear();
  pose.translation_joints.clear();
  pose.rotation_joints = {0, 8};
  pose.rotations.resize(2);
  std::vector<std::uint8_t> bytes = Encoded(pose);
  // The mask is the only vector of two bytes: length 2, then 0x01 0x01.
  const std::vector<std::uint8_t> mask = {2, 0, 0, 0, 0x01, 0x01};
  const auto at = std::search(bytes.begin(), bytes.end(), mask.begin(), mask.end());
  ASSERT_NE(at, bytes.end());
  PoseFrame out;
  at[5] = 0x02;  // joint 9 of 9
  EXPECT_EQ(OpenAndDecode(bytes, out), DecodeStatus::kBadCount);
  at[5] = 0x00;
  EXPECT_EQ(OpenAndDecode(bytes, out), DecodeStatus::kBadCount);
  at[5] = 0x01;
  EXPECT_EQ(OpenAndDecode(bytes, out), DecodeStatus::kOk);
}

}  // namespace
}  // namespace furrow::protocol
