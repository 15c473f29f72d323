// SPDX-License-Identifier: Apache-2.0
#include "base/process/module.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Module, AFunctionIsFoundInALibrary) {
  std::string why;
  EXPECT_NE(LoadFromModule("libc.so.6", "strlen", &why), nullptr) << why;
}

TEST(Module, WhatIsMissingIsNamed) {
  std::string why;
  EXPECT_EQ(LoadFromModule(ModulePath("nowhere.so"), "Make", &why), nullptr);
  EXPECT_THAT(why, testing::HasSubstr("lib/furrow/nowhere.so"));
  EXPECT_EQ(LoadFromModule("libc.so.6", "no_such_function", &why), nullptr);
  EXPECT_THAT(why, testing::HasSubstr("no_such_function"));
}

}  // namespace
}  // namespace furrow
