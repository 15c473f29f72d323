// SPDX-License-Identifier: Apache-2.0
#include "motion/find_recording.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace furrow::motion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// A data folder with two shipped recordings, and an empty current folder.
class FindRecordingTest : public ::testing::Test {
 protected:
  FindRecordingTest() : before_(fs::current_path()) {
    fs::create_directories(data_ / "recordings");
    fs::create_directories(here_);
    for (const char* name : {"walk.bvh", "dance.bvh", "notes.txt"}) {
      std::ofstream(data_ / "recordings" / name) << "x";
    }
    setenv("FURROW_DATA_DIR", data_.c_str(), 1);
    fs::current_path(here_);
  }
  ~FindRecordingTest() override {
    fs::current_path(before_);
    unsetenv("FURROW_DATA_DIR");
  }

  TemporaryFolder root_;
  fs::path before_;
  fs::path data_ = root_.path() / "data";
  fs::path here_ = root_.path() / "here";
};

TEST_F(FindRecordingTest, ShippedRecordingsHaveBareNames) {
  EXPECT_EQ(*FindRecording("walk"), data_ / "recordings/walk.bvh");
  EXPECT_EQ(*FindRecording("walk.bvh"), data_ / "recordings/walk.bvh");
  EXPECT_EQ(*FindRecording("walk#first"), data_ / "recordings/walk.bvh#first");
}

TEST_F(FindRecordingTest, FilesComeFirst) {
  std::ofstream(here_ / "walk") << "x";
  EXPECT_EQ(*FindRecording("walk"), "walk");
  std::ofstream(here_ / "take.mcap") << "x";
  EXPECT_EQ(*FindRecording("take.mcap#ada"), "take.mcap#ada");
  const std::string path = (here_ / "take.mcap").string();
  EXPECT_EQ(*FindRecording(path), path);
}

TEST_F(FindRecordingTest, ASlashMeansAFile) {
  // The reader says that it does not exist.
  EXPECT_EQ(*FindRecording("./walk"), "./walk");
  EXPECT_EQ(*FindRecording("recordings/walk.bvh"), "recordings/walk.bvh");
}

TEST_F(FindRecordingTest, TheErrorSaysWhereItLooked) {
  for (const char* name : {"wlak", "wlak.bvh", "notes.txt", ""}) {
    const auto found = FindRecording(name);
    ASSERT_EQ(found.status().code(), StatusCode::kNotFound) << name;
    EXPECT_EQ(found.status().where(), name);
    const std::string text = found.status().ToString();
    EXPECT_THAT(text, HasSubstr("no such recording"));
    EXPECT_THAT(text, HasSubstr("looked in " + fs::canonical(here_).string() + " and in " +
                                (data_ / "recordings").string()));
    EXPECT_THAT(text, HasSubstr("shipped recordings: dance, walk"));
  }
}

TEST_F(FindRecordingTest, MissingDataIsNamed) {
  fs::remove_all(data_);
  const std::string text = FindRecording("walk").status().ToString();
  EXPECT_THAT(text, HasSubstr((data_ / "recordings").string() + ", which is missing"));
}

}  // namespace
}  // namespace furrow::motion
