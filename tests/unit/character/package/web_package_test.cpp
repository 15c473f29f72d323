// SPDX-License-Identifier: Apache-2.0
#include "character/package/web_package.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace furrow::character {
namespace {

using ::testing::HasSubstr;

namespace fs = std::filesystem;

std::string LittleEndian(std::size_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

std::string Glb(std::string text) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return "glTF" + LittleEndian(2) + LittleEndian(20 + text.size()) + LittleEndian(text.size()) +
         "JSON" + text;
}

std::string Stated(const std::string& content) {
  return R"({"bytes":)" + std::to_string(content.size()) + R"(,"fnv1a":)" +
         std::to_string(Checksum(content)) + "}";
}

class WebPackageTest : public testing::Test {
 protected:
  void Write(const char* name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  void WriteSource(const std::string& source) {
    Write("ada.web.glb", Glb(R"({"asset":{"version":"2.0"},"scenes":[{"extras":{)" + source +
                             R"("furrow_rig":{}}}]})"));
  }
  Status Check() { return CheckWebPackage(WebPackageBeside(glb_), glb_); }

  const TemporaryFolder folder_;
  const fs::path glb_ = folder_ / "ada.glb";
};

TEST_F(WebPackageTest, BelongsToItsCharacterAndRigAsTheyAre) {
  Write("ada.glb", "a character");
  Write("ada.rig.json", "a rig");
  const std::string source = R"("furrow_source":{"character":)" + Stated("a character") +
                             R"(,"rig":)" + Stated("a rig") + "},";
  WriteSource(source);
  EXPECT_TRUE(Check().ok()) << Check().ToString();

  Write("ada.rig.json", "a rjg");  // the same size
  EXPECT_EQ(Check().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(Check().ToString(), HasSubstr("another version of ada.rig.json"));
  EXPECT_THAT(Check().ToString(), HasSubstr("pack_character.mjs"));

  Write("ada.rig.json", "a rig");
  Write("ada.glb", "a longer character");
  EXPECT_THAT(Check().ToString(), HasSubstr("another version of ada.glb"));
}

TEST_F(WebPackageTest, RejectsDamagedPackages) {
  Write("ada.glb", "a character");
  Write("ada.rig.json", "a rig");
  EXPECT_FALSE(Check().ok()) << "missing";
  for (const char* source : {"", R"("furrow_source":null,)"}) {
    WriteSource(source);
    EXPECT_EQ(Check().code(), StatusCode::kSchema) << source;
  }
  for (const char* source :
       {R"("furrow_source":7,)", R"("furrow_source":{"character":[],"rig":{"bytes":-1}},)",
        R"("furrow_source":{"character":{"bytes":11,"fnv1a":"x"}},)"}) {
    WriteSource(source);
    EXPECT_EQ(Check().code(), StatusCode::kInvalidArgument) << source;
  }
  for (const std::string& text : {std::string("["), std::string("{\"scenes\":[")}) {
    Write("ada.web.glb", Glb(text));
    EXPECT_EQ(Check().code(), StatusCode::kParse) << text;
  }
  Write("ada.web.glb", Glb("7"));
  EXPECT_FALSE(Check().ok());
  Write("ada.web.glb", std::string(kMaxWebPackageBytes + 1, ' '));
  EXPECT_EQ(Check().code(), StatusCode::kLimit);
}

// The values of the reference implementation (RFC 9923, appendix C).
TEST(Checksum, IsFnv1a) {
  EXPECT_EQ(Checksum(""), 0x811c9dc5u);
  EXPECT_EQ(Checksum("a"), 0xe40c292cu);
  EXPECT_EQ(Checksum("foobar"), 0xbf9cf968u);
}

}  // namespace
}  // namespace furrow::character
