// SPDX-License-Identifier: Apache-2.0
#include "server/shares/host_rates.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr Time kStart = std::chrono::seconds(100);

int TakeAll(HostRates& rates, const std::string& host, Time now) {
  int taken = 0;
  while (rates.Take(host, now)) ++taken;
  return taken;
}

// One of 1,024 hosts shares its rate with another one.
TEST(HostRates, AHostHasItsRateAndTakesNothingFromOthers) {
  HostRates rates(10);
  EXPECT_EQ(TakeAll(rates, "192.0.2.1", kStart), 10);
  int whole = 0;
  for (int i = 2; i < 10; ++i) {
    if (TakeAll(rates, "192.0.2." + std::to_string(i), kStart) == 10) ++whole;
    if (TakeAll(rates, "2001:db8:0:" + std::to_string(i) + "::", kStart) == 10) ++whole;
  }
  EXPECT_GE(whole, 13) << "of 16";
}

TEST(HostRates, TheRateComesBackWithTime) {
  HostRates rates(10);
  EXPECT_EQ(TakeAll(rates, "192.0.2.1", kStart), 10);
  EXPECT_EQ(TakeAll(rates, "192.0.2.1", kStart + std::chrono::milliseconds(300)), 3);
  EXPECT_EQ(TakeAll(rates, "192.0.2.1", kStart + std::chrono::hours(1)), 10) << "not more";
}

TEST(HostRates, HostsWithoutANumericAddressShareOne) {
  HostRates rates(10);
  EXPECT_EQ(TakeAll(rates, "somewhere", kStart), 10);
  EXPECT_FALSE(rates.Take("", kStart));
}

}  // namespace
}  // namespace furrow::server
