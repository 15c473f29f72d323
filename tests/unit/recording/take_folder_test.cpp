// SPDX-License-Identifier: Apache-2.0
#include "recording/take_folder.h"

#include <algorithm>
#include <csignal>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include "recording/take_summary.h"
#include "tests/unit/recording/take_testing.h"

namespace furrow::recording {
namespace {

namespace fs = std::filesystem;

class TakeFolderTest : public TakeTest {
 protected:
  std::unique_ptr<TakeFolder> OpenFolder(std::uint64_t rotate_bytes, std::uint64_t rotate_ns) {
    auto folder = TakeFolder::Open({.folder = folder_ / "takes",
                                    .rotate_bytes = rotate_bytes,
                                    .rotate_ns = rotate_ns,
                                    .rig_json = "{}"},
                                   Stamp(0).log_time_ns);
    EXPECT_TRUE(folder.ok()) << folder.status().ToString();
    return folder.ok() ? *std::move(folder) : nullptr;
  }
  [[nodiscard]] std::vector<fs::path> Takes() const {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder_ / "takes"))
      paths.push_back(entry.path());
    std::ranges::sort(paths);
    return paths;
  }
  Status WritePose(TakeFolder& folder, std::uint32_t i) {
    return folder.Write(TakeKind::kPose, "ada", Stamp(i), Payload(Pose(0.5f)));
  }
};

TEST_F(TakeFolderTest, NamesFilesByStartTimeAndNeverOverwrites) {
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(OpenFolder(0, 0)->Close().ok());
  const auto takes = Takes();
  ASSERT_EQ(takes.size(), 3u);
  EXPECT_EQ(takes[0].filename(), "take-19700101T010000Z.mcap");
  EXPECT_EQ(takes[2].filename(), "take-19700101T010000Z_3.mcap");
}

