// SPDX-License-Identifier: Apache-2.0
#include "gltf/container/uri.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/temporary_folder.h"

namespace furrow::gltf {
namespace {

std::string Decode(const std::string& uri) {
  const Result<std::vector<std::uint8_t>> bytes = DecodeDataUri(uri);
  if (!bytes.ok()) return bytes.status().ToString();
  return {bytes->begin(), bytes->end()};
}

// The vectors of RFC 4648, section 10.
TEST(DecodeDataUri, ReadsBase64OfAnyMediaType) {
  EXPECT_EQ(Decode("data:application/octet-stream;base64,"), "");
  EXPECT_EQ(Decode("data:image/webp;base64,Zg=="), "f");
  EXPECT_EQ(Decode("data:;base64,Zm8="), "fo");
  EXPECT_EQ(Decode("data:text/plain;charset=utf-8;base64,Zm9v"), "foo");
  EXPECT_EQ(Decode("data:;base64,Zm9vYmFy"), "foobar");
  EXPECT_EQ(Decode("data:;base64,Zm9vYg"), "foob");  // padding is optional
  EXPECT_EQ(Decode("data:;base64,/+/+"), "\xff\xef\xfe");
}

TEST(DecodeDataUri, RejectsEverythingElse) {
  for (const char* uri :
       {"", "data:", "data:,plain", "file.bin", "data:;base64,Z",
        "data:;base64,Z!==", "data:;base64,Zg===", "data:;base64,Z g=", "http://a/;base64,Zg=="}) {
    EXPECT_EQ(DecodeDataUri(uri).status().code(), StatusCode::kParse) << uri;
  }
}

TEST(FindExternalFile, DecodesPercentEscapes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "my model.bin", "x").ok());
  EXPECT_EQ(*FindExternalFile("my%20model.bin", folder.path()), folder / "my model.bin");
  EXPECT_EQ(*FindExternalFile("my model.bin", folder.path()), folder / "my model.bin");
}

TEST(FindExternalFile, StaysInsideItsFolders) {
  const TemporaryFolder folder;
  for (const char* uri : {"../a", "%2e%2e/a", "/etc/hostname", "%2Fetc/hostname", "", "http://a/b",
                          "a%5Cb", "a%00", "%", "%4", "%zz"}) {
    EXPECT_EQ(FindExternalFile(uri, folder.path()).status().code(), StatusCode::kInvalidArgument)
        << uri;
  }
  EXPECT_EQ(FindExternalFile("a", folder.path()).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(FindExternalFile("a", std::nullopt).status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace furrow::gltf
