// SPDX-License-Identifier: Apache-2.0
#include "server/net/sender_gate.h"

#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using asio::ip::make_address;
using Policy = SenderGate::Policy;

const auto kAnn = make_address("192.168.0.20");
const auto kBen = make_address("192.168.0.21");
constexpr Time kStart = FromSeconds(1000);
constexpr Time kMoment{1};

// Sends valid datagrams until the sender holds the port. Returns how many were not admitted.
int SendSteadily(SenderGate& gate, const asio::ip::address& sender, Time now) {
  int rejected = 0;
  for (int i = 0; i < 2 * SenderGate::kSteady; ++i) {
    if (!gate.Admits(sender, now)) {
      ++rejected;
    } else if (gate.Hold(sender, now)) {
      return rejected;
    }
  }
  ADD_FAILURE() << sender << " does not hold the port";
  return rejected;
}

TEST(SenderGate, TheFirstSteadySenderHoldsThePortUntilItIsSilent) {
  SenderGate gate({}, Policy::kOne);
  EXPECT_EQ(SendSteadily(gate, kAnn, kStart), 0);
  EXPECT_TRUE(gate.Admits(kAnn, kStart + FromSeconds(1)));
  EXPECT_FALSE(gate.Hold(kAnn, kStart + FromSeconds(1))) << "it did before";
  const Time silent = kStart + FromSeconds(1) + SenderGate::kRelease;
  EXPECT_FALSE(gate.Admits(kBen, silent));
  EXPECT_EQ(SendSteadily(gate, kBen, silent + kMoment), 0);
  EXPECT_FALSE(gate.Admits(kAnn, silent + kMoment));
}

TEST(SenderGate, AFewForgedDatagramsLockNobodyOut) {
  SenderGate gate({}, Policy::kOne);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(gate.Admits(kBen, kStart));
    EXPECT_FALSE(gate.Hold(kBen, kStart));
  }
  EXPECT_EQ(SendSteadily(gate, kAnn, kStart), 3) << "until it has sent more";
  EXPECT_FALSE(gate.Admits(kBen, kStart));
}

// 100 forged addresses between two datagrams of the tracker: 6,000 per second at 60 Hz.
TEST(SenderGate, AFloodOfForgedAddressesLocksNobodyOut) {
  for (const bool flood_comes_first : {false, true}) {
    SenderGate gate({}, Policy::kOne);
    unsigned next = 0x0A000000;
    const auto flood = [&](int count) {
      for (int i = 0; i < count; ++i) {
        const asio::ip::address_v4 forged(next++);
        if (gate.Admits(forged, kStart)) gate.Hold(forged, kStart);
      }
    };
    if (flood_comes_first) flood(5000);
    int rejected = 0;
    bool holds = false;
    for (int sent = 0; !holds; ++sent) {
      ASSERT_LT(sent, 20);
      if (gate.Admits(kAnn, kStart)) {
        holds = gate.Hold(kAnn, kStart);
      } else {
        ++rejected;
      }
      flood(100);
    }
    EXPECT_LE(rejected, 2);
  }
}

TEST(SenderGate, InvalidDatagramsDoNotCount) {
  SenderGate gate({}, Policy::kOne);
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(gate.Admits(kBen, kStart));
    gate.Discard(kBen);
  }
  EXPECT_EQ(SendSteadily(gate, kAnn, kStart), 0);
}

TEST(SenderGate, TheStateOfTheSenderBeforeIsDiscarded) {
  SenderGate gate({}, Policy::kOne);
  EXPECT_FALSE(gate.IsSuccessor(kBen)) << "nobody sent before";
  ASSERT_TRUE(gate.Admits(kBen, kStart));
  gate.Hold(kBen, kStart);
  EXPECT_FALSE(gate.IsSuccessor(kBen));
  EXPECT_TRUE(gate.IsSuccessor(kAnn));
}

TEST(SenderGate, OnlyListedSendersAreAdmitted) {
  SenderGate gate(std::vector{kAnn}, Policy::kOne);
  EXPECT_TRUE(gate.Admits(kAnn, kStart));
  EXPECT_FALSE(gate.Admits(kBen, kStart));
}

TEST(SenderGate, AllAllowedSendersMaySendAtOnceIfListed) {
  SenderGate gate(std::vector{kAnn, kBen}, Policy::kAllAllowed);
  EXPECT_FALSE(gate.Hold(kAnn, kStart));
  EXPECT_TRUE(gate.Admits(kBen, kStart));
  EXPECT_FALSE(gate.IsSuccessor(kBen));
  EXPECT_FALSE(gate.Admits(make_address("192.168.0.22"), kStart));
  SenderGate open({}, Policy::kAllAllowed);
  EXPECT_EQ(SendSteadily(open, kAnn, kStart), 0) << "without a list, one at a time";
  EXPECT_FALSE(open.Admits(kBen, kStart));
}

TEST(SenderGate, MappedIpv4AddressesMatch) {
  SenderGate gate(std::vector{make_address("::ffff:192.168.0.20")}, Policy::kOne);
  EXPECT_EQ(SendSteadily(gate, make_address("::ffff:192.168.0.20"), kStart), 0);
  EXPECT_TRUE(gate.Admits(kAnn, kStart));
  EXPECT_FALSE(gate.IsSuccessor(kAnn));
}

TEST(SenderGate, AnOperatorGivesThePortToAnotherSender) {
  SenderGate gate({}, Policy::kOne);
  EXPECT_FALSE(gate.HolderAt(kStart));
  EXPECT_EQ(SendSteadily(gate, kAnn, kStart), 0);
  EXPECT_EQ(gate.HolderAt(kStart), kAnn);
  EXPECT_TRUE(gate.Give(kBen, kStart));
  EXPECT_EQ(gate.HolderAt(kStart), kBen);
  EXPECT_FALSE(gate.Admits(kAnn, kStart));
  EXPECT_TRUE(gate.Admits(kBen, kStart));
  EXPECT_TRUE(gate.IsSuccessor(kBen)) << "half a frame of the former sender must go";
  EXPECT_FALSE(gate.Hold(kBen, kStart)) << "it did before";
  // It does not send, so the port is free again.
  const Time silent = kStart + SenderGate::kRelease + kMoment;
  EXPECT_FALSE(gate.HolderAt(silent));
  EXPECT_EQ(SendSteadily(gate, kAnn, silent), 0);
}

TEST(SenderGate, NobodyGivesThePortToASenderThatIsNotAllowed) {
  SenderGate gate(std::vector{kAnn}, Policy::kOne);
  EXPECT_FALSE(gate.Give(kBen, kStart));
  EXPECT_FALSE(gate.Admits(kBen, kStart));
  EXPECT_TRUE(gate.Give(kAnn, kStart));
  // Where all that are allowed send at once, there is nothing to give.
  SenderGate all(std::vector{kAnn, kBen}, Policy::kAllAllowed);
  EXPECT_TRUE(all.Give(kBen, kStart));
  EXPECT_FALSE(all.HolderAt(kStart));
  EXPECT_TRUE(all.Admits(kAnn, kStart));
}

}  // namespace
}  // namespace furrow::server
