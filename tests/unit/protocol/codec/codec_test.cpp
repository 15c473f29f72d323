// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/codec.h"

#include <set>

#include <gtest/gtest.h>

#include "protocol/messages/hash.h"
#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Encoded;
using test::OpenAndDecode;

// Decodes `bytes` as the kind that its identifier states.
DecodeStatus DecodeAny(std::span<const std::uint8_t> bytes) {
  MessageView view;
  const DecodeStatus status = OpenMessage(bytes, view);
  if (status != DecodeStatus::kOk) return status;
  const auto decode = [&view](auto message) { return Decode(view, message); };
  switch (view.kind) {
    case MessageKind::kHello: return decode(Hello{});
    case MessageKind::kWelcome: return decode(Welcome{});
    case MessageKind::kPing: return decode(Ping{});
    case MessageKind::kPong: return decode(Pong{});
    case MessageKind::kGoodbye: return decode(Goodbye{});
    case MessageKind::kError: return decode(ErrorMessage{});
    case MessageKind::kSkeletonOffer: return decode(SkeletonOffer{});
    case MessageKind::kSkeletonReply: return decode(SkeletonReply{});
    case MessageKind::kPose: return decode(PoseFrame{});
    case MessageKind::kSubscribeWeights: return decode(SubscribeWeights{});
    case MessageKind::kSubscribePictures: return decode(SubscribePictures{});
    case MessageKind::kUnsubscribe: return decode(Unsubscribe{});
    case MessageKind::kSubscribeReply: return decode(SubscribeReply{});
    case MessageKind::kWeights: return decode(WeightFrame{});
    case MessageKind::kImage: return decode(ImageFrame{});
    case MessageKind::kSubscribePoses: return decode(SubscribePoses{});
    case MessageKind::kDropped: return decode(Dropped{});
    case MessageKind::kListSubjects: return decode(ListSubjects{});
    case MessageKind::kSubjects: return decode(Subjects{});
    case MessageKind::kUpdatePictures: return decode(UpdatePictures{});
    case MessageKind::kFrameAck: return decode(FrameAck{});
    case MessageKind::kSubjectState: return decode(SubjectState{});
    case MessageKind::kDrain: return decode(Drain{});
    case MessageKind::kDrainState: return decode(DrainState{});
    case MessageKind::kUnknown: break;
  }
  return DecodeStatus::kUnknownKind;
}

std::vector<test::Bytes> OneOfEach() {
  SubscribePictures pictures;
  pictures.has_camera = true;
  pictures.settings = {"shading=skin", "wrinkles=off"};
  return {Encoded(Hello{"a/1", 5}),
          Encoded(Welcome{"b/2", 6}),
          Encoded(Ping{1}),
          Encoded(Pong{1, 2}),
          Encoded(Goodbye{GoodbyeReason::kTimedOut}),
          Encoded(ErrorMessage{ErrorCode::kLimit, "too much"}),
          Encoded(test::MakeOffer(5, 3)),
          Encoded(SkeletonReply{9, SkeletonStatus::kRejected, "no"}),
          Encoded(test::MakePose(5, 3, 1)),
          Encoded(test::MakePose(5, 3, 2), PoseEncoding::Small()),
          Encoded(SubscribeWeights{"s", true, "a,b", 5, WeightFormat::kU8,
                                   WeightSource::kDriverValues}),
          Encoded(pictures),
          Encoded(SubscribePoses{"s", true, 5, true}),
          Encoded(Dropped{7}),
          Encoded(ListSubjects{true}),
          Encoded(Subjects{{"a", "b"}, 2}),
          Encoded(test::MakeState(5, 3)),
          Encoded(Drain{true}),
          Encoded(DrainState{true, 1, 2, {"a", "b"}, "no room"}),
          Encoded(UpdatePictures{pictures}),
          Encoded(FrameAck{3}),
          Encoded(Unsubscribe{}),
          Encoded(SubscribeReply{"s", 0, {"a.b", "c.d"}}),
          Encoded(WeightFrame{3, 4, WeightFormat::kF32, {0.25f, 1.0f}}),
          Encoded(WeightFrame{3, 4, WeightFormat::kU8, {0.0f, 1.0f}}),
          Encoded(ImageFrame{4, 3, ImageFormat::kPng, 0, {1, 2, 3}})};
}

TEST(Codec, RecognisesEveryKind) {
  std::set<MessageKind> kinds;
  for (const test::Bytes& bytes : OneOfEach()) {
    MessageView view;
    ASSERT_EQ(OpenMessage(bytes, view), DecodeStatus::kOk);
    EXPECT_EQ(view.header, test::kHeader);
    EXPECT_EQ(DecodeAny(bytes), DecodeStatus::kOk) << MessageKindName(view.kind);
    kinds.insert(view.kind);
  }
  EXPECT_EQ(kinds.size(), 24u);
}

TEST(Codec, RejectsEveryTruncation) {
  for (const test::Bytes& bytes : OneOfEach()) {
    test::ForEveryTruncation(bytes, [](std::span<const std::uint8_t> cut) {
      EXPECT_NE(DecodeAny(cut), DecodeStatus::kOk) << cut.size();
    });
  }
}

