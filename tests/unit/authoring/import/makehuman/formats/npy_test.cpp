// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/npy.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

// A file of version 1 with this header and these values.
std::string Npy(const std::string& header, const std::string& values) {
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8);
  return bytes + header + values;
}

std::string Header(const std::string& type, const std::string& order, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }   \n";
}

TEST(ParseNpy, ReadsSignedAndUnsignedValues) {
  const std::string values("\x01\x00\xff\xff\x00\x80\x34\x12", 8);
  const std::string bytes = Npy(Header("<i2", "False", "(2, 2)"), values);
  const Result<NpyArray> array = ParseNpy(bytes, "a");
  ASSERT_TRUE(array.ok()) << array.status().ToString();
  EXPECT_EQ(array->shape, (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(array->At(0), 1);
  EXPECT_EQ(array->At(1), -1);
  EXPECT_EQ(array->At(2), -32768);
  EXPECT_EQ(array->At(3), 0x1234);
  const std::string unsigned_bytes = Npy(Header("<u2", "False", "(4L,)"), values);
  EXPECT_EQ(ParseNpy(unsigned_bytes, "a")->At(1), 65535);
}

TEST(ParseNpy, ReadsLongHeadersAndEmptyArrays) {
  const std::string header = Header("<u2", "False", "(0,)");
  std::string bytes("\x93NUMPY\x02\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += std::string(3, '\0') + header;
  const Result<NpyArray> array = ParseNpy(bytes, "a");
  ASSERT_TRUE(array.ok()) << array.status().ToString();
  EXPECT_EQ(array->num_values(), 0u);
}

TEST(ParseNpy, RejectsEveryTruncationAndExtraBytes) {
  const std::string bytes = Npy(Header("<i2", "False", "(1, 3)"), "abcdef");
  ASSERT_TRUE(ParseNpy(bytes, "a").ok());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string cut = bytes.substr(0, length);
    EXPECT_FALSE(ParseNpy(cut, "a").ok()) << length;
  }
  EXPECT_EQ(ParseNpy(bytes + "x", "a").status().code(), StatusCode::kParse);
}

TEST(ParseNpy, RejectsFaultyHeaders) {
  const auto code = [](const std::string& header) {
    return ParseNpy(Npy(header, "ab"), "a").status().code();
  };
  ASSERT_EQ(code(Header("<i2", "False", "(1,)")), StatusCode::kOk);
  EXPECT_EQ(code(Header("<f4", "False", "(1,)")), StatusCode::kUnsupported);
  EXPECT_EQ(code(Header("|O", "False", "(1,)")), StatusCode::kUnsupported);
  EXPECT_EQ(code(Header("<i2", "True", "(1, 1)")), StatusCode::kUnsupported);
  EXPECT_EQ(code(Header("<i2", "False", "()")), StatusCode::kUnsupported);
  EXPECT_EQ(code(Header("<i2", "False", "(1, 1, 1)")), StatusCode::kUnsupported);
  EXPECT_EQ(code(Header("<i2", "False", "(2,)")), StatusCode::kParse);
  EXPECT_EQ(code(Header("<i2", "False", "(99999999999999999999999999,)")), StatusCode::kLimit);
  EXPECT_EQ(code(Header("<i2", "False", "(-1,)")), StatusCode::kParse);
  EXPECT_EQ(code(Header("<i2", "None", "(1,)")), StatusCode::kParse);
  for (const char* header : {"", "{}", "{'descr': '<i2'}", "{'shape': (1,), 'descr': '<i2'}",
                             "{'x': 1}", "{'descr': [('a', '<i2')]}", "{'descr' '<i2'}", "{'descr"})
    EXPECT_EQ(code(header), StatusCode::kParse) << header;
  std::string version = Npy(Header("<i2", "False", "(1,)"), "ab");
  version[6] = 4;
  EXPECT_EQ(ParseNpy(version, "a").status().code(), StatusCode::kParse);
}

}  // namespace
}  // namespace furrow::authoring
