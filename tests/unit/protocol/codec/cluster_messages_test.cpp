// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/cluster_messages.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::DecodeChanged;
using test::Encoded;
using test::MakeState;
using test::OpenAndDecode;

// Encodes a state after `change`, and decodes it.
TEST(ClusterMessages, AStateComesBackToTheBit) {
  const SubjectState sent = MakeState(5, 3);
  SubjectState out = MakeState(2, 1);  // what was there before leaves no trace
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.subject, "anna");
  EXPECT_EQ(out.skeleton_hash, sent.skeleton_hash);
  EXPECT_EQ(out.publisher_session, sent.publisher_session);
  EXPECT_EQ(out.run, sent.run);
  ASSERT_TRUE(out.has_pose);
  EXPECT_EQ(out.newest_sequence, 10u);
  EXPECT_EQ(out.pose.rotations, sent.pose.rotations);
  EXPECT_EQ(out.pose.blend_shapes, sent.pose.blend_shapes);
  ASSERT_TRUE(out.has_neutral);
  EXPECT_EQ(out.neutral.translations, sent.neutral.translations);
  EXPECT_EQ(out.values_hash, sent.values_hash);
  EXPECT_EQ(out.num_drivers, sent.num_drivers);
  EXPECT_EQ(out.filtered, sent.filtered);
  EXPECT_EQ(out.inputs, sent.inputs);
  EXPECT_EQ(out.speeds, sent.speeds);
  EXPECT_EQ(out.since_input_s, sent.since_input_s);
  EXPECT_EQ(out.captures, "{}");
}

TEST(ClusterMessages, AStateMayHaveNoPosesYet) {
  SubjectState sent;
  sent.subject = "anna";
  SubjectState out = MakeState(5, 3);
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.has_pose);
  EXPECT_FALSE(out.has_neutral);
  EXPECT_TRUE(out.filtered.empty());
  EXPECT_EQ(out.captures, "");
}

TEST(ClusterMessages, RejectsBadStates) {
  using S = SubjectState;
  const auto with = [](const auto& change) { return DecodeChanged(MakeState(5, 3), change); };
  EXPECT_EQ(with([](S& s) { s.subject = ""; }), DecodeStatus::kMissingField);
  EXPECT_EQ(with([](S& s) { s.subject = std::string(256, 'a'); }), DecodeStatus::kLimit);
  EXPECT_EQ(with([](S& s) { s.subject = "\x01"; }), DecodeStatus::kBadText);
  EXPECT_EQ(with([](S& s) { s.pose.partial = true; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.neutral.partial = true; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.pose.skeleton_hash = 43; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.neutral.skeleton_hash = 43; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.pose.previous = {1, 2, 3}; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.pose.blend_shapes[0] = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(with([](S& s) { s.neutral.rotations[1].w += 1.0f; }), DecodeStatus::kNotUnit);
  EXPECT_EQ(with([](S& s) { s.inputs.pop_back(); }), DecodeStatus::kBadCount);
  EXPECT_EQ(with([](S& s) { s.speeds.push_back(0.0f); }), DecodeStatus::kBadCount);
  EXPECT_EQ(with([](S& s) { s.filtered[1] = 1.5f; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.inputs[0] = -0.5f; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.filtered[0] = INFINITY; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(with([](S& s) { s.speeds[0] = 2e6f; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.since_input_s = -1.0; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.since_input_s = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(with([](S& s) { s.captures = std::string(65'537, ' '); }), DecodeStatus::kLimit);
  EXPECT_EQ(with([](S& s) {
              s.filtered.assign(2049, 0.0f);
              s.inputs = s.speeds = s.filtered;
            }),
            DecodeStatus::kLimit);
}

TEST(ClusterMessages, ProgressOfADrain) {
  Drain drain;
  ASSERT_EQ(OpenAndDecode(Encoded(Drain{true}), drain), DecodeStatus::kOk);
  EXPECT_TRUE(drain.begin);
  DrainState out;
  ASSERT_EQ(OpenAndDecode(Encoded(DrainState{true, 3, 2, {"anna", "bob"}, "no room"}), out),
            DecodeStatus::kOk);
  EXPECT_TRUE(out.draining);
  EXPECT_EQ(out.moved, 3u);
  EXPECT_EQ(out.left, 2u);
  EXPECT_EQ(out.names, (std::vector<std::string>{"anna", "bob"}));
  EXPECT_EQ(out.why, "no room");
  EXPECT_EQ(OpenAndDecode(Encoded(DrainState{true, 0, 1, {"anna", "bob"}, ""}), out),
            DecodeStatus::kBadCount);
  DrainState many;
  for (int i = 0; i <= kMaxLeftNames; ++i) many.names.push_back(std::to_string(i));
  many.left = static_cast<std::uint32_t>(many.names.size());
  EXPECT_EQ(OpenAndDecode(Encoded(many), out), DecodeStatus::kLimit);
}

}  // namespace
}  // namespace furrow::protocol
