// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::chaos {
namespace {

using testing::HasSubstr;

Outcome Falsifying(std::uint64_t falsified) {
  return {.options = {.falsify = 0.1},
          .counts = {.packets = 50, .falsified = falsified},
          .stream_counts = {}};
}

TEST(ChaosReport, RequestedFaultsAreListedEvenWithACountOfZero) {
  EXPECT_EQ(ToText("up", Falsifying(0)), "up: 50 datagrams, falsified 0");
  EXPECT_EQ(ToText("down", {.options = {}, .counts = {.packets = 7}, .stream_counts = {}}),
            "down: 7 datagrams");
}

TEST(ChaosReport, LostPosesAndWeightsAreCountedApart) {
  const Outcome outcome{.options = {.loss = 0.1},
                        .counts = {.packets = 50, .lost = 3, .lost_data = 2},
                        .stream_counts = {}};
  EXPECT_EQ(ToText("up", outcome), "up: 50 datagrams, lost 3 (2 with readable poses or weights)");
  EXPECT_EQ(ToJson(outcome)["lost_data"], 2);
}

TEST(ChaosReport, TcpHasItsOwnLine) {
  Outcome outcome = Falsifying(3);
  outcome.stream_counts = {.connections = 2, .bytes = 10, .held = 4, .still_us = 5000};
  EXPECT_THAT(ToText("up", outcome), HasSubstr("\nup over TCP: 2 connections, 10 bytes, held back "
                                               "4 times, stalled for 5 ms"));
}

TEST(ChaosReport, NothingInjectedLooksAtBothDirectionsTogether) {
  EXPECT_EQ(NothingInjected(Falsifying(0), Falsifying(2)), "");
  EXPECT_EQ(NothingInjected({}, {}), "");
  Outcome up = Falsifying(0);
  up.options.loss = 0.5;
  EXPECT_THAT(NothingInjected(up, Falsifying(0)),
              HasSubstr("No fault was injected for --loss, --falsify,"));
}

TEST(ChaosReport, ABlackHoleThatStartedTooLateIsReported) {
  Outcome up{.options = {.black_holes = {{.start = 9.0, .length = 1.0}}},
             .counts = {},
             .stream_counts = {}};
  EXPECT_THAT(NothingInjected(up, {}), HasSubstr("--black-hole"));
  up.stream_counts.still_us = 1;
  EXPECT_EQ(NothingInjected(up, {}), "");
}

TEST(ChaosReport, DatagramFaultsExcludeThoseThatApplyToTcp) {
  EXPECT_EQ(DatagramFaults({.jitter_ms = 3.0, .black_holes = {{.start = 1.0, .length = 1.0}}}), "");
  EXPECT_EQ(DatagramFaults({.loss = 0.1, .delay = 0.2, .jitter_ms = 3.0}), "--loss, --delay");
}

TEST(ChaosReport, JsonHoldsCountsAndOptions) {
  const nlohmann::json counts = ToJson(Falsifying(3));
  EXPECT_EQ(counts["datagrams"], 50);
  EXPECT_EQ(counts["falsified"], 3);
  EXPECT_EQ(counts["lost"], 0);
  EXPECT_EQ(counts["tcp"]["connections"], 0);
  const nlohmann::json options =
      ToJson(Faults{.seed = 7, .loss = 0.25, .black_holes = {{.start = 1.5, .length = 2.0}}});
  EXPECT_EQ(options["seed"], 7);
  EXPECT_EQ(options["loss"], 0.25);
  EXPECT_EQ(options["black_holes"][0]["start"], 1.5);
}

}  // namespace
}  // namespace furrow::chaos
