// SPDX-License-Identifier: Apache-2.0
#include "server/machine/journal.h"

#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace furrow::server {
namespace {

TEST(IsJournal, ComparesTheStreamWithTheDescriptor) {
  int pipes[2];
  ASSERT_EQ(pipe(pipes), 0);
  struct stat info {};
  ASSERT_EQ(fstat(pipes[1], &info), 0);
  const std::string stream = std::to_string(info.st_dev) + ":" + std::to_string(info.st_ino);
  EXPECT_TRUE(IsJournal(pipes[1], stream));
  EXPECT_FALSE(IsJournal(pipes[1], stream + "0")) << "redirected since";
  EXPECT_FALSE(IsJournal(pipes[1], ""));
  EXPECT_FALSE(IsJournal(-1, stream));
  close(pipes[0]);
  close(pipes[1]);
}

TEST(AsJournalError, MarksEachLine) {
  EXPECT_EQ(AsJournalError(""), "");
  EXPECT_EQ(AsJournalError("one\n"), "<3>one\n");
  EXPECT_EQ(AsJournalError("one\ntwo"), "<3>one\n<3>two");
  EXPECT_EQ(AsJournalError("one\n\ntwo\n"), "<3>one\n<3>\n<3>two\n");
}

}  // namespace
}  // namespace furrow::server
