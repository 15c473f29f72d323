// SPDX-License-Identifier: Apache-2.0
#include "base/process/find_program.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace furrow {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FindHelperProgramTest : public testing::Test {
 protected:
  void AddProgram(const fs::path& path) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << "#!/bin/sh\n";
    fs::permissions(path, fs::perms::owner_all);
  }

  TemporaryFolder folder_;
};

TEST_F(FindHelperProgramTest, LooksBesideTheProgramThenInLibexec) {
  const fs::path bin = folder_.path() / "bin";
  const fs::path libexec = folder_.path() / "libexec" / "furrow" / "furrow-load";
  AddProgram(libexec);
  const auto second = FindHelperProgram("furrow-load", bin);
  ASSERT_TRUE(second.ok()) << second.status().ToString();
  EXPECT_EQ(*second, libexec);
  AddProgram(bin / "furrow-load");
  const auto first = FindHelperProgram("furrow-load", bin);
  ASSERT_TRUE(first.ok()) << first.status().ToString();
  EXPECT_EQ(*first, bin / "furrow-load");
}

TEST_F(FindHelperProgramTest, AMissingProgramSaysWhatToBuild) {
  const auto missing = FindHelperProgram("furrow-load", folder_.path() / "bin");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.status().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.status().ToString(), HasSubstr("the program furrow-load is missing"));
  EXPECT_THAT(missing.status().ToString(), HasSubstr("--target furrow_programs"));
}

}  // namespace
}  // namespace furrow
