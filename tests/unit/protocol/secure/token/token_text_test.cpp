// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/token_text.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/temporary_folder.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

ClientToken SomeToken() {
  test::RepeatableRandom random;
  const KeyRing ring = test::MakeRing(random);
  return test::MakeTestToken(ring, random);
}

TEST(TokenText, RoundTrips) {
  const ClientToken token = SomeToken();
  const std::string text = ToText(token);
  EXPECT_EQ(text.size(), kTokenTextBytes);
  EXPECT_TRUE(text.starts_with("frw1_"));
  const auto again = ParseToken("\n  " + text + " \r\n");
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->bytes, token.bytes);
  EXPECT_TRUE(EqualInConstantTime(again->key.bytes(), token.key.bytes()));
}

TEST(TokenText, NoticesEveryChangedCharacter) {
  const std::string text = ToText(SomeToken());
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string changed = text;
    changed[i] = changed[i] == 'A' ? 'B' : 'A';
    ASSERT_FALSE(ParseToken(changed).ok()) << i;
  }
}

TEST(TokenText, SaysWhatIsWrongWithoutRepeatingIt) {
  const std::string text = ToText(SomeToken());
  EXPECT_EQ(ParseToken("").status().what(), "a token begins with 'frw1_'");
  EXPECT_EQ(ParseToken("stage.token").status().what(), "a token begins with 'frw1_'");
  const Status cut = ParseToken(text.substr(0, 300)).status();
  EXPECT_EQ(cut.what(), "the token has 300 characters instead of 389");
  std::string changed = text;
  std::swap(changed[100], changed[101]);
  if (changed == text) std::swap(changed[101], changed[102]);
  EXPECT_EQ(ParseToken(changed).status().what(),
            "the token was changed: its checksum does not match");
  for (const Status& status : {cut, ParseToken(changed).status()}) {
    EXPECT_EQ(status.ToString().find(text.substr(10, 20)), std::string::npos);
  }
}

TEST(TokenText, LoadsFilesThatOnlyTheOwnerReads) {
  TemporaryFolder folder;
  const ClientToken token = SomeToken();
  const std::filesystem::path path = folder / "stage.token";
  ASSERT_TRUE(WriteSecretFile(path, "# stage left\n# until noon\n" + ToText(token) + "\n").ok());
  const auto loaded = LoadToken(path);
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  EXPECT_EQ(loaded->bytes, token.bytes);
  std::filesystem::permissions(path, std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(LoadToken(path).status().todo(), "run: chmod 600 " + path.string());
  ASSERT_TRUE(WriteSecretFile(path, "# nothing").ok());
  EXPECT_EQ(LoadToken(path).status().where(), path.string());
}

}  // namespace
}  // namespace furrow::protocol::secure
