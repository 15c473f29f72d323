// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/vmc.h"

#include <cmath>

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "protocol/mocap/osc.h"
#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/mocap/hex.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol::mocap {
namespace {

using test::Bytes;

// Builds a sender's packet: several messages in a bundle, or one bare message.
class Packet {
 public:
  explicit Packet(bool bundle = true) : writer_(bytes_) {
    if (bundle) writer_.BeginBundle();
  }
  Packet& Bone(std::string_view name, Vec3 p, Quat q = {}) {
    return Message("/VMC/Ext/Bone/Pos", "sfffffff", name, {p.x, p.y, p.z, q.x, q.y, q.z, q.w});
  }
  Packet& Root(Vec3 p, Quat q = {}) {
    return Message("/VMC/Ext/Root/Pos", "sfffffff", "root", {p.x, p.y, p.z, q.x, q.y, q.z, q.w});
  }
  Packet& Blend(std::string_view name, float value) {
    return Message("/VMC/Ext/Blend/Val", "sf", name, {value});
  }
  Packet& Apply() { return Message("/VMC/Ext/Blend/Apply", "", "", {}); }
  Packet& Time(float seconds) { return Message("/VMC/Ext/T", "f", "", {seconds}); }
  Packet& Ok(int loaded) {
    writer_.BeginMessage("/VMC/Ext/OK", "i");
    writer_.Int(loaded);
    writer_.EndMessage();
    return *this;
  }
  Packet& Texts(std::string_view address, std::string_view first, std::string_view second) {
    writer_.BeginMessage(address, "ss");
    writer_.String(first);
    writer_.String(second);
    writer_.EndMessage();
    return *this;
  }
  Packet& Message(std::string_view address, std::string_view tags, std::string_view text,
                  std::initializer_list<float> values) {
    writer_.BeginMessage(address, tags);
    if (tags.starts_with('s')) writer_.String(text);
    for (const float value : values) writer_.Float(value);
    writer_.EndMessage();
    return *this;
  }
  [[nodiscard]] const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
  OscWriter writer_;
};

class Vmc : public ::testing::Test {
 protected:
  void Push(const Packet& packet, std::int64_t now_us = 0) { PushBytes(packet.bytes(), now_us); }
  void PushBytes(std::span<const std::uint8_t> bytes, std::int64_t now_us = 0) {
    adapter_->Push(bytes, now_us, sink_);
  }
  void Tick(std::int64_t now_us) { adapter_->Tick(now_us, sink_); }
  [[nodiscard]] const AdapterCounters& counters() const { return adapter_->counters(); }
  [[nodiscard]] static const NeutralJoint* Find(const NeutralFrame& frame, std::string_view name) {
    for (const NeutralJoint& joint : frame.joints) {
      if (joint.name == name) return &joint;
    }
    return nullptr;
  }
  [[nodiscard]] static std::string ParentName(const NeutralFrame& frame, std::string_view name) {
    const NeutralJoint* joint = Find(frame, name);
    if (joint == nullptr) return "missing";
    return joint->parent < 0 ? "" : frame.joints[static_cast<std::size_t>(joint->parent)].name;
  }

