// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "protocol/messages/hash.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Encoded;
using test::OpenAndDecode;

DecodeStatus Decoded(const SkeletonOffer& offer) {
  SkeletonOffer out;
  return OpenAndDecode(Encoded(offer), out);
}

template <class Change>
DecodeStatus With(const Change& change) {
  return test::DecodeChanged(test::MakeOffer(6, 3), change);
}

TEST(SkeletonMessages, RoundTripIsExact) {
  SkeletonOffer offer = test::MakeOffer(6, 3);
  offer.joints[4].rest_scale = {1, 2, 3};
  offer.joints[2].rest_rotation = {0.6f, 0, 0, 0.8f};
  offer.metres_per_unit = 0.0254f;
  SkeletonOffer out = test::MakeOffer(9, 1);  // old content must not remain
  ASSERT_EQ(OpenAndDecode(Encoded(offer), out), DecodeStatus::kOk);
  EXPECT_EQ(out.subject, offer.subject);
  EXPECT_EQ(out.skeleton_hash, SkeletonHash(offer));
  EXPECT_EQ(out.metres_per_unit, offer.metres_per_unit);
  EXPECT_EQ(out.blend_shape_names, offer.blend_shape_names);
  ASSERT_EQ(out.joints.size(), offer.joints.size());
  for (std::size_t i = 0; i < offer.joints.size(); ++i) {
    EXPECT_EQ(out.joints[i].name, offer.joints[i].name);
    EXPECT_EQ(out.joints[i].parent, offer.joints[i].parent);
    EXPECT_EQ(out.joints[i].rest_translation, offer.joints[i].rest_translation);
    EXPECT_EQ(out.joints[i].rest_rotation, offer.joints[i].rest_rotation);
    EXPECT_EQ(out.joints[i].rest_scale, offer.joints[i].rest_scale);
    EXPECT_EQ(out.joints[i].has_tail, offer.joints[i].has_tail);
    EXPECT_EQ(out.joints[i].tail, offer.joints[i].tail);
  }
}

TEST(SkeletonMessages, RejectsEachFault) {
  EXPECT_EQ(With([](auto&) {}), DecodeStatus::kOk);
  EXPECT_EQ(With([](auto& o) { o.subject.clear(); }), DecodeStatus::kMissingField);
  EXPECT_EQ(With([](auto& o) { o.subject = std::string(256, 'x'); }), DecodeStatus::kLimit);
  EXPECT_EQ(With([](auto& o) { o.joints[3].name = "joint_1"; }), DecodeStatus::kBadText);
  EXPECT_EQ(With([](auto& o) { o.joints[3].name.clear(); }), DecodeStatus::kBadText);
  EXPECT_EQ(With([](auto& o) { o.joints[3].parent = 3; }), DecodeStatus::kBadValue);
  EXPECT_EQ(With([](auto& o) { o.joints[3].parent = 5; }), DecodeStatus::kBadValue);
  EXPECT_EQ(With([](auto& o) { o.joints[3].parent = -2; }), DecodeStatus::kBadValue);
  EXPECT_EQ(With([](auto& o) { o.joints[3].rest_translation.y = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(With([](auto& o) { o.joints[3].rest_scale.y = INFINITY; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(With([](auto& o) { o.joints[2].tail.y = 2e6f; }), DecodeStatus::kBadValue);
  EXPECT_EQ(With([](auto& o) { o.joints[3].rest_rotation.w = 0.5f; }), DecodeStatus::kNotUnit);
  EXPECT_EQ(With([](auto& o) { o.metres_per_unit = 0.0f; }), DecodeStatus::kBadValue);
  EXPECT_EQ(With([](auto& o) { o.blend_shape_names[1] = "shape_0"; }), DecodeStatus::kBadText);
  EXPECT_EQ(With([](auto& o) {
              o.joints.clear();
              o.blend_shape_names.clear();
            }),
            DecodeStatus::kMissingField);
}

TEST(SkeletonMessages, LimitsAreExact) {
  EXPECT_EQ(Decoded(test::MakeOffer(kMaxJoints, kMaxBlendShapes)), DecodeStatus::kOk);
  EXPECT_EQ(Decoded(test::MakeOffer(kMaxJoints + 1, 0)), DecodeStatus::kLimit);
  EXPECT_EQ(Decoded(test::MakeOffer(1, kMaxBlendShapes + 1)), DecodeStatus::kLimit);
  EXPECT_EQ(Decoded(test::MakeOffer(0, 1)), DecodeStatus::kOk);
}

TEST(SkeletonMessages, RejectsWrongHash) {
  std::vector<std::uint8_t> bytes = Encoded(test::MakeOffer(6, 0));
  const std::string_view name = "joint_3";
  const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  ASSERT_NE(at, bytes.end());
  *at = 'J';
  SkeletonOffer out;
  EXPECT_EQ(OpenAndDecode(bytes, out), DecodeStatus::kBadHash);
}

TEST(SkeletonMessages, ReplyRoundTrip) {
  SkeletonReply reply;
  ASSERT_EQ(OpenAndDecode(Encoded(SkeletonReply{5, SkeletonStatus::kNeeded, "why"}), reply),
            DecodeStatus::kOk);
  EXPECT_EQ(reply.skeleton_hash, 5u);
  EXPECT_EQ(reply.status, SkeletonStatus::kNeeded);
  EXPECT_EQ(reply.message, "why");
  const auto bytes = Encoded(SkeletonReply{5, static_cast<SkeletonStatus>(3), ""});
  EXPECT_EQ(OpenAndDecode(bytes, reply), DecodeStatus::kBadValue);
}

}  // namespace
}  // namespace furrow::protocol
