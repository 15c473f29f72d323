// SPDX-License-Identifier: Apache-2.0
#include "server/saved/state_file.h"

#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace furrow::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Content(int file, std::size_t size) {
  Bytes bytes(size);
  EXPECT_EQ(pread(file, bytes.data(), size, 0), static_cast<ssize_t>(size));
  return bytes;
}

TEST(StateFile, IsReadOnceAndWiped) {
  // Larger than what is wiped at once.
  const Bytes secret(200'000, 7);
  const auto file = MakeStateFile(secret);
  ASSERT_TRUE(file.ok()) << file.status().ToString();
  const int copy = dup(*file);  // the service manager has one
  const auto taken = TakeStateFile(*file);
  ASSERT_TRUE(taken.ok()) << taken.status().ToString();
  EXPECT_EQ(*taken, secret);
  EXPECT_EQ(fcntl(*file, F_GETFD), -1);
  EXPECT_EQ(Content(copy, secret.size()), Bytes(secret.size(), 0));
  close(copy);
}

TEST(StateFile, IsWipedWhenNobodyMayReadIt) {
  const auto file = MakeStateFile(Bytes(200'000, 7));
  ASSERT_TRUE(file.ok());
  const int copy = dup(*file);
  DestroyStateFile(*file);
  EXPECT_EQ(fcntl(*file, F_GETFD), -1);
  EXPECT_EQ(Content(copy, 200'000), Bytes(200'000, 0));
  close(copy);
}

TEST(StateFile, KeepsItsSize) {
  const auto file = MakeStateFile(Bytes(100, 7));
  ASSERT_TRUE(file.ok());
  EXPECT_NE(ftruncate(*file, 10), 0);
  EXPECT_NE(ftruncate(*file, 1000), 0);
  EXPECT_EQ(fcntl(*file, F_ADD_SEALS, F_SEAL_WRITE), -1);
  (void)TakeStateFile(*file);
}

TEST(StateFile, OtherDescriptorsAreNotRead) {
  const int unsealed = memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  EXPECT_FALSE(TakeStateFile(unsealed).ok());
  EXPECT_FALSE(TakeStateFile(open("/dev/zero", O_RDWR | O_CLOEXEC)).ok());
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_FALSE(TakeStateFile(ends[0]).ok());
  close(ends[1]);
}

TEST(StateFile, MayBeEmpty) {
  const auto file = MakeStateFile({});
  ASSERT_TRUE(file.ok());
  const auto taken = TakeStateFile(*file);
  ASSERT_TRUE(taken.ok());
  EXPECT_TRUE(taken->empty());
}

}  // namespace
}  // namespace furrow::server
