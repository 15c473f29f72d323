// SPDX-License-Identifier: Apache-2.0
#include "client/c/struct_copy.h"

#include <gtest/gtest.h>

namespace furrow::capi {
namespace {

struct Options {
  std::uint32_t struct_size;
  std::uint32_t flags;
  std::uint64_t more;
};
struct NewOptions {
  Options old;
  std::uint64_t newest;
};

TEST(StructCopy, AnOlderProgramsFieldsAreZero) {
  const Options from{8, 5, 99};
  Options to{1, 1, 1};
  EXPECT_EQ(CopyIn(&from, &to), FURROW_OK);
  EXPECT_EQ(to.flags, 5u);
  EXPECT_EQ(to.more, 0u) << "not part of the older struct";
}

TEST(StructCopy, ANewerProgramMayNotSetUnknownFields) {
  NewOptions from{{sizeof(NewOptions), 5, 6}, 0};
  Options to{};
  EXPECT_EQ(CopyIn(&from.old, &to), FURROW_OK);
  EXPECT_EQ(to.more, 6u);
  from.newest = std::uint64_t{1} << 63;
  EXPECT_EQ(CopyIn(&from.old, &to), FURROW_UNSUPPORTED);
}

TEST(StructCopy, SizesThatAreNoneAreRejected) {
  Options to{};
  EXPECT_EQ(CopyIn<Options>(nullptr, &to), FURROW_INVALID_ARGUMENT);
  for (const std::uint32_t size : {0u, 4u, 7u, 4097u, 0xffffffffu}) {
    Options from{size, 0, 0};
    EXPECT_EQ(CopyIn(&from, &to), FURROW_INVALID_ARGUMENT) << size;
    EXPECT_EQ(CopyOut(Options{}, &from), FURROW_INVALID_ARGUMENT) << size;
    EXPECT_EQ(from.struct_size, size);
  }
  EXPECT_EQ(CopyOut<Options>({}, nullptr), FURROW_INVALID_ARGUMENT);
}

TEST(StructCopy, OnlyTheKnownPartIsFilled) {
  Options to{8, 0, 42};
  EXPECT_EQ(CopyOut({sizeof(Options), 7, 8}, &to), FURROW_OK);
  EXPECT_EQ(to.struct_size, 8u);
  EXPECT_EQ(to.flags, 7u);
  EXPECT_EQ(to.more, 42u) << "an older program has other data there";
}

TEST(StructCopy, UnknownFieldsOfANewerProgramBecomeZero) {
  NewOptions to{{sizeof(NewOptions), 1, 1}, 1};
  EXPECT_EQ(CopyOut({sizeof(Options), 7, 8}, &to.old), FURROW_OK);
  EXPECT_EQ(to.old.struct_size, sizeof(NewOptions));
  EXPECT_EQ(to.old.more, 8u);
  EXPECT_EQ(to.newest, 0u);
}

}  // namespace
}  // namespace furrow::capi
