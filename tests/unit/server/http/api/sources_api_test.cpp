// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/sources_api.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::server {
namespace {

constexpr Time kNow = std::chrono::seconds(100);

TEST(SourcesApi, SaysWhereToSendAndWhatHasArrived) {
  const MocapReport report{
      .port = 11111,
      .packets = 130,
      .malformed = 3,
      .rejected = 7,
      .rate_hz = 60,
      .last = MocapReport::Arrival{"192.0.2.20", kNow - std::chrono::milliseconds(250)},
      .last_rejected = MocapReport::Arrival{"192.0.2.66", kNow - std::chrono::seconds(2)}};
  const SourcesApi api({.bind = "192.0.2.7",
                        .allow = [] { return std::vector<std::string>{"192.0.2.20"}; },
                        .livelink_face = [&report](Time) { return std::optional(report); },
                        .vmc = {}});
  const auto body = nlohmann::json::parse(api.Show(kNow).body);
  EXPECT_EQ(body["bind"], "192.0.2.7");
  EXPECT_EQ(body["loopback"], false);
  EXPECT_EQ(body["addresses"], nlohmann::json::array({"192.0.2.7"}));
  EXPECT_EQ(body["allow"], nlohmann::json::array({"192.0.2.20"}));
  const auto& phone = body["inputs"][0];
  EXPECT_EQ(phone["name"], "livelink_face");
  EXPECT_EQ(phone["port"], 11111);
  EXPECT_EQ(phone["packets"], 130);
  EXPECT_EQ(phone["malformed"], 3);
  EXPECT_EQ(phone["rejected"], 7);
  EXPECT_EQ(phone["sender"], "192.0.2.20");
  EXPECT_EQ(phone["age_ms"], 250.0);
  EXPECT_TRUE(phone["malformed_age_ms"].is_null());
  EXPECT_EQ(phone["rejected_sender"], "192.0.2.66");
  EXPECT_EQ(phone["rejected_age_ms"], 2000.0);
  const auto& vmc = body["inputs"][1];
  EXPECT_EQ(vmc["name"], "vmc");
  EXPECT_TRUE(vmc["port"].is_null()) << "it is off";
  EXPECT_EQ(vmc["usual_port"], 39539);
}

TEST(SourcesApi, LoopbackReachesNobodyElse) {
  const SourcesApi api({.bind = "127.0.0.1",
                        .allow = [] { return std::vector<std::string>(); },
                        .livelink_face = {},
                        .vmc = {}});
  const auto body = nlohmann::json::parse(api.Show(kNow).body);
  EXPECT_EQ(body["loopback"], true);
  EXPECT_TRUE(body["addresses"].empty());
}

}  // namespace
}  // namespace furrow::server
