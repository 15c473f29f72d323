// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/bundle.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "protocol/framing/fragment.h"
#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Bytes;

// Makes a message of `bytes` bytes with a valid envelope and a random payload.
Bytes MessageOf(std::size_t bytes, std::uint32_t sequence, std::mt19937& random) {
  Bytes payload(bytes - kEnvelopeBytes);
  for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random());
  Bytes message;
  WriteMessage({.session = 7, .sequence = sequence}, payload, message);
  return message;
}

std::vector<Bytes> Unbundle(Bytes datagram, BundleStatus* status) {
  Unbundler unbundler;
  *status = unbundler.Open(datagram);
  std::vector<Bytes> messages;
  std::span<const std::uint8_t> message;
  while (unbundler.Next(message)) messages.emplace_back(message.begin(), message.end());
  EXPECT_FALSE(unbundler.has_more());
  return messages;
}

Bytes BundleOf(const std::vector<Bytes>& messages) {
  Bytes bundle;
  EXPECT_TRUE(WriteBundle(messages, bundle));
  return bundle;
}

// A bundle of three messages of one session, in which the tests change single bytes.
class Bundles : public testing::Test {
 protected:
  // Returns the status after byte `at` of message `i` was set to `value`.
  BundleStatus OpenChanged(std::size_t i, std::size_t at, std::uint8_t value) {
    Bytes bad = good_;
    for (std::size_t before = 0; before < i; ++before) at += messages_[before].size();
    bad[at] = value;
    return ExpectRejected(bad);
  }
  // A malformed bundle is returned whole and unchanged, and OpenMessage() rejects it.
  static BundleStatus ExpectRejected(const Bytes& bad) {
    BundleStatus status = BundleStatus::kOk;
    EXPECT_EQ(Unbundle(bad, &status), std::vector<Bytes>{bad});
    MessageView view;
    EXPECT_EQ(OpenMessage(bad, view), DecodeStatus::kBadFlags);
    return status;
  }

  std::vector<Bytes> messages_ = {test::Encoded(Ping{1}), test::Encoded(Goodbye{}),
                                  test::Encoded(Ping{3})};
  Bytes good_ = BundleOf(messages_);
};

TEST(BundleProperty, RoundTripKeepsMessagesAndOrder) {
  std::mt19937 random(5);
  for (int round = 0; round < 2000; ++round) {
    std::vector<Bytes> messages;
    std::size_t left = kMaxDatagramBytes;
    constexpr std::size_t kSmallest = kEnvelopeBytes + kMinPayloadBytes;
    while (left >= kSmallest) {
      const std::size_t size = kSmallest + random() % (left - kSmallest + 1);
      messages.push_back(MessageOf(size, static_cast<std::uint32_t>(messages.size()), random));
      left -= size;
      if (random() % 6 == 0) break;
    }
    BundleStatus status = BundleStatus::kTooLarge;
    EXPECT_EQ(Unbundle(BundleOf(messages), &status), messages);
    EXPECT_EQ(status, BundleStatus::kOk);
  }
}

TEST_F(Bundles, HoldOnlyMessagesAndTheFlag) {
  Bytes expected;
  for (const Bytes& message : messages_)
    expected.insert(expected.end(), message.begin(), message.end());
  expected[5] = 2;
  expected[messages_[0].size() + 5] = 2;
  EXPECT_EQ(good_, expected);
  MessageView view;
  EXPECT_EQ(OpenMessage(good_, view), DecodeStatus::kBadFlags)
      << "a client without support for bundles";
}

TEST_F(Bundles, OtherDatagramsPassUnchanged) {
  BundleStatus status = BundleStatus::kTooLarge;
  const Bytes fragment = [] {
    Bytes bytes(kMaxDatagramBytes);
    const Bytes large = test::Encoded(test::MakeOffer(163, 0));
    bytes.resize(WriteDatagram(large, 1, 0, bytes));
    return bytes;
  }();
  Bytes garbage(300, 0xFF);
  for (const Bytes& bytes : {BundleOf({messages_[0]}), fragment, garbage, Bytes(1, 2)}) {
    EXPECT_EQ(Unbundle(bytes, &status), std::vector<Bytes>{bytes});
    EXPECT_EQ(status, BundleStatus::kOk);
  }
  EXPECT_TRUE(Unbundle({}, &status).empty());
}