// The payload size is changed to match the cut, so that only lengths inside FlatBuffers are wrong.
TEST(Codec, NeverReadsBeyondATruncationWithMatchingEnvelope) {
  for (const test::Bytes& bytes : OneOfEach()) {
    test::ForEveryTruncation(bytes, [](std::span<const std::uint8_t> cut) {
      if (cut.size() < kEnvelopeBytes) return;
      const auto block = std::make_unique<std::uint8_t[]>(cut.size());
      std::copy(cut.begin(), cut.end(), block.get());
      const std::span<std::uint8_t> copy(block.get(), cut.size());
      Envelope envelope;
      ASSERT_EQ(ReadEnvelope(copy, envelope), EnvelopeStatus::kOk);
      envelope.payload_bytes = static_cast<std::uint32_t>(cut.size() - kEnvelopeBytes);
      WriteEnvelope(envelope, copy.first<kEnvelopeBytes>());
      (void)DecodeAny(copy);
    });
  }
}

// The difference of any two capture times must not overflow.
TEST(Codec, BoundsCaptureTimes) {
  constexpr std::int64_t kBound = std::int64_t{1} << 62;
  const auto status = [](std::int64_t time) {
    test::Bytes bytes;
    Encoder().Encode({.session = 1, .capture_time_us = time}, PoseFrame{}, bytes);
    return DecodeAny(bytes);
  };
  for (const std::int64_t time : {kBound - 1, -kBound + 1, std::int64_t{0}}) {
    EXPECT_EQ(status(time), DecodeStatus::kOk) << time;
  }
  for (const std::int64_t time : {kBound, -kBound, INT64_MAX, INT64_MIN}) {
    EXPECT_EQ(status(time), DecodeStatus::kBadValue) << time;
  }
}

TEST(Codec, RejectsExtraBytes) {
  for (test::Bytes bytes : OneOfEach()) {
    bytes.push_back(0);
    EXPECT_EQ(DecodeAny(bytes), DecodeStatus::kBadLength);
  }
}

TEST(Codec, DecodesOrRejectsCorruptedBytes) {
  std::size_t refused = 0;
  for (const test::Bytes& bytes : OneOfEach()) {
    test::ForEveryCorruption(bytes, [&refused](std::span<const std::uint8_t> bad) {
      refused += DecodeAny(bad) != DecodeStatus::kOk ? 1 : 0;
    });
  }
  EXPECT_GT(refused, 1000u);
}

TEST(Codec, DecodesUnalignedBytes) {
  for (const test::Bytes& bytes : OneOfEach()) {
    for (std::size_t shift = 1; shift < 8; ++shift) {
      test::Bytes shifted(bytes.size() + shift);
      std::copy(bytes.begin(), bytes.end(), shifted.begin() + static_cast<std::ptrdiff_t>(shift));
      EXPECT_EQ(DecodeAny(std::span(shifted).subspan(shift)), DecodeStatus::kOk);
    }
  }
}

TEST(Codec, RejectsFragmentsOversizeAndUnknownKinds) {
  test::Bytes bytes = Encoded(Ping{1});
  MessageView view;
  EXPECT_EQ(OpenMessage(bytes, view, bytes.size() - 1), DecodeStatus::kBadLength);
  test::Bytes fragment = bytes;
  fragment[5] = kFlagFragment;
  EXPECT_EQ(OpenMessage(fragment, view), DecodeStatus::kBadFlags);
  bytes[kEnvelopeBytes + 7] = '?';
  EXPECT_EQ(OpenMessage(bytes, view), DecodeStatus::kUnknownKind);
  Pong pong;
  EXPECT_EQ(OpenAndDecode(Encoded(Ping{1}), pong), DecodeStatus::kWrongKind);
}

TEST(Codec, EveryStatusAndKindHasAUniqueName) {
  std::set<std::string_view> names;
  for (int i = 0; i < kNumDecodeStatuses; ++i) {
    names.insert(DecodeStatusName(static_cast<DecodeStatus>(i)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kNumDecodeStatuses));
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_EQ(MessageKindName(MessageKind::kPose), "pose");
}

TEST(Codec, PoseAndWeightsDoNotAllocateAfterWarmUp) {
  Encoder encoder;
  test::Bytes bytes;
  PoseFrame pose;
  WeightFrame weights{1, 0, WeightFormat::kF32, std::vector<float>(60, 0.5f)};
  PoseFrame full = test::MakePose(163, 52, 3);
  PoseFrame partial = test::MakePose(40, 0, 4);
  partial.num_joints = 163;
  const auto round = [&] {
    for (const PoseEncoding& encoding : {PoseEncoding{}, PoseEncoding::Small()}) {
      for (const PoseFrame* message : {&full, &partial}) {
        encoder.Encode(test::kHeader, *message, bytes, encoding);
        ASSERT_EQ(OpenAndDecode(bytes, pose), DecodeStatus::kOk);
        // An odd address makes the decoder copy to thread-local memory.
        bytes.insert(bytes.begin(), 0);
        ASSERT_EQ(OpenAndDecode(std::span(bytes).subspan(1), pose), DecodeStatus::kOk);
      }
    }
    for (const WeightFormat format : {WeightFormat::kF32, WeightFormat::kU8}) {
      weights.format = format;
      encoder.Encode(test::kHeader, weights, bytes);
      ASSERT_EQ(OpenAndDecode(bytes, weights), DecodeStatus::kOk);
    }
  };
  for (int i = 0; i < 3; ++i) round();
  const std::uint64_t before = furrow::test::NumAllocations();
  for (int i = 0; i < 10; ++i) round();
  EXPECT_EQ(furrow::test::NumAllocations(), before);
}

}  // namespace
}  // namespace furrow::protocol
