// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/key_file.h"

#include <cstdint>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/log_capture.h"
#include "tests/temporary_folder.h"

namespace furrow::server {
namespace {

namespace fs = std::filesystem;
namespace secure = protocol::secure;
using ::testing::HasSubstr;
using ::testing::Not;

class KeyFileTest : public testing::Test {
 protected:
  // Writes a file with one new key, and returns its id.
  std::uint32_t Write() {
    secure::KeyRing ring;
    const auto id = ring.AddNew(1'000, 2'000, secure::SystemRandom());
    EXPECT_TRUE(id.ok() && secure::SaveKeyRing(ring, path_).ok());
    return *id;
  }

  LogCapture log_;
  TemporaryFolder folder_;
  fs::path path_ = folder_ / "furrow.keys";
};

TEST_F(KeyFileTest, ReadsAChangedFileOnce) {
  const std::uint32_t first = Write();
  KeyFile file(path_);
  const auto keys = file.Load();
  ASSERT_TRUE(keys.ok()) << keys.status().ToString();
  EXPECT_NE(keys->Find(first), nullptr);
  EXPECT_FALSE(file.ReadIfChanged());
  const std::uint32_t second = Write();
  const auto changed = file.ReadIfChanged();
  ASSERT_TRUE(changed);
  EXPECT_NE(changed->Find(second), nullptr);
  EXPECT_FALSE(file.ReadIfChanged());
}

// A copied key file often has rights for others, which a change of its rights alone removes.
TEST_F(KeyFileTest, TriesAFaultyFileUntilItCanBeRead) {
  Write();
  KeyFile file(path_);
  ASSERT_TRUE(file.Load().ok());
  const std::uint32_t next = Write();
  fs::permissions(path_, fs::perms::group_read, fs::perm_options::add);
  EXPECT_FALSE(file.ReadIfChanged());
  const std::string once = log_.text();
  EXPECT_THAT(once, HasSubstr("the keys stay as they were"));
  EXPECT_FALSE(file.ReadIfChanged());
  EXPECT_EQ(log_.text(), once) << "once per change";
  fs::permissions(path_, fs::perms::group_read, fs::perm_options::remove);
  const auto keys = file.ReadIfChanged();
  ASSERT_TRUE(keys);
  EXPECT_NE(keys->Find(next), nullptr);
  EXPECT_FALSE(file.ReadIfChanged());
}

TEST_F(KeyFileTest, SaysThatThereIsNoKey) {
  ASSERT_TRUE(secure::SaveKeyRing({}, path_).ok());
  EXPECT_TRUE(KeyFile(path_).Load().ok());
  EXPECT_THAT(log_.text(), HasSubstr("the key file has no key, so no token is valid"));
}

TEST_F(KeyFileTest, SaysThatAllKeysHaveExpired) {
  Write();  // in 1970
  KeyFile file(path_);
  EXPECT_TRUE(file.Load().ok());
  EXPECT_THAT(log_.text(), HasSubstr("all keys of the key file have expired"));
  // While the daemon runs, too.
  ASSERT_TRUE(secure::SaveKeyRing({}, path_).ok());
  EXPECT_TRUE(file.ReadIfChanged());
  EXPECT_THAT(log_.text(), HasSubstr("the key file has no key"));
}

TEST_F(KeyFileTest, NoFileHasNoKeys) {
  KeyFile none({});
  const auto keys = none.Load();
  ASSERT_TRUE(keys.ok());
  EXPECT_TRUE(keys->keys().empty());
  EXPECT_FALSE(none.ReadIfChanged());
  EXPECT_THAT(log_.text(), Not(HasSubstr("no token is valid")));
  EXPECT_FALSE(KeyFile(path_).Load().ok()) << "it does not exist";
}

}  // namespace
}  // namespace furrow::server
