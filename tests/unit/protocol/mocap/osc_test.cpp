// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/osc.h"

#include <gtest/gtest.h>

#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/mocap/hex.h"

namespace furrow::protocol::mocap {
namespace {

using test::Bytes;
using test::FromHex;

struct Heard {
  std::vector<std::string> addresses;
  OscStatus status = OscStatus::kOk;
};

Heard Visit(std::span<const std::uint8_t> packet) {
  Heard heard;
  heard.status =
      VisitOsc(packet, [&heard](const OscMessage& m) { heard.addresses.emplace_back(m.address); });
  return heard;
}

Bytes Bundle(const std::vector<Bytes>& elements) {
  Bytes bytes = FromHex("2362756E 646C6500 00000000 00000001");
  for (const Bytes& element : elements) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<std::uint8_t>(element.size() >> shift));
    }
    bytes.insert(bytes.end(), element.begin(), element.end());
  }
  return bytes;
}

// Byte vectors from Debian's oscsend, verified with oscdump.
const char* const kBlendValue =
    "2F564D43 2F457874 2F426C65 6E642F56 616C0000 2C736600 41000000 3F000000";
const char* const kBlendApply = "2F564D43 2F457874 2F426C65 6E642F41 70706C79 00000000 2C000000";

TEST(Osc, ReadsKnownVectors) {
  const Bytes packet = FromHex(kBlendValue);
  int visited = 0;
  ASSERT_EQ(VisitOsc(packet,
                     [&visited](const OscMessage& message) {
                       ++visited;
                       EXPECT_EQ(message.address, "/VMC/Ext/Blend/Val");
                       OscArguments arguments(message);
                       std::string_view name;
                       float value = 0;
                       std::int32_t none = 0;
                       EXPECT_FALSE(arguments.Float(value)) << "the next is a string";
                       ASSERT_TRUE(arguments.String(name));
                       ASSERT_TRUE(arguments.Float(value));
                       EXPECT_EQ(name, "A");
                       EXPECT_EQ(value, 0.5f);
                       EXPECT_FALSE(arguments.Int(none));
                       EXPECT_EQ(arguments.next_tag(), '\0');
                     }),
            OscStatus::kOk);
  EXPECT_EQ(visited, 1);
}

TEST(Osc, WritesKnownVectors) {
  Bytes bytes;
  OscWriter writer(bytes);
  writer.BeginMessage("/VMC/Ext/Blend/Val", "sf");
  writer.String("A");
  writer.Float(0.5f);
  writer.EndMessage();
  EXPECT_EQ(bytes, FromHex(kBlendValue));
  OscWriter apply(bytes);
  apply.BeginMessage("/VMC/Ext/Blend/Apply", "");
  apply.EndMessage();
  EXPECT_EQ(bytes, FromHex(kBlendApply));
  OscWriter bundle(bytes);
  bundle.BeginBundle();
  for (int i = 0; i < 2; ++i) {
    bundle.BeginMessage("/VMC/Ext/Blend/Apply", "");
    bundle.EndMessage();
  }
  EXPECT_EQ(bytes, Bundle({FromHex(kBlendApply), FromHex(kBlendApply)}));
}

TEST(Osc, LimitsBundleDepth) {
  Bytes packet = FromHex(kBlendApply);
  for (int depth = 1; depth <= kMaxOscDepth; ++depth) {
    packet = Bundle({packet, FromHex(kBlendValue)});
    EXPECT_EQ(Visit(packet).addresses.size(), static_cast<std::size_t>(depth) + 1);
  }
  EXPECT_EQ(Visit(Bundle({packet})).status, OscStatus::kTooDeep);
}

TEST(Osc, VisitsNothingOfADamagedPacket) {
  Bytes packet = Bundle({FromHex(kBlendApply), FromHex(kBlendValue)});
  packet[packet.size() - 11] = 'x';  // a type tag
  const Heard heard = Visit(packet);
  EXPECT_EQ(heard.status, OscStatus::kMalformed);
  EXPECT_TRUE(heard.addresses.empty());
}

TEST(Osc, RejectsHostilePackets) {
  EXPECT_EQ(Visit({}).status, OscStatus::kMalformed);
  EXPECT_EQ(Visit(FromHex("61626300")).status, OscStatus::kMalformed) << "no slash";
  EXPECT_EQ(Visit(FromHex("2F616263")).status, OscStatus::kMalformed) << "no end";
  EXPECT_EQ(Visit(FromHex("2F610000 2C620000 FFFFFFFC")).status, OscStatus::kMalformed);
  EXPECT_EQ(Visit(FromHex("2F610000 2C620000 00000005 00000000")).status, OscStatus::kMalformed);
  EXPECT_EQ(Visit(FromHex("2F610000 2C620000 00000005 01020304 05000000")).status, OscStatus::kOk);
  EXPECT_EQ(Visit(FromHex("2F610000 2C660000 00000000 00000000")).status, OscStatus::kMalformed);
  EXPECT_EQ(Visit(FromHex("2F610000 2C544600")).status, OscStatus::kOk) << "T F take no bytes";
  EXPECT_EQ(Visit(FromHex("2F610000")).status, OscStatus::kOk) << "older than type tags";
  EXPECT_EQ(Visit(FromHex("2362756E 646C6500 00000000 00000001 FFFFFFFF")).status,
            OscStatus::kMalformed);
  EXPECT_EQ(Visit(FromHex("2362756E 646C6500 00000000 00000001 00000008")).status,
            OscStatus::kMalformed);
  const Bytes good = Bundle({FromHex(kBlendValue), Bundle({FromHex(kBlendApply)})});
  test::ForEveryTruncation(good, [](std::span<const std::uint8_t> cut) {
    // A bundle is still valid after any complete element.
    const Heard heard = Visit(cut);
    EXPECT_TRUE(heard.status != OscStatus::kOk || heard.addresses.size() < 2);
  });
  test::ForEveryCorruption(good, [](std::span<const std::uint8_t> bad) { (void)Visit(bad); });
  const std::vector<Bytes> many(kMaxOscMessages + 1, FromHex("2F610000 2C000000"));
  EXPECT_EQ(Visit(Bundle(many)).status, OscStatus::kTooMany);
}

}  // namespace
}  // namespace furrow::protocol::mocap
