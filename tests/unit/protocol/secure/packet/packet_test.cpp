// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/packet/packet.h"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

#include "protocol/secure/noise/cipher_state.h"
#include "protocol/secure/packet/packet_opener.h"
#include "protocol/secure/packet/packet_sealer.h"
#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;

constexpr std::uint32_t kIndex = 0xCAFE;
constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

// A direction of a session: seals on one side, opens on the other.
class Packets : public ::testing::Test {
 protected:
  [[nodiscard]] Bytes Sealed(PacketSealer& sealer, const Bytes& inner, std::int64_t now_us = 0,
                             PacketKind kind = PacketKind::kData) {
    Bytes packet(kPacketHeaderBytes + inner.size() + kTagBytes);
    std::copy(inner.begin(), inner.end(), packet.begin() + kPacketHeaderBytes);
    EXPECT_EQ(sealer.Seal(kind, packet, now_us), SealStatus::kOk);
    return packet;
  }
  // Opens a copy, so that `packet` can be used again.
  OpenStatus Open(PacketOpener& opener, Bytes packet, std::int64_t now_us = 0,
                  Bytes* inner = nullptr) {
    OpenedPacket opened;
    const OpenStatus status = opener.Open(packet, now_us, opened);
    if (status == OpenStatus::kOk && inner != nullptr) {
      inner->assign(opened.inner.begin(), opened.inner.end());
    }
    return status;
  }

  test::RepeatableRandom random_;
  Key key_ = random_.MakeKey();
};

TEST_F(Packets, RoundTripAllSizes) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_);
  for (std::size_t size = 0; size <= kMaxDatagramBytes; ++size) {
    Bytes inner(size);
    random_.Fill(inner);
    const PacketKind kind = size % 2 == 0 ? PacketKind::kData : PacketKind::kControl;
    Bytes packet = Sealed(sealer, inner, 0, kind);
    ASSERT_EQ(packet.size(), size + 32);
    ASSERT_TRUE(IsSecure(packet));
    OpenedPacket opened;
    ASSERT_EQ(opener.Open(packet, 0, opened), OpenStatus::kOk);
    ASSERT_EQ(opened.kind, kind);
    ASSERT_EQ(opened.counter, size);
    ASSERT_TRUE(std::equal(inner.begin(), inner.end(), opened.inner.begin(), opened.inner.end()));
  }
}

TEST_F(Packets, HaveTheLayoutOfTheDocument) {
  PacketSealer sealer(key_, kIndex, 0, {}, 0x0102030405060708);
  const Bytes packet = Sealed(sealer, {9, 9});
  EXPECT_EQ(test::ToHex(std::span(packet).first(16)), "05000000feca00000807060504030201");
}

TEST_F(Packets, PlainMessagesAreNotSecure) {
  EXPECT_FALSE(IsSecure({}));
  for (int first = 0; first < 256; ++first) {
    const int kind = first & 0x7F;
    EXPECT_EQ(IsSecure(Bytes{static_cast<std::uint8_t>(first)}), kind >= 1 && kind <= 6) << first;
  }
}

TEST_F(Packets, RefuseEveryFlippedBit) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_);
  const Bytes inner = {1, 2, 3, 4, 5};
  const Bytes packet = Sealed(sealer, inner);
  for (std::size_t bit = 0; bit < packet.size() * 8; ++bit) {
    Bytes changed = packet;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    OpenedPacket opened;
    ASSERT_NE(opener.Open(changed, 0, opened), OpenStatus::kOk) << bit;
    // Nothing of the text leaks.
    const auto found = std::search(changed.begin(), changed.end(), inner.begin(), inner.end());
    ASSERT_EQ(found, changed.end());
  }
  // No forgery moved the window or the key.
  EXPECT_EQ(Open(opener, packet), OpenStatus::kOk);
  EXPECT_EQ(Open(opener, packet), OpenStatus::kDuplicate);
}