TEST_F(Bundles, FillADatagramExactly) {
  std::mt19937 random(1);
  std::vector<Bytes> messages = {MessageOf(600, 0, random), MessageOf(600, 1, random)};
  BundleStatus status = BundleStatus::kTooLarge;
  EXPECT_EQ(Unbundle(BundleOf(messages), &status), messages);
  EXPECT_EQ(status, BundleStatus::kOk);
  Bytes bundle;
  EXPECT_FALSE(WriteBundle({}, bundle));
  messages[1] = MessageOf(601, 1, random);
  EXPECT_FALSE(WriteBundle(messages, bundle));
  EXPECT_EQ(ExpectRejected(bundle), BundleStatus::kTooLarge);
}

TEST_F(Bundles, RejectEachFault) {
  EXPECT_EQ(OpenChanged(1, 0, 'X'), BundleStatus::kBadEnvelope) << "magic";
  EXPECT_EQ(OpenChanged(1, 4, 2), BundleStatus::kBadEnvelope) << "version";
  EXPECT_EQ(OpenChanged(1, 5, 4), BundleStatus::kBadEnvelope) << "undefined flag";
  EXPECT_EQ(OpenChanged(1, 5, kFlagFragment | kFlagFollowed), BundleStatus::kBadEnvelope);
  EXPECT_EQ(OpenChanged(2, 5, kFlagFollowed), BundleStatus::kBadEnvelope) << "nothing follows";
  EXPECT_EQ(OpenChanged(1, 5, kFlagFragment), BundleStatus::kFragment);
  EXPECT_EQ(OpenChanged(2, 5, kFlagFragment), BundleStatus::kFragment);
  EXPECT_EQ(OpenChanged(2, 8, 1), BundleStatus::kBadSession);
  EXPECT_EQ(OpenChanged(1, 5, 0), BundleStatus::kBadLength) << "ends before its datagram";
  const auto second = static_cast<std::uint8_t>(messages_[1].size() - kEnvelopeBytes);
  EXPECT_EQ(OpenChanged(1, 20, 0), BundleStatus::kBadLength) << "nothing in it";
  EXPECT_EQ(OpenChanged(1, 20, kMinPayloadBytes - 1), BundleStatus::kBadLength);
  EXPECT_EQ(OpenChanged(1, 20, second - 1), BundleStatus::kBadEnvelope) << "shorter than it is";
  EXPECT_EQ(OpenChanged(1, 20, second + 1), BundleStatus::kBadEnvelope) << "longer than it is";
  EXPECT_EQ(OpenChanged(1, 21, 1), BundleStatus::kBadLength) << "longer than its datagram";
  EXPECT_EQ(OpenChanged(1, 23, 0xFF), BundleStatus::kBadLength) << "longer than anything";
  EXPECT_EQ(OpenChanged(0, 23, 0xFF), BundleStatus::kBadLength);
  Bytes longer = good_;
  longer.push_back(0);
  EXPECT_EQ(ExpectRejected(longer), BundleStatus::kBadLength);
}

TEST_F(Bundles, RejectEveryTruncation) {
  test::ForEveryTruncation(good_, [](std::span<const std::uint8_t> cut) {
    const Bytes bytes(cut.begin(), cut.end());
    BundleStatus status = BundleStatus::kOk;
    const auto given = Unbundle(bytes, &status);
    EXPECT_EQ(given.size(), bytes.empty() ? 0u : 1u);
    if (bytes.size() >= kEnvelopeBytes) {
      EXPECT_NE(status, BundleStatus::kOk) << bytes.size();
    }
  });
}

TEST_F(Bundles, CorruptedBundleYieldsTheWholeDatagramOnly) {
  test::ForEveryCorruption(good_, [this](std::span<const std::uint8_t> spoilt) {
    BundleStatus status = BundleStatus::kOk;
    const auto given = Unbundle(Bytes(spoilt.begin(), spoilt.end()), &status);
    const auto add = [](std::size_t sum, const Bytes& each) { return sum + each.size(); };
    EXPECT_EQ(std::accumulate(given.begin(), given.end(), std::size_t{0}, add), good_.size());
    if (status != BundleStatus::kOk) {
      EXPECT_EQ(given.size(), 1u);
    }
  });
}

}  // namespace
}  // namespace furrow::protocol
