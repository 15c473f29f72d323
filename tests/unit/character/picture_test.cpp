// SPDX-License-Identifier: Apache-2.0
#include "character/picture.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::character {
namespace {

std::span<const std::uint8_t> Bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(Picture, ReadsBackEveryNumberOfChannels) {
  for (int channels = 1; channels <= 4; ++channels) {
    Picture picture;
    picture.width = 3;
    picture.height = 2;
    picture.channels = channels;
    for (int i = 0; i < 6 * channels; ++i)
      picture.pixels.push_back(static_cast<std::uint8_t>(i * 9));
    const auto png = EncodePng(picture);
    ASSERT_TRUE(png.ok()) << png.status().ToString();
    const auto again = DecodePicture("p", Bytes(*png));
    ASSERT_TRUE(again.ok()) << again.status().ToString();
    EXPECT_EQ(again->channels, channels);
    EXPECT_EQ(again->pixels, picture.pixels) << channels;
    EXPECT_TRUE(again->pixels16.empty());
  }
}

TEST(Picture, KeepsSixteenBits) {
  Picture picture;
  picture.width = 2;
  picture.height = 1;
  picture.channels = 3;
  picture.pixels16 = {0, 1, 65535, 32768, 257, 4660};
  const auto again = DecodePicture("p", Bytes(*EncodePng(picture)));
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->pixels16, picture.pixels16);
  EXPECT_TRUE(again->pixels.empty());
}

TEST(Picture, RefusesEveryTruncation) {
  Picture picture;
  picture.width = 4;
  picture.height = 4;
  picture.pixels.assign(64, 77);
  const std::string png = *EncodePng(picture);
  // The last 12 bytes are the end chunk, which says nothing about pixels.
  for (std::size_t length = 0; length + 16 < png.size(); ++length) {
    const std::string part(png.data(), length);
    EXPECT_FALSE(DecodePicture("p", Bytes(part)).ok()) << length;
  }
}

TEST(Picture, RefusesWhatIsTooLargeBeforeReadingIt) {
  Picture picture;
  picture.width = 1;
  picture.height = 1;
  picture.pixels.assign(4, 0);
  std::string png = *EncodePng(picture);
  // The header's width and height: 0x7fff each. Its checksum is wrong then, which is as well.
  png.replace(16, 8, std::string("\0\0\x7f\xff\0\0\x7f\xff", 8));
  const auto result = DecodePicture("p", Bytes(png));
  ASSERT_FALSE(result.ok());
  EXPECT_TRUE(result.status().code() == StatusCode::kLimit ||
              result.status().code() == StatusCode::kParse);
  EXPECT_EQ(DecodePicture("p", Bytes("GIF89a")).status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace furrow::character
