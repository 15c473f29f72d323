// SPDX-License-Identifier: Apache-2.0
#include "server/config/osc_profile_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using protocol::mocap::OscField;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(OscProfileFile, ReadsAllKeys) {
  const auto profile = ParseOscProfile(R"(
description = "for people"
only_renamed = true
[value]
address = "/{prefix}/{subject}/{name}/{identifier}"
arguments = ["name", "subject", "value", "sequence", "capture_time"]
[timecode]
address = "/time"
arguments = ["timecode"]
[end]
address = "/done"
arguments = []
[names]
"brow_l.squash" = "BrowDownLeft"
)",
                                       "folder/mine.toml");
  ASSERT_TRUE(profile.ok()) << profile.status().ToString();
  EXPECT_EQ(profile->name, "mine");
  EXPECT_EQ(profile->value.address, "/{prefix}/{subject}/{name}/{identifier}");
  EXPECT_THAT(profile->value.arguments,
              ElementsAre(OscField::kName, OscField::kSubject, OscField::kValue,
                          OscField::kSequence, OscField::kCaptureTime));
  ASSERT_TRUE(profile->timecode.has_value());
  EXPECT_EQ(profile->timecode->address, "/time");
  EXPECT_THAT(profile->timecode->arguments, ElementsAre(OscField::kTimecode));
  ASSERT_TRUE(profile->end.has_value());
  EXPECT_EQ(profile->end->address, "/done");
  EXPECT_TRUE(profile->only_renamed);
  EXPECT_EQ(profile->names.at("brow_l.squash"), "BrowDownLeft");
}

TEST(OscProfileFile, ErrorsNameFileLineAndKey) {
  const std::pair<std::string, std::string> cases[] = {
      {"[value]\naddress = 'no-slash'", "value.address must begin with '/'"},
      {"[value]\naddress = '/a b'", "value.address must not contain blanks"},
      {"[value]\naddress = '/{who}'", "no braces but {prefix}"},
      {"[value]\naddress = '/a'\narguments = ['colour']", "value.arguments may list name"},
      {"[value]\naddress = '/a'\narguments = 'value'", "value.arguments must be a list"},
      {"[value]\naddress = '/a'\narguments = [1]", "value.arguments may list name"},
      {"[names]\na = 1", "names 'a' must be a text"},
      {"[names]\na = \"b\\u0000c\"", "without control characters"},
      {"[value]\naddress = '/a'\n[end]\narguments = ['sequence']", "end.address is missing"},
      {"[value]\naddress = '/a'\n[timecode]\narguments = ['timecode']",
       "timecode.address is missing"},
      {"[value]\nadress = '/a'", "unknown key 'value.adress'"},
      {"speed = 1", "unknown key 'speed'"},
      {"[end]\naddress = '/a'", "value.address is missing"},
      {"[value", ""}};
  for (const auto& [text, message] : cases) {
    const auto profile = ParseOscProfile(text, "p.toml");
    ASSERT_FALSE(profile.ok()) << text;
    EXPECT_THAT(profile.status().ToString(), HasSubstr("p.toml")) << text;
    EXPECT_THAT(profile.status().ToString(), HasSubstr(message)) << text;
  }
}

TEST(OscProfileFile, ShippedProfilesLoad) {
  EXPECT_THAT(ShippedOscProfiles(), ElementsAre("furrow", "vmc", "vrchat"));
  for (const std::string& name : ShippedOscProfiles()) {
    EXPECT_TRUE(LoadOscProfile(name).ok()) << LoadOscProfile(name).status().ToString();
    EXPECT_TRUE(IsShippedOscProfile(name));
  }
  const auto missing = LoadOscProfile("vmcc");
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.status().ToString(), HasSubstr("shipped profiles: furrow, vmc, vrchat"));
}

TEST(OscProfileFile, FilesAreNoShippedProfiles) {
  // A path ends at a zero byte.
  for (const std::string& name :
       {std::string("../osc/vmc.toml"), std::string("vmc.toml"), std::string("/etc/passwd"),
        std::string(), std::string("."), std::string("vmc.toml\0", 9)}) {
    EXPECT_FALSE(IsShippedOscProfile(name)) << name;
  }
  EXPECT_FALSE(LoadOscProfile("./absent.toml").ok());
}

}  // namespace
}  // namespace furrow::server
