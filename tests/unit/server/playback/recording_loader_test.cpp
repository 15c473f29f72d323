// SPDX-License-Identifier: Apache-2.0
#include "server/playback/recording_loader.h"

#include <cstring>
#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/net/clock.h"

namespace furrow::server {
namespace {

using testing::HasSubstr;

constexpr char kBvh[] =
    "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n"
    "OFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n0 10 0\n";

UploadedFile FileOf(const std::string& name, std::string_view bytes) {
  UploadedFile file{name, std::make_unique<char[]>(bytes.size()), bytes.size()};
  std::memcpy(file.buffer.get(), bytes.data(), bytes.size());
  return file;
}

class RecordingLoaderTest : public testing::Test {
 protected:
  Result<RecordingLoader::Loaded> Load(const std::string& name, std::string_view bytes,
                                       bool runs_helpers = false) {
    RecordingLoader loader({.read = {}, .runs_helpers = runs_helpers, .metrics = &metrics});
    std::promise<Result<RecordingLoader::Loaded>> loaded;
    EXPECT_TRUE(loader
                    .Load(FileOf(name, bytes),
                          [&](Result<RecordingLoader::Loaded> result) {
                            thread = std::this_thread::get_id();
                            loaded.set_value(std::move(result));
                          })
                    .ok());
    return loaded.get_future().get();
  }
  Metrics metrics;
  std::thread::id thread;
};

TEST_F(RecordingLoaderTest, ReadsOnAThreadOfItsOwn) {
  const auto loaded = Load("nod.bvh", kBvh);
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  EXPECT_NE(thread, std::this_thread::get_id());
  EXPECT_EQ(loaded->player->subject(), "nod");
  EXPECT_EQ(loaded->player->state(Time{0}).frames, 2);
  EXPECT_EQ(loaded->player->state(Time{0}).file, "nod.bvh");
  EXPECT_THAT(loaded->warnings, testing::IsEmpty());
}

TEST_F(RecordingLoaderTest, PassesOnWhatTheReaderTolerated) {
  std::string text = kBvh;
  text.replace(text.find("Frames: 2"), 9, "Frames: 3");
  const auto loaded = Load("nod.bvh", text);
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  EXPECT_THAT(loaded->warnings, testing::ElementsAre(HasSubstr("nod.bvh")));
}

TEST_F(RecordingLoaderTest, OneClearErrorSaysWhatAndWhere) {
  const auto cut = Load("nod.bvh", std::string_view(kBvh).substr(0, 60)).status();
  EXPECT_EQ(cut.code(), StatusCode::kParse) << cut.ToString();
  EXPECT_THAT(cut.where(), HasSubstr("nod.bvh"));
  EXPECT_THAT(Load("photo.jpg", "\xFF\xD8\xFF").status().ToString(),
              HasSubstr("unknown recording format '.jpg'"));
  EXPECT_THAT(Load("empty.csv", "").status().what(), HasSubstr("empty"));
  EXPECT_THAT(Load("take.mcap", "not").status().what(), HasSubstr("not an MCAP file"));
  EXPECT_THAT(Load("bad\xFF.bvh", kBvh).status().what(), HasSubstr("not UTF-8"));
}

TEST_F(RecordingLoaderTest, HelperProgramsRunOnlyWhereTheyMay) {
  const auto status = Load("walk.fbx", "; FBX 7.3.0").status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_THAT(status.todo(), HasSubstr("furrow convert walk.fbx"));
  EXPECT_NE(Load("walk.fbx", "; FBX 7.3.0", /*runs_helpers=*/true).status().what(), status.what());
}

TEST_F(RecordingLoaderTest, ReadsOneFileAtATime) {
  RecordingLoader loader({.read = {}, .metrics = &metrics});
  std::promise<void> reading;
  std::promise<void> go_on;
  const auto wait = [&](const Result<RecordingLoader::Loaded>&) {
    reading.set_value();
    go_on.get_future().wait();
  };
  ASSERT_TRUE(loader.Load(FileOf("a.bvh", kBvh), wait).ok());
  reading.get_future().wait();
  EXPECT_FALSE(loader.WaitUntil(ReadClock())) << "the thread has not ended";
  go_on.set_value();
  EXPECT_TRUE(loader.WaitUntil(Time::max() / 2));
  std::promise<void> again;
  ASSERT_TRUE(loader
                  .Load(FileOf("b.bvh", kBvh),
                        [&](const Result<RecordingLoader::Loaded>&) { again.set_value(); })
                  .ok());
  again.get_future().wait();
}

}  // namespace
}  // namespace furrow::server
