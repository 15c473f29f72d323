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

TEST(SenderGate, TheFirstSenderHoldsThePortUntilItIsSilent) {
  SenderGate gate({}, Policy::kOne);
  EXPECT_TRUE(gate.Admits(kBen, kStart)) << "no sender holds the port yet";
  EXPECT_TRUE(gate.Hold(kAnn, kStart));
  EXPECT_FALSE(gate.Hold(kAnn, kStart + FromSeconds(1)));
  const Time silent = kStart + FromSeconds(1) + SenderGate::kRelease;
  EXPECT_TRUE(gate.Admits(kAnn, silent));
  EXPECT_FALSE(gate.Admits(kBen, silent));
  EXPECT_TRUE(gate.Admits(kBen, silent + kMoment));
  EXPECT_TRUE(gate.Hold(kBen, silent + kMoment));
  EXPECT_FALSE(gate.Admits(kAnn, silent + kMoment));
}

TEST(SenderGate, InvalidDatagramsDoNotTakeThePort) {
  SenderGate gate({}, Policy::kOne);
  EXPECT_TRUE(gate.Admits(kAnn, kStart));  // without Hold(): the datagram was invalid
  EXPECT_TRUE(gate.Admits(kBen, kStart));
  EXPECT_FALSE(gate.IsSuccessor(kBen)) << "no sender held the port before";
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
  EXPECT_TRUE(open.Hold(kAnn, kStart)) << "without a list, one at a time";
  EXPECT_FALSE(open.Admits(kBen, kStart));
}

TEST(SenderGate, MappedIpv4AddressesMatch) {
  SenderGate gate(std::vector{make_address("::ffff:192.168.0.20")}, Policy::kOne);
  EXPECT_TRUE(gate.Admits(kAnn, kStart));
  gate.Hold(make_address("::ffff:192.168.0.20"), kStart);
  EXPECT_FALSE(gate.IsSuccessor(kAnn));
}

}  // namespace
}  // namespace furrow::server
