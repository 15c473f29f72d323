// SPDX-License-Identifier: Apache-2.0
#include "server/config/settings.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::HasSubstr;

std::vector<Setting> AllSettings() {
  std::vector<Setting> settings;
  const Config config;
  VisitSettings([&](const Setting& setting, const auto&) { settings.push_back(setting); }, config);
  return settings;
}

TEST(Settings, EachKeyHasOneRow) {
  std::set<std::string_view> keys;
  for (const Setting& setting : AllSettings()) {
    EXPECT_TRUE(keys.insert(setting.key).second) << setting.key;
  }
  EXPECT_GT(keys.size(), 60u);
}

// The reader of the file begins a table where the name changes.
TEST(Settings, TheRowsOfATableAreNeighbours) {
  std::set<std::string_view> tables;
  std::string_view last;
  for (const Setting& setting : AllSettings()) {
    const std::size_t dot = setting.key.find('.');
    const std::string_view table = dot == std::string_view::npos ? "" : setting.key.substr(0, dot);
    if (table != last) {
      EXPECT_TRUE(tables.insert(table).second) << setting.key;
    }
    last = table;
  }
}

TEST(Settings, TheDefaultsAreInTheirRanges) {
  const Config config;
  VisitSettings(
      [](const Setting& setting, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
          EXPECT_TRUE(Contains(setting.range, static_cast<double>(value))) << setting.key;
        }
      },
      config);
}

// Messages state both ends of the range. Without one, an integer is never out of it, but NaN is.
TEST(Settings, RangesHaveBothEnds) {
  const Config config;
  int numbers = 0;
  VisitSettings(
      [&](const Setting& setting, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, double>) {
          const Range& range = setting.range;
          const bool has_none = std::isinf(range.least) && std::isinf(range.most);
          if (std::is_same_v<Value, int> && has_none) return;  // such as rest_frame
          ++numbers;
          EXPECT_TRUE(std::isfinite(range.least)) << setting.key;
          EXPECT_TRUE(std::isfinite(range.most)) << setting.key;
        }
      },
      config);
  EXPECT_GT(numbers, 10);
}

TEST(Settings, RangesHaveTheirEndsUnlessTheyExcludeThem) {
  EXPECT_TRUE(Contains(kPortNumber, 0));
  EXPECT_TRUE(Contains(kPortNumber, 65'535));
  EXPECT_FALSE(Contains(kPortNumber, 65'536));
  EXPECT_FALSE(Contains(kShare, 0));
  EXPECT_TRUE(Contains(kShare, 1));
  for (const Range& range : {kPortNumber, kShare, Range{}}) EXPECT_FALSE(Contains(range, NAN));
}

TEST(Settings, WordsNameTheEndsOfTheRange) {
  EXPECT_THAT(std::string(kBusyPollTime.words), HasSubstr(std::to_string(kMaxBusyPollUs)));
  EXPECT_THAT(std::string(kPixelBudget.words),
              HasSubstr(std::to_string(static_cast<int>(kMaxMegapixelsPerSecond))));
}

TEST(FindFault, NamesTheKeyThatOnlyTheFileSets) {
  const auto key = [](const auto& change) {
    Config config;
    change(&config);
    const auto fault = FindFault(config);
    return fault ? std::string(fault->key) : "no fault";
  };
  EXPECT_EQ(key([](Config*) {}), "no fault");
  EXPECT_EQ(key([](Config* c) { c->threads = 0; }), "listen.threads");
  EXPECT_EQ(key([](Config* c) { c->busy_poll_us = -1; }), "listen.busy_poll_us");
  EXPECT_EQ(key([](Config* c) { c->rest_frame = -2; }), "rest_frame");
  EXPECT_EQ(key([](Config* c) { c->record.rotate_seconds = NAN; }), "record.rotate_seconds");
  EXPECT_EQ(key([](Config* c) { c->osc.allow = {"stage"}; }), "osc.allow");
  EXPECT_EQ(key([](Config* c) { c->http.allow_origins = {"stage"}; }), "http.allow_origins");
  EXPECT_EQ(key([](Config* c) {
              c->security.name = "a";
              c->cluster.store = "nats://h:1";
              c->cluster.bucket = "a b";
            }),
            "cluster.bucket");
  // A flag may have set these.
  EXPECT_EQ(key([](Config* c) { c->bind = "here"; }), "");
  EXPECT_EQ(key([](Config* c) { c->osc_prefix = "a b"; }), "");
  EXPECT_EQ(key([](Config* c) { c->vmc = c->udp; }), "");
}

}  // namespace
}  // namespace furrow::server
