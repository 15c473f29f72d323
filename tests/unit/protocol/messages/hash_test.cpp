// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/hash.h"

#include <gtest/gtest.h>

#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

// Published FNV-1a test vectors (Landon Curt Noll) that include the zero byte of the string.
TEST(Hash, AgreesWithPublishedVectors) {
  EXPECT_EQ(Hasher().value(), 0xcbf29ce484222325ULL);
  Hasher empty;
  empty.String("");
  EXPECT_EQ(empty.value(), 0xaf63bd4c8601b7dfULL);
  Hasher foobar;
  foobar.String("foobar");
  EXPECT_EQ(foobar.value(), 0x34531ca7168b8f38ULL);
}

TEST(Hash, DistinguishesNames) {
  const std::vector<std::string> ab_c = {"ab", "c"};
  const std::vector<std::string> a_bc = {"a", "bc"};
  EXPECT_NE(NamesHash(ab_c), NamesHash(a_bc));
  EXPECT_EQ(NamesHash({}), 0u);
}

TEST(Hash, CoversEverythingButTheSubject) {
  const SkeletonOffer base = test::MakeOffer(4, 2);
  const std::uint64_t hash = SkeletonHash(base);
  const auto with = [&base](const auto& change) {
    SkeletonOffer offer = base;
    change(offer);
    return SkeletonHash(offer);
  };
  EXPECT_EQ(with([](auto& o) { o.subject = "bob"; }), hash);
  EXPECT_NE(with([](auto& o) { o.metres_per_unit = 0.01f; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[1].name = "x"; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[3].parent = 1; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[1].rest_translation.z += 1; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[1].rest_rotation = {1, 0, 0, 0}; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[1].rest_scale.y = 2; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[2].has_tail = false; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints[2].tail.x = 1; }), hash);
  EXPECT_NE(with([](auto& o) { o.joints.pop_back(); }), hash);
  EXPECT_NE(with([](auto& o) { o.blend_shape_names[1] = "x"; }), hash);
}

}  // namespace
}  // namespace furrow::protocol
