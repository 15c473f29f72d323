// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/key_ring.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/temporary_folder.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::kUnixNow;

const std::string kHead = "furrow-keys 1\n";
const std::string kLine =
    "key 7f3a0c21 created 2026-05-14T09:30:00Z expires 2027-05-14T09:30:00Z "
    "AAECAwQFBgcICQoLDA0ODxAREhMUFRYXGBkaGxwdHh8\n";

TEST(KeyRing, NewTokensUseTheNewestValidKey) {
  test::RepeatableRandom random;
  KeyRing ring;
  EXPECT_EQ(ring.Newest(kUnixNow), nullptr);
  const std::uint32_t first = *ring.AddNew(kUnixNow, kUnixNow + 100, random);
  const std::uint32_t second = *ring.AddNew(kUnixNow + 10, kUnixNow + 50, random);
  EXPECT_EQ(ring.Newest(kUnixNow + 20)->id, second);
  EXPECT_EQ(ring.Newest(kUnixNow + 49)->id, second);
  EXPECT_EQ(ring.Newest(kUnixNow + 50)->id, first);  // the second has expired
  EXPECT_EQ(ring.Newest(kUnixNow + 100), nullptr);
  EXPECT_EQ(ring.Find(first)->expires, kUnixNow + 100);
  EXPECT_TRUE(ring.Remove(first));
  EXPECT_FALSE(ring.Remove(first));
  EXPECT_EQ(ring.Find(first), nullptr);
  EXPECT_EQ(ring.keys().size(), 1u);
}

TEST(KeyRing, TextRoundTrips) {
  test::RepeatableRandom random;
  KeyRing ring;
  for (int i = 0; i < 3; ++i) {
    (void)ring.AddNew(kUnixNow + static_cast<std::uint64_t>(i), kUnixNow + 1'000, random);
  }
  const auto again = KeyRing::Parse(ring.ToText(), "keys");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->ToText(), ring.ToText());
  EXPECT_EQ(test::ToHex(again->keys()[2].key), test::ToHex(ring.keys()[2].key));
}

TEST(KeyRing, ReadsCommentsAndBothLineEnds) {
  const auto ring = KeyRing::Parse("furrow-keys 1\r\n\r\n# a comment\r\n" + kLine, "keys");
  ASSERT_TRUE(ring.ok()) << ring.status().ToString();
  ASSERT_EQ(ring->keys().size(), 1u);
  EXPECT_EQ(ring->keys()[0].id, 0x7f3a0c21u);
  EXPECT_EQ(test::ToHex(ring->keys()[0].key).substr(0, 8), "00010203");
}

TEST(KeyRing, NamesFileAndLineOfAFault) {
  const auto fault = [](const std::string& text) { return KeyRing::Parse(text, "keys").status(); };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string line = kLine;
    line.replace(line.find(from), from.size(), to);
    return fault(kHead + line);
  };
  EXPECT_EQ(fault("").what(), "the file is empty");
  EXPECT_EQ(fault("frw1_...").ToString(),
            "keys:1: not a key file: it must begin with 'furrow-keys 1' (make one with "
            "'furrow token key new')");
  EXPECT_EQ(fault("furrow-keys 2\n").where(), "keys:1");
  EXPECT_EQ(fault(kHead + kLine + kLine).ToString(), "keys:3: a second key 7f3a0c21");
  EXPECT_EQ(changed("key", "Key").where(), "keys:2");
  EXPECT_EQ(changed("7f3a0c21", "7f3a0c21f").what(),
            "'7f3a0c21f' is not an id of 1 to 8 hexadecimal digits");
  EXPECT_EQ(changed("2026-05-14T", "2026-15-14T").what(),
            "'2026-15-14T09:30:00Z' is not a time such as 2026-05-14T09:30:00Z");
  EXPECT_EQ(changed("Hh8", "Hh").what(), "the key is not base64url of 32 bytes");
  EXPECT_EQ(changed("Hh8", "Hh9").what(), "the key is not base64url of 32 bytes");
  std::string many = kHead;
  for (int i = 0; i < 65; ++i) {
    std::string line = kLine;
    many += line.replace(4, 8, KeyIdText(static_cast<std::uint32_t>(i + 1)));
  }
  EXPECT_EQ(fault(many).code(), StatusCode::kLimit);
}

TEST(KeyRing, EveryTruncationIsReadOrRefused) {
  const std::string text = kHead + kLine;
  for (std::size_t size = 0; size < text.size() - 1; ++size) {
    const auto ring = KeyRing::Parse(text.substr(0, size), "keys");
    EXPECT_TRUE(!ring.ok() || ring->keys().empty()) << size;
  }
}

TEST(KeyRing, HoldsABoundedNumber) {
  test::RepeatableRandom random;
  KeyRing ring;
  for (std::size_t i = 0; i < KeyRing::kMaxKeys; ++i) {
    ASSERT_TRUE(ring.AddNew(kUnixNow, kUnixNow + 1, random).ok());
  }
  EXPECT_EQ(ring.AddNew(kUnixNow, kUnixNow + 1, random).status().code(), StatusCode::kLimit);
}

TEST(KeyRing, FilesAreForTheirOwnerAlone) {
  TemporaryFolder folder;
  test::RepeatableRandom random;
  const KeyRing ring = test::MakeRing(random);
  const std::filesystem::path path = folder / "keys";
  ASSERT_TRUE(SaveKeyRing(ring, path).ok());
  const auto loaded = LoadKeyRing(path);
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded->ToText(), ring.ToText());
  std::filesystem::permissions(path, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(LoadKeyRing(path).status().todo(), "run: chmod 600 " + path.string());
  EXPECT_EQ(LoadKeyRing(folder / "absent").status().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::protocol::secure
