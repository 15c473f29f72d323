// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture_file.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace furrow::character {
namespace {

std::span<const std::uint8_t> Bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Four red pixels by two, lossless, written by oiiotool.
TEST(Picture, ReadsWebp) {
  const auto picture =
      LoadPicture("four", FURROW_SOURCE_DIR "/tests/unit/character/pictures/four.webp");
  ASSERT_TRUE(picture.ok()) << picture.status().ToString();
  EXPECT_EQ(picture->width, 4);
  EXPECT_EQ(picture->height, 2);
  ASSERT_GE(picture->pixels.size(), 3u);
  EXPECT_NEAR(picture->pixels[0], 255, 3);
  EXPECT_NEAR(picture->pixels[1], 0, 3);
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

TEST(Picture, KeepsHalfFloats) {
  Picture picture;
  picture.width = 2;
  picture.height = 2;
  for (int channels = 1; channels <= 4; ++channels) {
    picture.channels = channels;
    picture.pixels_float.clear();
    for (int i = 0; i < 4 * channels; ++i) {
      picture.pixels_float.push_back(-3.5f + 0.0009765625f * static_cast<float>(i * i));
    }
    picture.pixels_float[0] = 1000.0f;
    const auto exr = EncodeExr(picture);
    ASSERT_TRUE(exr.ok()) << exr.status().ToString();
    const auto again = DecodePicture("p", Bytes(*exr));
    ASSERT_TRUE(again.ok()) << again.status().ToString();
    EXPECT_EQ(again->channels, channels);
    ASSERT_EQ(again->pixels_float.size(), picture.pixels_float.size());
    for (std::size_t i = 0; i < picture.pixels_float.size(); ++i) {
      EXPECT_NEAR(again->pixels_float[i], picture.pixels_float[i],
                  std::abs(picture.pixels_float[i]) / 2048.0f)
          << channels;
    }
    EXPECT_TRUE(again->pixels.empty() && again->pixels16.empty());
  }
  EXPECT_EQ(EncodePng(picture).status().code(), StatusCode::kUnsupported);
}

TEST(Picture, RejectsNonFiniteTexels) {
  Picture picture;
  picture.width = 1;
  picture.height = 1;
  picture.channels = 1;
  picture.pixels_float = {std::numeric_limits<float>::quiet_NaN()};
  const auto again = DecodePicture("p", Bytes(*EncodeExr(picture)));
  EXPECT_EQ(again.status().code(), StatusCode::kNonFinite);
}

TEST(Picture, RejectsEveryTruncationOfAnExr) {
  Picture picture;
  picture.width = 4;
  picture.height = 4;
  picture.channels = 2;
  for (int i = 0; i < 32; ++i) picture.pixels_float.push_back(static_cast<float>(i * 37 % 11));
  const std::string exr = *EncodeExr(picture);
  for (std::size_t length = 0; length < exr.size(); ++length) {
    const std::string part(exr.data(), length);
    EXPECT_FALSE(DecodePicture("p", Bytes(part)).ok()) << length;
  }
}

// OpenEXR would allocate what the attribute states.
TEST(Picture, RejectsAnExrAttributeThatIsLongerThanTheFile) {
  Picture picture;
  picture.width = picture.height = 1;
  picture.channels = 1;
  picture.pixels_float = {0.5f};
  std::string exr = *EncodeExr(picture);
  const std::string name("compression\0compression\0", 24);
  const std::size_t size_field = exr.find(name) + name.size();
  ASSERT_LT(size_field, exr.size());
  exr[size_field + 3] = '\x60';  // 1.5 GiB
  const auto decoded = DecodePicture("p", Bytes(exr));
  ASSERT_FALSE(decoded.ok());
  EXPECT_EQ(decoded.status().code(), StatusCode::kParse);
  EXPECT_NE(decoded.status().ToString().find("its header does not end"), std::string::npos);
}

// 64 Mi pixels would be allocated before the first of them is missed.
TEST(Picture, RejectsAPngThatIsTooShortForItsPixels) {
  Picture picture;
  picture.width = picture.height = 1;
  picture.pixels.assign(4, 0);
  std::string png = *EncodePng(picture);
  // 8192 x 8192, 8 bits, RGBA, and the checksum of this header.
  png.replace(16, 17, std::string("\0\0\x20\0\0\0\x20\0\x08\x06\0\0\0\x72\xaa\xca\x59", 17));
  const auto decoded = DecodePicture("p", Bytes(png));
  ASSERT_FALSE(decoded.ok());
  EXPECT_EQ(decoded.status().code(), StatusCode::kParse);
  EXPECT_NE(decoded.status().ToString().find("too short for its pixels"), std::string::npos);
}

TEST(Picture, ReadsTheFlattestPng) {
  Picture picture;
  picture.width = picture.height = 2048;
  picture.channels = 3;
  picture.pixels.assign(std::size_t{2048} * 2048 * 3, 0);
  const std::string png = *EncodePicture(picture, {.compression = 9});
  EXPECT_LT(png.size(), picture.pixels.size() / 900) << "not flat";
  const auto decoded = DecodePicture("p", Bytes(png));
  ASSERT_TRUE(decoded.ok()) << decoded.status().ToString();
  EXPECT_EQ(decoded->pixels, picture.pixels);
}

TEST(Picture, RejectsEveryTruncation) {
  Picture picture;
  picture.width = 4;
  picture.height = 4;
  picture.pixels.assign(64, 77);
  const std::string png = *EncodePng(picture);
  // The last 12 bytes are the end chunk, which contains no pixels.
  for (std::size_t length = 0; length + 16 < png.size(); ++length) {
    const std::string part(png.data(), length);
    EXPECT_FALSE(DecodePicture("p", Bytes(part)).ok()) << length;
  }
}

TEST(Picture, RejectsHugePicturesBeforeDecoding) {
  Picture picture;
  picture.width = 1;
  picture.height = 1;
  picture.pixels.assign(4, 0);
  std::string png = *EncodePng(picture);
  // Sets width and height in the header to 0x7fff. The wrong checksum is also a valid reason to
  // fail.
  png.replace(16, 8, std::string("\0\0\x7f\xff\0\0\x7f\xff", 8));
  const auto result = DecodePicture("p", Bytes(png));
  ASSERT_FALSE(result.ok());
  EXPECT_TRUE(result.status().code() == StatusCode::kLimit ||
              result.status().code() == StatusCode::kParse);
  EXPECT_EQ(DecodePicture("p", Bytes("GIF89a")).status().code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace furrow::character
