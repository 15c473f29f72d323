// SPDX-License-Identifier: Apache-2.0
#include "base/process/descriptor.h"

#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>

namespace furrow {
namespace {

bool IsOpen(int number) { return fcntl(number, F_GETFD) >= 0; }

Descriptor Null() { return Descriptor(open("/dev/null", O_RDONLY | O_CLOEXEC)); }

TEST(Descriptor, ClosesWhatItOwns) {
  int number = -1;
  {
    const Descriptor file = Null();
    ASSERT_TRUE(file.ok());
    number = file.get();
    EXPECT_TRUE(IsOpen(number));
  }
  EXPECT_FALSE(IsOpen(number));
  EXPECT_FALSE(Descriptor().ok());
}

TEST(Descriptor, AMoveKeepsTheFileOpen) {
  Descriptor first = Null();
  const int number = first.get();
  Descriptor second = std::move(first);
  EXPECT_EQ(second.get(), number);
  EXPECT_TRUE(IsOpen(number));
  second = Descriptor();
  EXPECT_FALSE(second.ok());
  EXPECT_FALSE(IsOpen(number));
}

TEST(Descriptor, AReleasedFileBelongsToTheCaller) {
  Descriptor file = Null();
  Descriptor owner(file.Release());
  EXPECT_FALSE(file.ok());
  EXPECT_TRUE(IsOpen(owner.get()));
  owner.Close();
  EXPECT_FALSE(owner.ok());
}

}  // namespace
}  // namespace furrow