TEST_F(Packets, RefuseEveryTruncationAndOtherSizes) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_);
  const Bytes packet = Sealed(sealer, Bytes(40, 7));
  protocol::test::ForEveryTruncation(packet, [&](std::span<const std::uint8_t> cut) {
    EXPECT_NE(Open(opener, {cut.begin(), cut.end()}), OpenStatus::kOk);
  });
  Bytes longer = packet;
  longer.push_back(0);
  EXPECT_EQ(Open(opener, longer), OpenStatus::kNotAuthentic);
  EXPECT_EQ(Open(opener, Bytes(kMaxPacketBytes + 1)), OpenStatus::kBadHeader);
  Bytes small(kPacketOverheadBytes - 1);
  EXPECT_EQ(sealer.Seal(PacketKind::kData, small, 0), SealStatus::kBadSize);
  Bytes large(kMaxPacketBytes + 1);
  EXPECT_EQ(sealer.Seal(PacketKind::kData, large, 0), SealStatus::kBadSize);
}

TEST_F(Packets, EachIsAcceptedOnceInAnyOrder) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_);
  std::vector<Bytes> packets;
  for (std::uint8_t i = 0; i < 200; ++i) packets.push_back(Sealed(sealer, {i}));
  for (std::size_t i = packets.size(); i > 1; --i)
    std::swap(packets[i - 1], packets[random_.Below(i)]);
  for (const Bytes& packet : packets) EXPECT_EQ(Open(opener, packet), OpenStatus::kOk);
  for (const Bytes& packet : packets) EXPECT_EQ(Open(opener, packet), OpenStatus::kDuplicate);
}

TEST_F(Packets, OldOnesAreRefusedBeforeTheyAreDecrypted) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_);
  const Bytes first = Sealed(sealer, {1});
  for (int i = 0; i < 1'024; ++i) ASSERT_EQ(Open(opener, Sealed(sealer, {2})), OpenStatus::kOk);
  EXPECT_EQ(Open(opener, first), OpenStatus::kTooOld);
  EXPECT_EQ(opener.num_failures(), 0u);
}

TEST_F(Packets, CountersEndBeforeTheReservedNonce) {
  PacketSealer sealer(key_, kIndex, 0, {}, kMaxCounter - 1);
  PacketOpener opener(key_);
  EXPECT_EQ(Open(opener, Sealed(sealer, {1})), OpenStatus::kOk);
  EXPECT_EQ(Open(opener, Sealed(sealer, {2})), OpenStatus::kOk);
  Bytes packet(40);
  EXPECT_EQ(sealer.Seal(PacketKind::kData, packet, 0), SealStatus::kExhausted);
  EXPECT_EQ(sealer.Seal(PacketKind::kData, packet, 0), SealStatus::kExhausted);
  // A peer that uses the reserved nonce nevertheless is refused, even with the right key.
  WritePacketHeader({PacketKind::kData, false, kIndex, kNoLimit}, packet);
  Seal(key_, kNoLimit, ByteView(packet).first(16), ByteSpan(packet).subspan(16, 8),
       ByteSpan(packet).last<kTagBytes>());
  EXPECT_EQ(Open(opener, packet), OpenStatus::kBadHeader);
}

