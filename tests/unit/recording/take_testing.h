// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "protocol/framing/envelope.h"
#include "protocol/messages/hash.h"
#include "recording/take_reader.h"
#include "recording/take_writer.h"
#include "tests/temporary_folder.h"

namespace furrow::recording {

// Provides a temporary folder and messages as a daemon records them: two joints, one blend shape.
class TakeTest : public testing::Test {
 protected:
  template <class Message>
  std::vector<std::uint8_t> Payload(const Message& message) {
    encoder_.Encode({.session = 1}, message, bytes_);
    return {bytes_.begin() + protocol::kEnvelopeBytes, bytes_.end()};
  }
  static protocol::SkeletonOffer Offer(const std::string& subject, float length = 2.0f) {
    protocol::SkeletonOffer offer;
    offer.subject = subject;
    offer.joints = {{.name = "hip"}, {.name = "knee", .parent = 0}};
    offer.joints[1].rest_translation = {0.0f, length, 0.0f};
    offer.blend_shape_names = {"jawOpen"};
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    return offer;
  }
  static protocol::PoseFrame Pose(float jaw, float lift = 0.0f) {
    protocol::PoseFrame pose;
    pose.skeleton_hash = Offer("").skeleton_hash;
    pose.num_joints = 2;
    pose.num_blend_shapes = 1;
    pose.rotations.resize(2);
    pose.rotation_joints = {0, 1};
    pose.translation_joints = {1};
    pose.translations = {{0.0f, lift, 0.0f}};
    pose.blend_shape_indices = {0};
    pose.blend_shapes = {jaw};
    return pose;
  }
  // The stamp of message i in a stream at 100 Hz. Its clock starts at 7 s, one hour after the
  // epoch.
  static TakeStamp Stamp(std::uint32_t i, std::uint64_t session = 5) {
    return {session, i, 7'000'000 + 10'000 * std::int64_t{i},
            3'600'000'000'000 + 10'000'000 * std::uint64_t{i}};
  }
  // Writes a subject's skeleton and `count` poses. Each opens the jaw by another hundredth.
  void WriteSubject(TakeWriter& take, const std::string& subject, int count) {
    ASSERT_TRUE(take.Write(TakeKind::kSkeleton, subject, Stamp(0), Payload(Offer(subject))).ok());
    for (int i = 0; i < count; ++i) {
      const auto payload = Payload(Pose(0.01f * static_cast<float>(i), static_cast<float>(i)));
      const TakeStamp stamp = Stamp(static_cast<std::uint32_t>(i));
      ASSERT_TRUE(take.Write(TakeKind::kPose, subject, stamp, payload).ok());
    }
  }
  std::unique_ptr<TakeWriter> Create(const std::string& name) {
    auto take = TakeWriter::Create(folder_ / name, "{}");
    EXPECT_TRUE(take.ok()) << take.status().ToString();
    return take.ok() ? *std::move(take) : nullptr;
  }
  std::unique_ptr<TakeReader> Open(const std::string& name) {
    auto take = TakeReader::Open(folder_ / name);
    EXPECT_TRUE(take.ok()) << take.status().ToString();
    return take.ok() ? *std::move(take) : nullptr;
  }

  TemporaryFolder folder_;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace furrow::recording
