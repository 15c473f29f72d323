// SPDX-License-Identifier: Apache-2.0
#include "base/files.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/temporary_folder.h"

namespace furrow {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  // The number of entries in the folder, to see that no temporary file is left.
  [[nodiscard]] std::size_t NumEntries() const {
    const fs::directory_iterator entries(root_.path());
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
  }

  TemporaryFolder root_;
};

TEST_F(Files, ReadsUpToTheLimit) {
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "12345").ok());
  EXPECT_EQ(*ReadFile(root_ / "f", 5), "12345");
  EXPECT_EQ(ReadFile(root_ / "f", 4).status().code(), StatusCode::kLimit);
  EXPECT_EQ(ReadFile(root_ / "absent", 4).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(ReadFile(root_.path(), 4).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(ReadFile("/dev/zero", 4).status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(ReadFile(root_.path(), 4).status().what(), "is a folder");
  EXPECT_EQ(ReadFile("/dev/zero", 4).status().what(), "not a regular file");
  EXPECT_EQ(ReadFile(root_ / "absent", 4).status().where(), (root_ / "absent").string());
}

// It would be read as a file of the wrong format.
TEST_F(Files, RefusesWhatGitLfsLeavesInPlaceOfAFile) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
  ASSERT_TRUE(WriteFileAtomically(root_ / "take.bvh", pointer).ok());
  const Status status = ReadFile(root_ / "take.bvh", 1000).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_NE(status.todo().find("git lfs pull"), std::string::npos);
}

TEST_F(Files, WritesAllOrNothing) {
  fs::create_directory(root_ / "folder");
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "old").ok());
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "new").ok());
  EXPECT_EQ(*ReadFile(root_ / "f", 10), "new");

  const Status status = WriteFileAtomically(root_ / "no/such/folder/f", "x");
  EXPECT_EQ(status.code(), StatusCode::kIo);
  EXPECT_EQ(status.where(), (root_ / "no/such/folder/f").string());
  EXPECT_EQ(WriteFileAtomically(root_ / "folder", "x").code(), StatusCode::kIo);
  EXPECT_EQ(NumEntries(), 2u);
}

TEST_F(Files, OnlyTheOwnerReadsASecretFile) {
  const fs::path path = root_ / "secret";
  ASSERT_TRUE(WriteSecretFile(path, "old").ok());
  ASSERT_TRUE(WriteSecretFile(path, "key").ok());
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(*ReadSecretFile(path, 3), "key");
  EXPECT_EQ(ReadSecretFile(path, 2).status().code(), StatusCode::kLimit);
  EXPECT_EQ(ReadSecretFile(root_ / "absent", 3).status().code(), StatusCode::kNotFound);
  for (const fs::perms right : {fs::perms::group_read, fs::perms::others_read,
                                fs::perms::group_write, fs::perms::others_write}) {
    fs::permissions(path, right, fs::perm_options::add);
    const Status status = ReadSecretFile(path, 3).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.todo(), "run: chmod 600 " + path.string());
    fs::permissions(path, right, fs::perm_options::remove);
  }
  EXPECT_TRUE(ReadSecretFile(path, 3).ok());
}

// As systemd (from version 254) and Kubernetes (fsGroup) do.
TEST_F(Files, RootHandsASecretToAGroup) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root";
  constexpr int kNobody = 65534;
  const fs::path path = root_ / "secret";
  ASSERT_TRUE(WriteSecretFile(path, "key").ok());
  ASSERT_EQ(::chown(path.c_str(), 0, kNobody), 0);
  ASSERT_EQ(::chmod(path.c_str(), 0440), 0);
  fs::permissions(root_.path(), fs::perms::others_exec, fs::perm_options::add);
  EXPECT_EQ(ReadSecretFile(path, 3).status().code(), StatusCode::kInvalidArgument)
      << "root has other ways";
  const auto read_as_nobody = [&path] {
    EXPECT_EQ(::setegid(kNobody), 0);
    EXPECT_EQ(::seteuid(kNobody), 0);
    auto secret = ReadSecretFile(path, 3);
    EXPECT_EQ(::seteuid(0), 0);
    EXPECT_EQ(::setegid(0), 0);
    return secret;
  };
  EXPECT_EQ(*read_as_nobody(), "key");
  for (const mode_t mode : {0444u, 0460u, 0450u, 0441u}) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    EXPECT_EQ(read_as_nobody().status().code(), StatusCode::kInvalidArgument) << mode;
  }
  // A file of somebody else has not been handed over.
  ASSERT_EQ(::chown(path.c_str(), 1, kNobody), 0);
  ASSERT_EQ(::chmod(path.c_str(), 0440), 0);
  EXPECT_EQ(read_as_nobody().status().code(), StatusCode::kInvalidArgument);
}

TEST_F(Files, OneFailureKeepsAllFilesOfAGroup) {
  fs::create_directory(root_ / "folder");
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "old").ok());
  const FileToWrite files[] = {{root_ / "f", "new"}, {root_ / "folder", "x"}};
  EXPECT_EQ(WriteFilesAtomically(files).code(), StatusCode::kIo);
  EXPECT_EQ(*ReadFile(root_ / "f", 10), "old");
  EXPECT_EQ(NumEntries(), 2u);
}

TEST_F(Files, AppliesTheUmask) {
  const mode_t before = ::umask(027);
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "x", Flush::kNone).ok());
  ::umask(before);
  EXPECT_EQ(fs::status(root_ / "f").permissions(), fs::perms(0640));
}

TEST_F(Files, FollowsSymbolicLinks) {
  ASSERT_TRUE(WriteFileAtomically(root_ / "target", "old").ok());
  fs::create_symlink(root_ / "target", root_ / "link");
  ASSERT_TRUE(WriteFileAtomically(root_ / "link", "new").ok());
  EXPECT_TRUE(fs::is_symlink(root_ / "link"));
  EXPECT_EQ(*ReadFile(root_ / "target", 10), "new");
}

// A rename would replace the pipe, and the reader would wait for ever.
TEST_F(Files, WritesIntoPipesAndDevices) {
  const fs::path pipe = root_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string received(3, '\0');
  std::thread reader([&] {
    std::FILE* file = std::fopen(pipe.c_str(), "rb");
    received.resize(std::fread(received.data(), 1, received.size(), file));
    std::fclose(file);
  });
  EXPECT_TRUE(WriteFileAtomically(pipe, "abc").ok());
  reader.join();
  EXPECT_EQ(received, "abc");
  EXPECT_EQ(fs::status(pipe).type(), fs::file_type::fifo);
  EXPECT_TRUE(WriteFileAtomically("/dev/null", "abc").ok());
  EXPECT_EQ(fs::status("/dev/null").type(), fs::file_type::character);
}

TEST_F(Files, CheckWritableChangesNothing) {
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "kept").ok());
  EXPECT_TRUE(CheckWritable(root_ / "f").ok());
  EXPECT_EQ(*ReadFile(root_ / "f", 10), "kept");
  EXPECT_TRUE(CheckWritable(root_ / "new").ok());
  EXPECT_FALSE(fs::exists(root_ / "new"));
  EXPECT_EQ(CheckWritable(root_ / "no/such/folder/f").code(), StatusCode::kIo);
}

}  // namespace
}  // namespace furrow
