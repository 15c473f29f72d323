// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/npz.h"

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/import/makehuman/formats/mhtarget.h"
#include "base/files.h"

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;

// An archive that NumPy and Python's zipfile wrote; see make_targets_npz.py.
std::string Packed() {
  const auto bytes = ReadFile(FURROW_SOURCE_DIR "/tests/fuzz/seeds/npz/targets.npz", 1 << 20);
  EXPECT_TRUE(bytes.ok()) << bytes.status().ToString();
  return *bytes;
}

// Opens an archive and reads all of its entries. Returns the number that can be read.
std::size_t ReadAll(std::string bytes) {
  const Result<NpzArchive> archive = NpzArchive::Open(std::move(bytes), "a.npz");
  if (!archive.ok()) return 0;
  std::size_t read = 0;
  archive->ForEachName([&](const std::string& name) { read += archive->Read(name).ok(); });
  return read;
}

// The position of an entry's header in the table of contents.
std::size_t HeaderOf(const std::string& bytes, const std::string& name) {
  const std::size_t at = bytes.rfind(name);
  EXPECT_NE(at, std::string::npos);
  return at - 46;
}

void Put(std::uint32_t value, std::size_t at, std::string* bytes) {
  for (std::size_t i = 0; i < 4; ++i) (*bytes)[at + i] = static_cast<char>(value >> 8 * i & 0xff);
}

TEST(NpzArchive, ReadsWhatNumPyWrote) {
  const Result<NpzArchive> archive = NpzArchive::Open(Packed(), "a.npz");
  ASSERT_TRUE(archive.ok()) << archive.status().ToString();
  std::vector<std::string> names;
  archive->ForEachName([&](const std::string& name) { names.push_back(name); });
  EXPECT_THAT(names,
              ElementsAre("targets/head/head-oval.index.npy", "targets/head/head-oval.vector.npy",
                          "targets/nose/nose-hump-incr.index.npy",
                          "targets/nose/nose-hump-incr.vector.npy", "targets/targets.license.npy"));
  const auto index = archive->Read("targets/nose/nose-hump-incr.index.npy");
  const auto vector = archive->Read("targets/nose/nose-hump-incr.vector.npy");
  ASSERT_TRUE(index.ok() && vector.ok());
  const Result<MhTarget> target = ParseMhTargetArrays(*index, *vector, "a", 4);
  ASSERT_TRUE(target.ok()) << target.status().ToString();
  EXPECT_THAT(target->vertices, ElementsAre(0u, 3u));
  ASSERT_EQ(target->offsets.size(), 2u);
  EXPECT_EQ(target->offsets[0], 1e-3f * glm::vec3(1000.0f, -250.0f, 0.0f));
  EXPECT_EQ(target->offsets[1], 1e-3f * glm::vec3(0.0f, 0.0f, -32000.0f));  // 0.0005 rounds to even
  const auto none = archive->Read("targets/head/head-oval.index.npy");
  const auto nothing = archive->Read("targets/head/head-oval.vector.npy");
  const Result<MhTarget> empty = ParseMhTargetArrays(*none, *nothing, "a", 4);
  ASSERT_TRUE(empty.ok()) << empty.status().ToString();
  EXPECT_TRUE(empty->vertices.empty());
}

TEST(NpzArchive, NamesWhatIsWrong) {
  EXPECT_EQ(NpzArchive::Open("", "a").status().code(), StatusCode::kParse);
  EXPECT_EQ(NpzArchive::Open("PK", "a").status().code(), StatusCode::kParse);
  const Result<NpzArchive> archive = NpzArchive::Open(Packed(), "a.npz");
  ASSERT_TRUE(archive.ok());
  const Status absent = archive->Read("targets/x.index.npy").status();
  EXPECT_EQ(absent.code(), StatusCode::kNotFound);
  EXPECT_EQ(absent.where(), "a.npz: targets/x.index.npy");
}

// What an entry of the table of contents claims is not believed.
TEST(NpzArchive, RejectsEntriesThatLie) {
  const std::string name = "targets/nose/nose-hump-incr.vector.npy";
  const auto read = [&](std::size_t field, std::uint32_t value) {
    std::string bytes = Packed();
    Put(value, HeaderOf(bytes, name) + field, &bytes);
    const Result<NpzArchive> archive = NpzArchive::Open(std::move(bytes), "a.npz");
    return archive.ok() ? archive->Read(name).status().code() : archive.status().code();
  };
  const std::string bytes = Packed();
  std::uint32_t method = 0;
  std::memcpy(&method, bytes.data() + HeaderOf(bytes, name) + 8, 4);  // flags, method
  EXPECT_EQ(read(8, method), StatusCode::kOk);
  EXPECT_EQ(read(8, method | 1), StatusCode::kUnsupported);
  EXPECT_EQ(read(8, 12u << 16), StatusCode::kUnsupported);  // bzip2
  EXPECT_EQ(read(16, 12345), StatusCode::kParse);           // checksum
  EXPECT_EQ(read(20, 5), StatusCode::kParse);               // compressed size
  EXPECT_EQ(read(24, 0x7fffffff), StatusCode::kLimit);      // size
  EXPECT_EQ(read(24, 7'000'000), StatusCode::kParse);
  EXPECT_EQ(read(42, 0x00ffffff), StatusCode::kParse);  // place of the data
}

TEST(NpzArchive, SurvivesEveryTruncation) {
  const std::string bytes = Packed();
  ASSERT_EQ(ReadAll(bytes), 5u);
  constexpr std::size_t kZeros = 3;  // at the end; minizip takes missing bytes as zeros
  for (std::size_t length = 0; length + kZeros < bytes.size(); ++length) {
    EXPECT_LT(ReadAll(bytes.substr(0, length)), 5u) << length;
  }
}

TEST(NpzArchive, SurvivesDamage) {
  const std::string bytes = Packed();
  std::mt19937 random(7);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    EXPECT_LE(ReadAll(std::move(damaged)), 5u);
  }
}

}  // namespace
}  // namespace furrow::authoring