TEST_F(Packets, TheKeyChangesByNumberAndByTime) {
  PacketSealer by_number(key_, kIndex, 0, {3, 1'000'000'000});
  std::string phases;
  for (int i = 0; i < 10; ++i) phases += Sealed(by_number, {1})[0] & kPhaseBit ? '1' : '0';
  EXPECT_EQ(phases, "0001110001");
  PacketSealer by_time(key_, kIndex, 100, {1'000, 50});
  phases.clear();
  for (const int now : {100, 149, 150, 199, 200, 1'000, 1'001}) {
    phases += Sealed(by_time, {1}, now)[0] & kPhaseBit ? '1' : '0';
  }
  EXPECT_EQ(phases, "0011011");
}

TEST_F(Packets, BothSidesChangeTheKeyTogether) {
  PacketSealer sealer(key_, kIndex, 0, {5, 1'000'000'000});
  PacketOpener opener(key_);
  for (std::uint8_t i = 0; i < 100; ++i) {
    Bytes inner;
    ASSERT_EQ(Open(opener, Sealed(sealer, {i}), 0, &inner), OpenStatus::kOk) << int{i};
    ASSERT_EQ(inner, Bytes{i});
  }
}

TEST_F(Packets, TheFormerKeyIsKeptForTwoSeconds) {
  PacketSealer sealer(key_, kIndex, 0, {4, 1'000'000'000});
  PacketOpener opener(key_);
  std::vector<Bytes> packets;
  for (std::uint8_t i = 0; i < 8; ++i) packets.push_back(Sealed(sealer, {i}));
  EXPECT_EQ(Open(opener, packets[0], 0), OpenStatus::kOk);
  EXPECT_EQ(Open(opener, packets[5], 1'000), OpenStatus::kOk);  // turns
  EXPECT_EQ(Open(opener, packets[1], 1'000), OpenStatus::kOk);  // late
  EXPECT_EQ(Open(opener, packets[4], 1'000), OpenStatus::kOk);  // late, of the new key
  EXPECT_EQ(Open(opener, packets[2], 2'000'999), OpenStatus::kOk);
  EXPECT_EQ(Open(opener, packets[3], 2'001'000), OpenStatus::kOldKey);
  EXPECT_EQ(Open(opener, packets[6], 9'000'000), OpenStatus::kOk);
}

TEST_F(Packets, AForgedPhaseDoesNotTurnTheKey) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_);
  for (int i = 0; i < 10; ++i) {
    Bytes forged = Sealed(sealer, {1});
    forged[0] ^= kPhaseBit;
    EXPECT_EQ(Open(opener, forged), OpenStatus::kNotAuthentic);
    EXPECT_EQ(Open(opener, Sealed(sealer, {2})), OpenStatus::kOk);
  }
}

TEST_F(Packets, SurviveLossReorderAndChangesOfTheKey) {
  PacketSealer sealer(key_, kIndex, 0, {1'000, 1'000'000'000});
  PacketOpener opener(key_);
  std::deque<Bytes> network;
  int sent = 0;
  int dropped = 0;
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t now_us = i * 1'000;
    if (random_.Below(10) == 0) {
      ++dropped;
      (void)Sealed(sealer, {1}, now_us);
    } else {
      network.push_back(Sealed(sealer, {1}, now_us));
      if (random_.Below(20) == 0) network.push_back(network.back());  // a duplicate
    }
    ++sent;
    if (network.size() > 30) {
      const std::size_t at = random_.Below(20);
      accepted += Open(opener, network[at], now_us) == OpenStatus::kOk;
      network.erase(network.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
  for (const Bytes& packet : network)
    accepted += Open(opener, packet, 20'000'000) == OpenStatus::kOk;
  EXPECT_EQ(accepted, sent - dropped);
}

TEST_F(Packets, EndAtTheLimitOfFailures) {
  PacketSealer sealer(key_, kIndex, 0);
  PacketOpener opener(key_, 3);
  Bytes forged = Sealed(sealer, {1});
  forged.back() ^= 1;
  EXPECT_EQ(Open(opener, forged), OpenStatus::kNotAuthentic);
  EXPECT_EQ(Open(opener, forged), OpenStatus::kNotAuthentic);
  EXPECT_EQ(Open(opener, Sealed(sealer, {1})), OpenStatus::kOk);
  EXPECT_EQ(Open(opener, forged), OpenStatus::kNotAuthentic);
  EXPECT_EQ(Open(opener, Sealed(sealer, {1})), OpenStatus::kExhausted);
  EXPECT_EQ(kMaxFailedOpens, 68'719'476'736u);
}

TEST_F(Packets, AllocateNothing) {
  PacketSealer sealer(key_, kIndex, 0, {5, 1'000'000'000});
  PacketOpener opener(key_);
  Bytes packet(kMaxPacketBytes);
  OpenedPacket opened;
  const std::uint64_t before = furrow::test::NumAllocations();
  bool ok = true;
  for (int i = 0; i < 50; ++i) {
    ok = ok && sealer.Seal(PacketKind::kData, packet, 0) == SealStatus::kOk;
    packet.back() ^= 1;
    ok = ok && opener.Open(packet, 0, opened) == OpenStatus::kNotAuthentic;
    ok = ok && sealer.Seal(PacketKind::kData, packet, 0) == SealStatus::kOk;
    ok = ok && opener.Open(packet, 0, opened) == OpenStatus::kOk;
  }
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_TRUE(ok);
}

}  // namespace
}  // namespace furrow::protocol::secure
