// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/tamper.h"

#include <cmath>

#include <gtest/gtest.h>

#include "chaos_testing.h"
#include "protocol/framing/bundle.h"

namespace furrow::chaos {
namespace {

TEST(ChaosTamper, AFalsifiedPoseHasATurnedJointAndStaysValid) {
  protocol::PoseFrame pose{.skeleton_hash = 1, .num_joints = 2, .rotation_joints = {0, 1}};
  pose.rotations = {{0, 0, 0, 1}, {0, 0, 0, 1}};
  Packet packet;
  protocol::Encoder().Encode({.session = 5}, pose, packet);
  ASSERT_TRUE(Falsify(&packet, 0.99));
  const protocol::PoseFrame decoded = PoseOf(packet);
  EXPECT_NEAR(decoded.rotations[0].w, 1.0f, 1e-4f);
  EXPECT_NEAR(decoded.rotations[1].w, 0.5f, 1e-4f);
  EXPECT_NEAR(std::abs(decoded.rotations[1].x), 0.8660254f, 1e-4f);
}

TEST(ChaosTamper, APoseWithoutJointsHasABlendShapeFalsified) {
  protocol::PoseFrame face{.skeleton_hash = 1, .num_blend_shapes = 2};
  face.blend_shape_indices = {0, 1};
  face.blend_shapes = {0.25f, 0.75f};
  Packet packet;
  protocol::Encoder().Encode({.session = 5}, face, packet);
  ASSERT_TRUE(Falsify(&packet, 0.5));
  EXPECT_EQ(PoseOf(packet).blend_shapes, (std::vector<float>{0.25f, 0.25f}));
}

TEST(ChaosTamper, AFalsifiedPoseKeepsItsEncoding) {
  const protocol::PoseFrame pose = WholeBody(60);
  for (const auto& encoding : {protocol::PoseEncoding{}, protocol::PoseEncoding::Small()}) {
    Packet packet;
    protocol::Encoder().Encode({.session = 5}, pose, packet, encoding);
    const std::size_t size = packet.size();
    ASSERT_TRUE(Falsify(&packet, 0.5));
    EXPECT_EQ(packet.size(), size);
  }
}

TEST(ChaosTamper, OtherMessagesAreUnchanged) {
  Packet hello;
  protocol::Encoder().Encode({.session = 5}, protocol::Hello{.client = "x"}, hello);
  const Packet before = hello;
  EXPECT_FALSE(Falsify(&hello, 0.5));
  Packet weights = Weights(1, {0.5f});
  EXPECT_FALSE(SwapContents(&hello, &weights));
  EXPECT_EQ(hello, before);
  for (std::size_t size = 0; size < weights.size(); ++size) {
    Packet cut(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(Falsify(&cut, 0.5));
  }
}

// Returns the values of each message of a bundle.
std::vector<std::vector<float>> ValuesOfBundle(Packet bundle) {
  protocol::Unbundler unbundler;
  EXPECT_EQ(unbundler.Open(bundle), protocol::BundleStatus::kOk);
  std::vector<std::vector<float>> values;
  std::span<const std::uint8_t> message;
  std::uint32_t sequence = 0;
  while (unbundler.Next(message))
    values.push_back(ValuesOf(Packet(message.begin(), message.end()), &sequence));
  return values;
}

TEST(ChaosTamper, OneMessageOfABundleIsFalsified) {
  const std::vector<Packet> messages = {Weights(1, {0.1f, 0.2f}), Weights(2, {0.3f, 0.4f})};
  for (const double share : {0.0, 0.3, 0.6, 0.99}) {
    Packet bundle;
    ASSERT_TRUE(protocol::WriteBundle(messages, bundle));
    ASSERT_TRUE(Falsify(&bundle, share));
    std::vector<std::vector<float>> expected = {{0.1f, 0.2f}, {0.3f, 0.4f}};
    const auto place = static_cast<std::size_t>(share * 4.0);
    expected[place / 2][place % 2] += 0.5f;
    EXPECT_EQ(ValuesOfBundle(bundle), expected);
  }
}

TEST(ChaosTamper, BundlesSwapOneMessageIfBothStillFit) {
  Packet ping;
  protocol::Encoder().Encode({.session = 5}, protocol::Ping{}, ping);
  Packet a;
  Packet b = Weights(3, {0.9f});
  ASSERT_TRUE(protocol::WriteBundle(std::vector<Packet>{ping, Weights(1, {0.1f})}, a));
  ASSERT_TRUE(IsTamperable(a));
  ASSERT_TRUE(SwapContents(&a, &b));
  std::uint32_t sequence = 0;
  EXPECT_EQ(ValuesOf(b, &sequence), std::vector<float>{0.1f});
  EXPECT_EQ(sequence, 3u);
  protocol::Unbundler unbundler;
  (void)unbundler.Open(a);
  std::span<const std::uint8_t> message;
  ASSERT_TRUE(unbundler.Next(message));
  EXPECT_EQ(Packet(message.begin(), message.end()), ping);
  ASSERT_TRUE(unbundler.Next(message));
  EXPECT_EQ(ValuesOf(Packet(message.begin(), message.end()), &sequence), std::vector<float>{0.9f});
  EXPECT_EQ(sequence, 1u);

  // A full bundle has no room for a larger message.
  Packet full;
  std::vector<Packet> messages;
  while (protocol::WriteBundle(messages, full) || messages.empty())
    messages.push_back(Weights(1, std::vector<float>(20)));
  messages.pop_back();
  ASSERT_TRUE(protocol::WriteBundle(messages, full));
  Packet large = Weights(2, std::vector<float>(250));
  const Packet before = full;
  EXPECT_FALSE(SwapContents(&full, &large));
  EXPECT_FALSE(SwapContents(&large, &full));
  EXPECT_EQ(full, before);
}

}  // namespace
}  // namespace furrow::chaos