  std::unique_ptr<MocapAdapter> adapter_ = MakeVmcAdapter({"anna", 50'000});
  std::vector<NeutralFrame> frames_;
  FrameSink sink_ = [this](const NeutralFrame& frame) { frames_.push_back(frame); };
};

TEST_F(Vmc, ReadsKnownVectors) {
  PushBytes(
      test::FromHex("2F564D43 2F457874 2F426F6E 652F506F 73000000 2C736666 66666666 66000000 "
                    "48697073 00000000 00000000 3F800000 00000000 00000000 00000000 00000000 "
                    "3F800000"));
  PushBytes(
      test::FromHex("2F564D43 2F457874 2F426C65 6E642F56 616C0000 2C736600 41000000 3F000000"));
  EXPECT_TRUE(frames_.empty());
  PushBytes(test::FromHex("2F564D43 2F457874 2F426C65 6E642F41 70706C79 00000000 2C000000"));
  ASSERT_EQ(frames_.size(), 1u);
  EXPECT_EQ(frames_[0].subject, "anna");
  ASSERT_EQ(frames_[0].joints.size(), 1u);
  EXPECT_EQ(frames_[0].joints[0].name, "Hips");
  EXPECT_EQ(frames_[0].joints[0].translation, (Vec3{0, 1, 0}));
  ASSERT_EQ(frames_[0].blend_shapes.size(), 1u);
  EXPECT_EQ(frames_[0].blend_shapes[0].name, "A");
  EXPECT_EQ(frames_[0].blend_shapes[0].value, 0.5f);
}

// Unity's left-handed axes are mirrored in x. A rotation that turns +Z (forward) to Unity's +X (the
// right-hand side) must turn +Z to -X in right-handed axes, which is the right-hand side there.
TEST_F(Vmc, MirrorsUnityAxes) {
  const float h = std::sqrt(0.5f);
  Push(Packet().Bone("Hips", {0.25f, 1.0f, 0.5f}, {0, h, 0, h}).Apply());
  ASSERT_EQ(frames_.size(), 1u);
  const NeutralJoint& hips = frames_[0].joints[0];
  EXPECT_EQ(hips.translation, (Vec3{-0.25f, 1.0f, 0.5f}));
  const Quat& q = hips.rotation;
  EXPECT_NEAR(2 * (q.x * q.z + q.w * q.y), -1.0f, 1e-6f) << "x of the turned +Z";
  EXPECT_NEAR(1 - 2 * (q.x * q.x + q.y * q.y), 0.0f, 1e-6f) << "z of the turned +Z";
}

TEST_F(Vmc, ParentIsTheNearestSentAncestor) {
  Push(Packet()
           .Bone("LeftEye", {0, 0.1f, 0})
           .Bone("Head", {0, 0.1f, 0})
           .Bone("Hips", {0, 1, 0})
           .Bone("LeftHand", {0.1f, 0, 0})
           .Bone("Tail", {0, 0, -0.1f})
           .Root({0, 0, 0})
           .Apply());
  ASSERT_EQ(frames_.size(), 1u);
  const NeutralFrame& frame = frames_[0];
  EXPECT_EQ(frame.joints.front().name, "Root");
  EXPECT_EQ(ParentName(frame, "Root"), "");
  EXPECT_EQ(ParentName(frame, "Hips"), "Root");
  EXPECT_EQ(ParentName(frame, "Head"), "Hips") << "no spine was sent";
  EXPECT_EQ(ParentName(frame, "LeftEye"), "Head");
  EXPECT_EQ(ParentName(frame, "LeftHand"), "Hips");
  EXPECT_EQ(ParentName(frame, "Tail"), "Hips");
  for (std::size_t i = 0; i < frame.joints.size(); ++i) {
    EXPECT_LT(frame.joints[i].parent, static_cast<int>(i));
  }
}

TEST_F(Vmc, ZeroTranslationsGetAverageOffsets) {
  Push(Packet()
           .Bone("Hips", {0, 0, 0})
           .Bone("LeftUpperLeg", {0, 0, 0})
           .Bone("LeftLowerLeg", {})
           .Apply());
  ASSERT_EQ(frames_.size(), 1u);
  EXPECT_LT(Find(frames_[0], "LeftLowerLeg")->translation.y, -0.3f);
  EXPECT_GT(Find(frames_[0], "LeftUpperLeg")->translation.x, 0.05f) << "left is +X";
  const std::uint32_t layout = frames_[0].layout;
  Push(Packet().Bone("LeftLowerLeg", {0, -0.5f, 0}).Apply(), 1000);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_NE(frames_[1].layout, layout) << "a real length changes the rest pose";
  EXPECT_EQ(Find(frames_[1], "LeftLowerLeg")->rest_translation, (Vec3{0, -0.5f, 0}));
}

TEST_F(Vmc, TimeEndsAFrame) {
  for (int i = 0; i < 3; ++i) {
    Push(Packet()
             .Bone("Hips", {0, 1, 0})
             .Blend("A", 1)
             .Apply()
             .Time(1.0f + 0.25f * static_cast<float>(i)),
         i * 250'000);
  }
  // Only the first Apply arrived before a Time message.
  ASSERT_EQ(frames_.size(), 3u);
  EXPECT_EQ(frames_[2].capture_time_us - frames_[1].capture_time_us, 250'000);
  EXPECT_EQ(counters().incomplete, 0u);
}

TEST_F(Vmc, RepeatedBoneEndsAFrameWithoutMarks) {
  for (int i = 0; i < 3; ++i) {
    Push(Packet(false).Bone("Hips", {0, 1, 0}), i * 10'000);
    Push(Packet(false).Bone("Spine", {0, 0.1f, 0}), i * 10'000);
  }
  EXPECT_EQ(frames_.size(), 2u);
  Tick(30'000);
  EXPECT_EQ(frames_.size(), 2u);
  Tick(70'000);
  ASSERT_EQ(frames_.size(), 3u);
  EXPECT_EQ(counters().incomplete, 3u);
  EXPECT_EQ(frames_[1].capture_time_us - frames_[0].capture_time_us, 10'000);
  Tick(1'000'000);
  EXPECT_EQ(frames_.size(), 3u) << "nothing waits";
}

TEST_F(Vmc, BlendShapesAreCaseInsensitiveAndKeepValues) {
  Push(Packet().Blend("Joy", 0.5f).Blend("EyeBlinkLeft", 0.1f).Apply());
  Push(Packet().Blend("JOY", 0.75f).Apply(), 1000);
  ASSERT_EQ(frames_.size(), 2u);
  ASSERT_EQ(frames_[1].blend_shapes.size(), 2u);
  EXPECT_EQ(frames_[1].blend_shapes[0].value, 0.75f);
  EXPECT_EQ(frames_[1].blend_shapes[1].value, 0.1f);
  EXPECT_EQ(frames_[0].layout, frames_[1].layout);
}

TEST_F(Vmc, NewAvatarDiscardsState) {
  const auto avatar = [](std::string_view title) {
    return Packet().Texts("/VMC/Ext/VRM", "avatar.vrm", title);
  };
  Push(avatar("Anna"));
  Push(Packet().Bone("Hips", {0, 1, 0}).Blend("Joy", 1).Apply());
  Push(avatar("Anna"), 1000);
  Push(Packet().Blend("Fun", 1).Apply(), 2000);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_EQ(frames_[1].blend_shapes.size(), 2u) << "said again, it is the same";
  Push(avatar("Bert"), 3000);
  Push(Packet().Blend("A", 0.5f).Apply(), 4000);
  ASSERT_EQ(frames_.size(), 3u);
  EXPECT_TRUE(frames_[2].joints.empty());
  ASSERT_EQ(frames_[2].blend_shapes.size(), 1u);
  EXPECT_EQ(frames_[2].blend_shapes[0].name, "A");
  EXPECT_NE(frames_[2].layout, frames_[1].layout);
  EXPECT_EQ(frames_[2].sequence, 2u);
}

TEST_F(Vmc, NewSenderDiscardsState) {
  Push(Packet().Bone("Hips", {0, 1, 0}).Blend("Joy", 1).Apply());
  Push(Packet().Ok(0), 1000);  // the last word of the one before
  adapter_->Forget();
  Push(Packet().Blend("A", 0.5f).Apply(), 4'000'000);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_TRUE(frames_[1].joints.empty());
  ASSERT_EQ(frames_[1].blend_shapes.size(), 1u);
  EXPECT_EQ(frames_[1].sequence, 1u);
  EXPECT_NE(frames_[1].layout, frames_[0].layout);
  EXPECT_GT(frames_[1].capture_time_us, frames_[0].capture_time_us);
}

TEST_F(Vmc, DropsFramesWhileNoModelIsLoaded) {
  Push(Packet().Ok(0).Bone("Hips", {0, 1, 0}).Apply());
  EXPECT_TRUE(frames_.empty());
  EXPECT_EQ(counters().stale, 1u);
  Push(Packet().Ok(1).Bone("Hips", {0, 1, 0}).Apply());
  EXPECT_EQ(frames_.size(), 1u);
}

TEST_F(Vmc, DropsLateFramesButAcceptsRestarts) {
  const auto frame = [](float seconds) { return Packet().Bone("Hips", {0, 1, 0}).Time(seconds); };
  Push(frame(100.0f), 0);
  Push(frame(99.5f), 10'000);
  EXPECT_EQ(counters().reordered, 1u);
  Push(frame(1.0f), 20'000);
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_EQ(frames_[1].capture_time_us - frames_[0].capture_time_us, 20'000);
}

TEST_F(Vmc, StoppedClockLosesNoFrame) {
  const auto frame = [](float seconds) { return Packet().Bone("Hips", {0, 1, 0}).Time(seconds); };
  for (int i = 0; i < 4; ++i) Push(frame(300'000.0f), i * 16'000);
  ASSERT_EQ(frames_.size(), 4u);
  EXPECT_EQ(frames_[3].capture_time_us - frames_[0].capture_time_us, 48'000);
  EXPECT_EQ(counters().reordered, 0u);
}

// A hostile clock that jumps back and forth must not cause an overflow.
TEST_F(Vmc, JumpingClockContinuesByArrival) {
  const auto frame = [](float seconds) { return Packet().Bone("Hips", {0, 1, 0}).Time(seconds); };
  Push(frame(1.0f), 0);
  for (int i = 1; i <= 10'000; ++i) Push(frame(i % 2 == 0 ? 1.0f : 9e8f), i * 10'000);
  ASSERT_EQ(frames_.size(), 10'001u);
  EXPECT_EQ(frames_.back().capture_time_us - frames_.front().capture_time_us, 100'000'000);
}

TEST_F(Vmc, RotationsKeepTheirSign) {
  Push(Packet().Bone("Hips", {0, 1, 0}, {0, 0, 0, 1}).Apply());
  Push(Packet().Bone("Hips", {0, 1, 0}, {0, -0.1f, 0, -0.99f}).Apply());
  ASSERT_EQ(frames_.size(), 2u);
  EXPECT_GT(frames_[1].joints[0].rotation.w, 0.9f);
}

TEST_F(Vmc, AcceptsOldRootsAndExtraArguments) {
  Push(Packet().Message("/VMC/Ext/Root/Pos", "fffffff", "", {1, 2, 3, 0, 0, 0, 1}).Apply());
  Push(Packet()
           .Message("/VMC/Ext/Root/Pos", "sffffffffffff", "root",
                    {1, 2, 3, 0, 0, 0, 1, 1, 1, 1, 0, 0})
           .Apply());
  EXPECT_EQ(frames_.size(), 2u);
  EXPECT_EQ(counters().malformed, 0u);
}

TEST_F(Vmc, CountsBadMessagesAndKeepsState) {
  std::uint64_t expected = 0;
  const auto refuse = [&](const Packet& packet) {
    Push(packet);
    EXPECT_EQ(counters().malformed, ++expected);
  };
  refuse(Packet().Bone("Hips", {NAN, 0, 0}));
  refuse(Packet().Bone("Hips", {0, 2e6f, 0}));
  refuse(Packet().Bone("Hips", {0, 0, 0}, {0, 0, 0, 0}));
  refuse(Packet().Bone("Hips", {0, 0, 0}, {NAN, 0, 0, 1}));
  refuse(Packet().Bone("", {0, 0, 0}));
  refuse(Packet().Bone(std::string(256, 'x'), {0, 0, 0}));
  refuse(Packet().Message("/VMC/Ext/Bone/Pos", "sfff", "Hips", {0, 0, 0}));
  refuse(Packet().Message("/VMC/Ext/Bone/Pos", "fffffff", "", {0, 0, 0, 0, 0, 0, 1}));
  refuse(Packet().Blend("A", INFINITY));
  refuse(Packet().Message("/VMC/Ext/T", "", "", {}));
  Tick(1'000'000);
  EXPECT_TRUE(frames_.empty());
  Push(Packet().Message("/VMC/Ext/Cam", "s", "x", {}).Message("/other", "", "", {}));
  EXPECT_EQ(counters().ignored, 2u);
}

TEST_F(Vmc, BoundsNames) {
  Packet packet;
  for (int i = 0; i < 500; ++i) packet.Bone("bone_" + std::to_string(i), {0, 0, 1});
  for (int i = 0; i < 700; ++i) packet.Blend("shape_" + std::to_string(i), 0);
  Push(packet.Apply());
  ASSERT_EQ(frames_.size(), 1u);
  EXPECT_LE(frames_[0].joints.size(), 128u);
  EXPECT_EQ(frames_[0].blend_shapes.size(), static_cast<std::size_t>(kMaxBlendShapes));
  EXPECT_GT(counters().malformed, 0u);
}

TEST_F(Vmc, SurvivesTruncationAndCorruption) {
  const Bytes good =
      Packet().Bone("Hips", {0, 1, 0}).Blend("A", 1).Root({}).Ok(1).Apply().Time(1).bytes();
  test::ForEveryTruncation(good, [this](std::span<const std::uint8_t> cut) { PushBytes(cut); });
  test::ForEveryCorruption(good, [this](std::span<const std::uint8_t> bad) { PushBytes(bad); });
  EXPECT_GT(counters().malformed, 100u);
}

TEST_F(Vmc, DoesNotAllocateAfterWarmUp) {
  std::vector<Bytes> packets;
  for (int i = 0; i < 12; ++i) {
    packets.push_back(Packet()
                          .Bone("Hips", {0, 1, 0})
                          .Bone("Spine", {})
                          .Blend("A", 1)
                          .Apply()
                          .Time(0.25f * static_cast<float>(i))
                          .bytes());
  }
  const FrameSink sink = [](const NeutralFrame&) {};
  for (std::size_t i = 0; i < 2; ++i) adapter_->Push(packets[i], 0, sink);
  const std::uint64_t before = furrow::test::NumAllocations();
  for (std::size_t i = 2; i < packets.size(); ++i) adapter_->Push(packets[i], 0, sink);
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_GE(counters().accepted, 11u);
}

// Foreign frames become an offer and poses that the codec accepts.
TEST_F(Vmc, FramesBecomeValidOffersAndPoses) {
  Push(Packet().Root({}).Bone("Hips", {0, 1, 0}).Bone("Spine", {}).Blend("A", 1).Apply());
  Push(Packet().Root({1, 0, 0}).Bone("Hips", {0, 1.5f, 0}, {0.6f, 0, 0, 0.8f}).Apply(), 1000);
  ASSERT_EQ(frames_.size(), 2u);
  const SkeletonOffer offer = MakeOffer(frames_[1]);
  SkeletonOffer received;
  ASSERT_EQ(test::OpenAndDecode(test::Encoded(offer), received), DecodeStatus::kOk);
  EXPECT_EQ(received.skeleton_hash, offer.skeleton_hash);
  PoseFrame pose;
  PoseFrame out;
  MakePose(frames_[1], offer, pose);
  ASSERT_EQ(test::OpenAndDecode(test::Encoded(pose), out), DecodeStatus::kOk);
  ASSERT_EQ(out.rotations.size(), 3u);
  EXPECT_EQ(out.translations[0], (Vec3{-1, 0, 0}));
  EXPECT_NEAR(out.translations[1].y, 0.5f, 1e-6f);
  EXPECT_EQ(out.translations[2], (Vec3{0, 0, 0}));
  EXPECT_NEAR(out.rotations[1].x, 0.6f, 1e-6f);
  EXPECT_EQ(out.blend_shapes.size(), 1u);
}

}  // namespace
}  // namespace furrow::protocol::mocap
