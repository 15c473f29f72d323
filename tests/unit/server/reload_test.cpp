// SPDX-License-Identifier: Apache-2.0
#include "server/reload.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::HasSubstr;
using testing::Not;

// A port of which the address waits for a restart, and the senders do not.
TEST(Reload, WhatWaitsForARestartMayForbidTheRest) {
  Config running;
  running.bind = "0.0.0.0";
  running.security.mode = Security::kRequired;
  running.security.keys = "keys";
  running.vmc = std::uint16_t{39539};
  running.mocap_allow = {"10.0.0.5"};
  ASSERT_TRUE(ValidateConfig(running).ok()) << ValidateConfig(running).ToString();
  Config wanted = running;
  wanted.bind = "127.0.0.1";
  wanted.mocap_allow = {};
  ASSERT_TRUE(ValidateConfig(wanted).ok()) << ValidateConfig(wanted).ToString();
  const auto reload = PrepareReload(
      {.running = running, .read = [&] { return Result<Config>(wanted); }, .drawn = nullptr});
  ASSERT_FALSE(reload.ok()) << "the network could publish without a token";
  EXPECT_THAT(reload.status().ToString(), HasSubstr("could publish there"));
  EXPECT_THAT(reload.status().ToString(), HasSubstr("listen.bind"));
}

TEST(Reload, AFolderThatAConfinedDaemonDoesNotKnowTakesARestart) {
  const auto why = [](bool is_confined, const std::string& what) {
    const auto reload =
        PrepareReload({.running = {},
                       .read = [&what]() -> Result<Config> {
                         return Status(StatusCode::kIo, what, "/srv/new/furrow.keys");
                       },
                       .drawn = nullptr,
                       .is_confined = is_confined});
    return reload.status().ToString();
  };
  const std::string denied = "cannot open the file: Permission denied";
  EXPECT_THAT(why(true, denied), HasSubstr("/srv/new/furrow.keys: " + denied + " (a confined"));
  EXPECT_THAT(why(true, denied), HasSubstr("restart it"));
  EXPECT_THAT(why(false, denied), Not(HasSubstr("confined")));
  EXPECT_THAT(why(true, "no such file"), Not(HasSubstr("confined")));
}

}  // namespace
}  // namespace furrow::server
