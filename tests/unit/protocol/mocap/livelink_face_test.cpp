// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/livelink_face.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/mocap/livelink_encoder.h"

namespace furrow::protocol::mocap {
namespace {

using test::LiveLinkPacket;

class LiveLinkFace : public ::testing::Test {
 protected:
  void Push(const LiveLinkPacket& packet, std::int64_t now_us = 0) {
    PushBytes(packet.Encode(), now_us);
  }
  void PushBytes(std::span<const std::uint8_t> bytes, std::int64_t now_us = 0) {
    adapter_->Push(bytes, now_us, [this](const NeutralFrame& frame) { frames_.push_back(frame); });
  }
  [[nodiscard]] const AdapterCounters& counters() const { return adapter_->counters(); }

  std::unique_ptr<MocapAdapter> adapter_ = MakeLiveLinkFaceAdapter();
  std::vector<NeutralFrame> frames_;
};

// Sizes in a real capture: 319 bytes with a face, 74 without.
TEST_F(LiveLinkFace, TestEncoderMatchesCapturedSizes) {
  LiveLinkPacket packet;
  EXPECT_EQ(packet.Encode().size(), 319u);
  packet.values.clear();
  EXPECT_EQ(packet.Encode().size(), 74u);
}

TEST_F(LiveLinkFace, NamesAreInWireOrder) {
  const std::map<int, std::string_view> places = {
      {0, "EyeBlinkLeft"}, {6, "EyeWideLeft"},     {7, "EyeBlinkRight"}, {13, "EyeWideRight"},
      {14, "JawForward"},  {15, "JawLeft"},        {16, "JawRight"},     {17, "JawOpen"},
      {18, "MouthClose"},  {31, "MouthRollLower"}, {41, "BrowDownLeft"}, {43, "BrowInnerUp"},
      {46, "CheekPuff"},   {49, "NoseSneerLeft"},  {51, "TongueOut"},    {52, "HeadYaw"},
      {55, "LeftEyeYaw"},  {58, "RightEyeYaw"},    {60, "RightEyeRoll"}};
  for (const auto& [index, name] : places) {
    EXPECT_EQ(LiveLinkFaceShapeNames()[static_cast<std::size_t>(index)], name);
  }
}

TEST_F(LiveLinkFace, FaceBecomesAFrame) {
  LiveLinkPacket packet;
  for (int i = 0; i < 61; ++i)
    packet.values[static_cast<std::size_t>(i)] = 0.01f * static_cast<float>(i);
  Push(packet);
  ASSERT_EQ(frames_.size(), 1u);
  const NeutralFrame& frame = frames_.front();
  EXPECT_EQ(frame.subject, "iPhoneOfAnna1");
  EXPECT_TRUE(frame.tracked);
  EXPECT_TRUE(frame.joints.empty());
  ASSERT_EQ(frame.blend_shapes.size(), 61u);
  EXPECT_EQ(frame.blend_shapes[17].name, "JawOpen");
  EXPECT_FLOAT_EQ(frame.blend_shapes[17].value, 0.17f);
  EXPECT_EQ(frame.capture_time_us, std::llround((1'234'567 + 0.25) / 60.0 * 1e6));
}

TEST_F(LiveLinkFace, FramesHaveTheTimecodeOfTheApp) {
  LiveLinkPacket packet;
  Push(packet);
  ASSERT_TRUE(frames_.back().timecode);
  EXPECT_EQ(TimecodeText(*frames_.back().timecode), "05:42:56:07");
  EXPECT_EQ(frames_.back().timecode->subframe, 64) << "0.25";
  packet.rate_numerator = 30'000;
  packet.rate_denominator = 1001;
  packet.frame = 2'000'000;
  packet.subject = "ntsc";
  Push(packet);
  EXPECT_EQ(TimecodeText(*frames_.back().timecode), "18:32:13;12") << "drop-frame";
  packet.values.clear();
  ++packet.frame;
  Push(packet);
  EXPECT_EQ(TimecodeText(*frames_.back().timecode), "18:32:13;13") << "without a face, too";
}

// The frames are used: their capture time does not need a timecode.
TEST_F(LiveLinkFace, NumbersThatAreNoTimecodeLeaveItOut) {
  const auto push = [this](const auto& change) {
    LiveLinkPacket packet;
    packet.subject = "phone_" + std::to_string(frames_.size());
    change(packet);
    Push(packet);
    return frames_.back();
  };
  const NeutralFrame ticks = push([](auto& p) { p.rate_numerator = 24'000; });
  EXPECT_FALSE(ticks.timecode) << "a rate of ticks, not frames";
  EXPECT_EQ(ticks.capture_time_us, std::llround((1'234'567 + 0.25) / 24'000 * 1e6));
  EXPECT_FALSE(push([](auto& p) { p.rate_denominator = 7; }).timecode);
  EXPECT_FALSE(push([](auto& p) { p.frame = 2 * 86'400 * 60; }).timecode) << "two days";
  EXPECT_EQ(push([](auto& p) { p.frame = 86'400 * 60 + 1; }).timecode->frame, 1u)
      << "ran on after midnight";
  EXPECT_EQ(counters().accepted, 4u);
  EXPECT_EQ(counters().malformed, 0u);
}

TEST_F(LiveLinkFace, NoFaceKeepsLastValuesUntracked) {
  LiveLinkPacket packet;
  packet.values[17] = 0.5f;
  Push(packet);
  packet.values.clear();
  ++packet.frame;
  Push(packet);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_FALSE(frames_[1].tracked);
  EXPECT_EQ(frames_[1].blend_shapes[17].value, 0.5f);
  EXPECT_EQ(frames_[1].sequence, 1u);
}

TEST_F(LiveLinkFace, DropsLateFramesAndPassesMidnight) {
  LiveLinkPacket packet;
  Push(packet, 0);
  Push(packet, 0);
  packet.frame -= 1;
  Push(packet, 0);
  EXPECT_EQ(counters().reordered, 2u);
  packet.frame = 0;
  Push(packet, 20'000);
  packet.frame = 1;
  Push(packet, 40'000);
  ASSERT_EQ(frames_.size(), 3u);
  EXPECT_EQ(frames_[1].capture_time_us - frames_[0].capture_time_us, 20'000) << "by arrival";
  EXPECT_NEAR(static_cast<double>(frames_[2].capture_time_us - frames_[1].capture_time_us),
              1e6 / 60, 1);
}

TEST_F(LiveLinkFace, DistinguishesPhones) {
  LiveLinkPacket anna;
  LiveLinkPacket other = anna;
  other.device[0] = '7';
  Push(anna);
  Push(other);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_EQ(frames_[0].subject, "iPhoneOfAnna1");
  EXPECT_EQ(frames_[1].subject, "iPhoneOfAnna1-7E5C3A10");
  EXPECT_EQ(counters().reordered, 0u);
}

TEST_F(LiveLinkFace, BoundsSubjects) {
  LiveLinkPacket packet;
  for (int i = 0; i < 40; ++i) {
    packet.subject = "subject_" + std::to_string(i);
    Push(packet, i);
  }
  EXPECT_EQ(frames_.size(), 40u);
  packet.subject = "subject_39";
  Push(packet, 41);
  EXPECT_EQ(counters().reordered, 1u) << "remembered";
  packet.subject = "subject_0";
  Push(packet, 42);
  EXPECT_EQ(counters().accepted, 41u) << "forgotten, so new";
}

TEST_F(LiveLinkFace, CountsMalformedPacketsAndKeepsState) {
  std::uint64_t expected = 0;
  const auto refuse = [&](const auto& change) {
    LiveLinkPacket packet;
    change(packet);
    Push(packet);
    EXPECT_EQ(counters().malformed, ++expected);
  };
  refuse([](auto& p) { p.version = 5; });
  refuse([](auto& p) { p.device.clear(); });
  refuse([](auto& p) { p.subject.clear(); });
  refuse([](auto& p) { p.subject = std::string(256, 'x'); });
  refuse([](auto& p) { p.subject = "a\nb"; });
  refuse([](auto& p) { p.frame = -1; });
  refuse([](auto& p) { p.subframe = NAN; });
  refuse([](auto& p) { p.rate_numerator = 0; });
  refuse([](auto& p) { p.rate_denominator = -1; });
  refuse([](auto& p) { p.values.pop_back(); });
  refuse([](auto& p) { p.values.push_back(0); });
  refuse([](auto& p) { p.values[3] = NAN; });
  refuse([](auto& p) { p.values[3] = INFINITY; });
  test::Bytes longer = LiveLinkPacket{}.Encode();
  longer.push_back(0);
  PushBytes(longer);
  EXPECT_EQ(counters().malformed, ++expected);
  EXPECT_TRUE(frames_.empty());
}

TEST_F(LiveLinkFace, SurvivesTruncationAndCorruption) {
  const test::Bytes good = LiveLinkPacket{}.Encode();
  std::size_t cuts = 0;
  test::ForEveryTruncation(good, [&](std::span<const std::uint8_t> cut) {
    PushBytes(cut);
    if (cut.size() != 74) ++cuts;  // that one is a datagram without a face
  });
  EXPECT_EQ(counters().malformed, cuts);
  test::ForEveryCorruption(good, [this](std::span<const std::uint8_t> bad) { PushBytes(bad); });
}

TEST_F(LiveLinkFace, DoesNotAllocateAfterWarmUp) {
  std::vector<test::Bytes> packets;
  LiveLinkPacket packet;
  for (int i = 0; i < 10; ++i, ++packet.frame) packets.push_back(packet.Encode());
  const FrameSink sink = [](const NeutralFrame&) {};
  adapter_->Push(packets[0], 0, sink);
  const std::uint64_t before = furrow::test::NumAllocations();
  for (std::size_t i = 1; i < packets.size(); ++i) adapter_->Push(packets[i], 0, sink);
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_EQ(counters().accepted, 10u);
}

}  // namespace
}  // namespace furrow::protocol::mocap
