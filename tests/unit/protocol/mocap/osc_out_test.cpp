// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/osc_out.h"

#include <map>

#include <gtest/gtest.h>

#include "protocol/mocap/osc.h"
#include "protocol/mocap/vmc.h"
#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/drill.h"

namespace furrow::protocol::mocap {
namespace {

std::vector<std::string> Names(int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back("region_" + std::to_string(i) + ".squash");
  return names;
}

std::vector<float> Values(int count) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.push_back(static_cast<float>(i) / 512.0f);
  return values;
}

// The shipped profiles, written by hand.
const OscProfile kFurrow{
    .name = "furrow",
    .value = {"/{prefix}/{subject}/{name}", {OscField::kValue}},
    .timecode = OscTemplate{"/{prefix}/{subject}/timecode", {OscField::kTimecode}},
    .end = OscTemplate{"/{prefix}/{subject}/frame", {OscField::kSequence, OscField::kCaptureTime}},
    .names = {},
    .only_renamed = false};
const OscProfile kVmc{.name = "vmc",
                      .value = {"/VMC/Ext/Blend/Val", {OscField::kName, OscField::kValue}},
                      .timecode = std::nullopt,
                      .end = OscTemplate{"/VMC/Ext/Blend/Apply", {}},
                      .names = {},
                      .only_renamed = false};

// The timecode with the longest text: 23:59:59:239.
constexpr Timecode kLongest{.frame = 24u * 3600 * 240 - 1, .rate_numerator = 240};

// The addresses of the messages that a writer sends.
std::vector<std::string> Addresses(OscWeightWriter& writer, const std::vector<float>& values) {
  std::vector<std::string> addresses;
  writer.Write({}, values, [&](std::span<const std::uint8_t> datagram) {
    EXPECT_LE(datagram.size(), 1200u);
    EXPECT_EQ(VisitOsc(datagram, [&](const OscMessage& m) { addresses.emplace_back(m.address); }),
              OscStatus::kOk);
  });
  return addresses;
}

TEST(OscWeightWriter, WritesEveryWeightInBoundedBundlesAndTheMarkLast) {
  OscWeightWriter writer(&kFurrow);
  writer.SetNames("anna b", Names(100));
  std::vector<test::Bytes> datagrams;
  writer.Write({41, 1'234'567'890'123, {}}, Values(100),
               [&](std::span<const std::uint8_t> datagram) {
                 datagrams.emplace_back(datagram.begin(), datagram.end());
               });
  EXPECT_GT(datagrams.size(), 2u);
  std::map<std::string, float> heard;
  std::string last;
  for (const test::Bytes& datagram : datagrams) {
    EXPECT_LE(datagram.size(), 1200u);
    ASSERT_EQ(VisitOsc(datagram,
                       [&](const OscMessage& message) {
                         last = message.address;
                         OscArguments arguments(message);
                         float value = -1;
                         if (arguments.Float(value)) heard[last] = value;
                         std::int32_t sequence = 0;
                         if (arguments.Int(sequence)) {
                           EXPECT_EQ(sequence, 41);
                           EXPECT_EQ(message.tags, "ih");
                         }
                       }),
              OscStatus::kOk);
  }
  EXPECT_EQ(last, "/furrow/anna_b/frame");
  ASSERT_EQ(heard.size(), 100u);
  EXPECT_EQ(heard["/furrow/anna_b/region_64.squash"], 0.125f);
}

TEST(OscWeightWriter, VmcProfileSuitsVmcReceivers) {
  OscWeightWriter writer(&kVmc);
  writer.SetNames("anna", Names(60));
  const auto receiver = MakeVmcAdapter();
  std::vector<NeutralFrame> frames;
  writer.Write({}, Values(60), [&](std::span<const std::uint8_t> datagram) {
    EXPECT_LE(datagram.size(), 1200u);
    receiver->Push(datagram, 0, [&](const NeutralFrame& frame) { frames.push_back(frame); });
  });
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_EQ(frames[0].blend_shapes.size(), 60u);
  EXPECT_EQ(frames[0].blend_shapes[32].name, "region_32.squash");
  EXPECT_EQ(frames[0].blend_shapes[32].value, 0.0625f);
  EXPECT_EQ(receiver->counters().malformed, 0u);
}

TEST(OscWeightWriter, SendsTheTimecodeOfASourceThatHasOne) {
  OscWeightWriter writer(&kFurrow);
  // Bundles of all fills, so that the timecode is also the message that does not fit any more.
  for (int count = 0; count < 60; ++count) {
    writer.SetNames("ada", Names(count));
    std::vector<std::string> texts;
    std::vector<std::string> addresses;
    writer.Write({0, 0, kLongest}, Values(count), [&](std::span<const std::uint8_t> datagram) {
      EXPECT_LE(datagram.size(), 1200u);
      const OscStatus status = VisitOsc(datagram, [&](const OscMessage& message) {
        addresses.emplace_back(message.address);
        OscArguments arguments(message);
        std::string_view text;
        if (message.tags == "s" && arguments.String(text)) texts.emplace_back(text);
      });
      EXPECT_EQ(status, OscStatus::kOk);
    });
    EXPECT_EQ(texts, std::vector<std::string>{"23:59:59:239"});
    ASSERT_EQ(addresses.size(), static_cast<std::size_t>(count) + 2);
    EXPECT_EQ(addresses[addresses.size() - 2], "/furrow/ada/timecode");
    EXPECT_EQ(addresses.back(), "/furrow/ada/frame");
  }
}

TEST(OscWeightWriter, ReplacesForbiddenCharacters) {
  OscWeightWriter writer(&kFurrow, "w");
  writer.SetNames("a/b#*", std::vector<std::string>{"x,y?[z]{q}"});
  EXPECT_EQ(Addresses(writer, Values(1)),
            (std::vector<std::string>{"/w/a_b__/x_y__z__q_", "/w/a_b__/frame"}));
}

TEST(OscWeightWriter, NamesThatLookLikePlaceholdersAreNotExpanded) {
  OscWeightWriter writer(&kFurrow, "{name}");
  writer.SetNames("{prefix}", std::vector<std::string>{"a"});
  EXPECT_EQ(Addresses(writer, Values(1))[0], "/{name}/_prefix_/a");
}

TEST(OscWeightWriter, SendsIdentifiersRenamedWeightsAndPatterns) {
  OscProfile profile{.name = "vrchat",
                     .value = {"/avatar/parameters/{prefix}_{identifier}", {OscField::kValue}},
                     .timecode = std::nullopt,
                     .end = std::nullopt,
                     .names = {{"brow_l.squash", "BrowDownLeft"}},
                     .only_renamed = false};
  const std::vector<std::string> names = {"brow_l.squash", "brow_\u00e9.squash", "nose.squash"};
  OscWeightWriter writer(&profile);
  EXPECT_EQ(writer.SetNames("ann", names, "brow_*"), 2u);
  EXPECT_EQ(Addresses(writer, Values(3)),
            (std::vector<std::string>{"/avatar/parameters/furrow_BrowDownLeft",
                                      "/avatar/parameters/furrow_brow____squash"}));
  profile.only_renamed = true;
  EXPECT_EQ(writer.SetNames("ann", names), 1u);
  // Fewer values than names, for example while a rig changes.
  EXPECT_EQ(Addresses(writer, {}), std::vector<std::string>());
}

TEST(OscWeightWriter, LeavesOutWhatExceedsADatagram) {
  OscWeightWriter writer(&kVmc);
  EXPECT_EQ(writer.SetNames("ann", std::vector<std::string>{std::string(1300, 'x'), "a"}), 1u);
  EXPECT_EQ(Addresses(writer, Values(2)),
            (std::vector<std::string>{"/VMC/Ext/Blend/Val", "/VMC/Ext/Blend/Apply"}));
}

TEST(OscWeightWriter, DoesNotAllocateAfterWarmUp) {
  OscWeightWriter writer(&kFurrow);
  writer.SetNames("anna", Names(100));
  const std::vector<float> values = Values(100);
  const OscWeightWriter::Emit emit = [](std::span<const std::uint8_t>) {};
  writer.Write({0, 0, kLongest}, values, emit);
  const std::uint64_t before = furrow::test::NumAllocations();
  for (std::uint32_t i = 1; i < 10; ++i) writer.Write({i, i, kLongest}, values, emit);
  EXPECT_EQ(furrow::test::NumAllocations(), before);
}

}  // namespace
}  // namespace furrow::protocol::mocap
