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

using test::DecodeChanged;
using test::Encoded;
using test::OpenAndDecode;

// Encodes a default message after `change`, and decodes it.
TEST(SubscriptionMessages, WeightRequestRoundTrip) {
  const SubscribeWeights sent{
      "anna", true, "a*,b?", 60, WeightFormat::kU8, WeightSource::kDriverValues, true};
  SubscribeWeights out;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.subject, "anna");
  EXPECT_TRUE(out.wait);
  EXPECT_EQ(out.pattern, "a*,b?");
  EXPECT_EQ(out.max_rate_hz, 60.0f);
  EXPECT_EQ(out.format, WeightFormat::kU8);
  EXPECT_EQ(out.source, WeightSource::kDriverValues);
  EXPECT_TRUE(out.every);
  ASSERT_EQ(OpenAndDecode(Encoded(SubscribeWeights{}), out), DecodeStatus::kOk);
  EXPECT_EQ(out.pattern, "*");
  EXPECT_EQ(out.subject, "");
  EXPECT_FALSE(out.every);
}

TEST(SubscriptionMessages, RejectsBadWeightRequest) {
  using S = SubscribeWeights;
  const auto with = [](const auto& change) { return DecodeChanged(S(), change); };
  EXPECT_EQ(with([](S& s) { s.max_rate_hz = -1; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.max_rate_hz = 1001; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.max_rate_hz = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(with([](S& s) { s.pattern = std::string(4097, '*'); }), DecodeStatus::kLimit);
  EXPECT_EQ(with([](S& s) { s.subject = "\x01"; }), DecodeStatus::kBadText);
  EXPECT_EQ(with([](S& s) { s.format = static_cast<WeightFormat>(2); }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.source = static_cast<WeightSource>(2); }), DecodeStatus::kBadValue);
}

TEST(SubscriptionMessages, PoseRequestRoundTripAndChecks) {
  using S = SubscribePoses;
  S out;
  ASSERT_EQ(OpenAndDecode(Encoded(S{"anna", true, 30, true}), out), DecodeStatus::kOk);
  EXPECT_EQ(out.subject, "anna");
  EXPECT_TRUE(out.wait);
  EXPECT_EQ(out.max_rate_hz, 30.0f);
  EXPECT_TRUE(out.every);
  ASSERT_EQ(OpenAndDecode(Encoded(S{}), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.every);
  const auto with = [](const auto& change) { return DecodeChanged(S(), change); };
  EXPECT_EQ(with([](S& s) { s.max_rate_hz = -1; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.max_rate_hz = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(with([](S& s) { s.subject = std::string(256, 'a'); }), DecodeStatus::kLimit);
}

TEST(SubscriptionMessages, ReplyCarriesHashedNames) {
  SubscribeReply out;
  const SubscribeReply sent{"anna", 0, {"brow_l.squash", "nose.squash"}};
  std::vector<std::uint8_t> bytes = Encoded(sent);
  ASSERT_EQ(OpenAndDecode(bytes, out), DecodeStatus::kOk);
  EXPECT_EQ(out.names, sent.names);
  EXPECT_EQ(out.names_hash, NamesHash(sent.names));
  EXPECT_EQ(out.publisher_session, 0u);
  const std::string_view name = "nose";
  *std::search(bytes.begin(), bytes.end(), name.begin(), name.end()) = 'N';
  EXPECT_EQ(OpenAndDecode(bytes, out), DecodeStatus::kBadHash);
  ASSERT_EQ(OpenAndDecode(Encoded(SubscribeReply{}), out), DecodeStatus::kOk);
  EXPECT_TRUE(out.names.empty());
  ASSERT_EQ(OpenAndDecode(Encoded(SubscribeReply{"anna", 0, {}, 77}), out), DecodeStatus::kOk);
  EXPECT_EQ(out.publisher_session, 77u);
  EXPECT_EQ(out.names_hash, 0u);
  SubscribeReply many;
  for (int i = 0; i <= kMaxWeights; ++i) many.names.push_back(std::to_string(i));
  EXPECT_EQ(OpenAndDecode(Encoded(many), out), DecodeStatus::kLimit);
}

}  // namespace
}  // namespace furrow::protocol