TEST_F(TakeFolderTest, DeclarationsBeyondTheSizeLimitDoNotRotateOnEveryMessage) {
  const auto folder = OpenFolder(/*rotate_bytes=*/40'000, 0);
  for (int i = 0; i < 400; ++i) {
    const std::string name = "subject with a long name, number " + std::to_string(i);
    ASSERT_TRUE(folder->Write(TakeKind::kSkeleton, name, Stamp(0), Payload(Offer(name))).ok());
  }
  const int before = folder->num_files();
  for (std::uint32_t i = 0; i < 100; ++i) ASSERT_TRUE(WritePose(*folder, i).ok());
  EXPECT_LE(folder->num_files() - before, 1);
  EXPECT_TRUE(folder->Close().ok());
}

TEST_F(TakeFolderTest, EveryFileBeginsWithTheCurrentSubjects) {
  const auto folder = OpenFolder(0, 100'000'000);
  const auto offer = Payload(Offer("ada"));
  ASSERT_TRUE(folder->Write(TakeKind::kSkeleton, "ada", Stamp(0), offer).ok());
  ASSERT_TRUE(folder->Write(TakeKind::kSkeleton, "bob", Stamp(0), Payload(Offer("bob"))).ok());
  folder->Forget("bob");
  for (std::uint32_t i = 0; i < 30; ++i) {
    ASSERT_TRUE(folder->Write(TakeKind::kSkeleton, "ada", Stamp(i), offer).ok()) << "repeated";
    ASSERT_TRUE(WritePose(*folder, i).ok());
  }
  ASSERT_TRUE(folder->Close().ok());
  EXPECT_EQ(folder->num_files(), 3);
  std::size_t poses = 0;
  for (const fs::path& path : Takes()) {
    auto take = TakeReader::Open(path);
    ASSERT_TRUE(take.ok());
    EXPECT_TRUE((*take)->file().complete());
    std::size_t skeletons = 0;
    ASSERT_TRUE((*take)
                    ->ForEach([&](const TakeMessage& message) {
                      skeletons += message.kind == TakeKind::kSkeleton && message.subject == "ada";
                      return true;
                    })
                    .ok());
    EXPECT_EQ(skeletons, 1u) << path;
    const auto summary = Summarise(**take);
    ASSERT_TRUE(summary.ok());
    poses += summary->subjects.at("ada").poses;
    EXPECT_EQ(summary->subjects.contains("bob"), poses == 10) << "only in the first file";
  }
  EXPECT_EQ(poses, 30u);
}

TEST_F(TakeFolderTest, RotatesBySize) {
  const auto folder = OpenFolder(/*rotate_bytes=*/3000, 0);
  for (std::uint32_t i = 0; i < 200; ++i) {
    ASSERT_TRUE(WritePose(*folder, i).ok());
    ASSERT_TRUE(folder->Flush().ok());
  }
  ASSERT_TRUE(folder->Close().ok());
  EXPECT_GT(folder->num_files(), 3);
}

TEST_F(TakeFolderTest, AFullDiskLeavesAReadableFile) {
  const auto folder = OpenFolder(0, 0);
  ASSERT_TRUE(folder->Write(TakeKind::kSkeleton, "ada", Stamp(0), Payload(Offer("ada"))).ok());
  ASSERT_TRUE(WritePose(*folder, 0).ok());
  ASSERT_TRUE(folder->Flush().ok());
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = fs::file_size(folder->path()) + 1000;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  Status status;
  for (std::uint32_t i = 1; i < 100 && status.ok(); ++i) {
    status = WritePose(*folder, i);
    if (status.ok()) status = folder->Flush();
  }
  EXPECT_EQ(status.code(), StatusCode::kIo);
  EXPECT_EQ(WritePose(*folder, 100).code(), StatusCode::kIo) << "the error persists";
  EXPECT_FALSE(folder->Close().ok());
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  auto take = TakeReader::Open(folder->path());
  ASSERT_TRUE(take.ok()) << take.status().ToString();
  const auto summary = Summarise(**take);
  ASSERT_TRUE(summary.ok());
  EXPECT_GT(summary->subjects.at("ada").poses, 0u);
}

TEST_F(TakeFolderTest, AFolderIsCheckedWithoutCreatingIt) {
  EXPECT_TRUE(CheckTakeFolder(folder_.path()).ok());
  EXPECT_TRUE(CheckTakeFolder(folder_ / "takes" / "today").ok());
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  std::ofstream(folder_ / "file") << "in the way";
  for (const fs::path& wrong : {folder_ / "file", folder_ / "file" / "takes"}) {
    const Status status = CheckTakeFolder(wrong);
    EXPECT_EQ(status.code(), StatusCode::kIo);
    EXPECT_NE(status.what().find("is not a folder"), std::string::npos) << status.ToString();
    EXPECT_EQ(status.where(), wrong.string());
  }
  if (geteuid() == 0) return;  // root may write everywhere
  fs::create_directory(folder_ / "closed");
  fs::permissions(folder_ / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_FALSE(CheckTakeFolder(folder_ / "closed").ok());
  EXPECT_FALSE(CheckTakeFolder(folder_ / "closed" / "takes").ok());
}

TEST_F(TakeFolderTest, AFolderThatWasRemovedDuringAPauseIsMadeAgain) {
  const auto folder = OpenFolder(0, 0);
  ASSERT_TRUE(folder->Write(TakeKind::kSkeleton, "ada", Stamp(0), Payload(Offer("ada"))).ok());
  folder->Fail(Status(StatusCode::kIo, "the disk is full"));
  fs::remove_all(folder_ / "takes");
  const Status status = folder->Resume(Stamp(1).log_time_ns);
  ASSERT_TRUE(status.ok()) << status.ToString();
  ASSERT_TRUE(WritePose(*folder, 1).ok());
  ASSERT_TRUE(folder->Close().ok());
  ASSERT_EQ(Takes().size(), 1u);
  auto take = TakeReader::Open(folder->path());
  ASSERT_TRUE(take.ok()) << take.status().ToString();
  const auto summary = Summarise(**take);
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->subjects.at("ada").poses, 1u);
}

}  // namespace
}  // namespace furrow::recording
