// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include "render/renderer.h"

namespace furrow::render {
namespace {

Image Gradient() {
  Image image{48, 32, {}, 5};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.rgb.push_back(static_cast<std::uint8_t>(5 * x));
      image.rgb.push_back(static_cast<std::uint8_t>(7 * y));
      image.rgb.push_back(static_cast<std::uint8_t>(128));
    }
  }
  return image;
}

TEST(EncodeImage, PngIsLossless) {
  const Image image = Gradient();
  auto bytes = EncodeImage(image, ImageFormat::kPng);
  ASSERT_TRUE(bytes.ok()) << bytes.status().ToString();
  OIIO::Filesystem::IOMemReader memory(bytes->data(), bytes->size());
  const auto input = OIIO::ImageInput::open("picture.png", nullptr, &memory);
  ASSERT_NE(input, nullptr) << OIIO::geterror();
  EXPECT_EQ(input->spec().width, image.width);
  EXPECT_EQ(input->spec().height, image.height);
  ASSERT_EQ(input->spec().nchannels, 3);
  std::vector<std::uint8_t> pixels(image.rgb.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  EXPECT_EQ(pixels, image.rgb);
}

// Decodes a JPEG. Returns the chroma subsampling and the largest error of a component.
std::pair<int, int> DecodeJpeg(const std::vector<std::uint8_t>& bytes, const Image& image) {
  const tjhandle decoder = tjInitDecompress();
  int width = 0;
  int height = 0;
  int subsampling = -1;
  int colour_space = 0;
  tjDecompressHeader3(decoder, bytes.data(), bytes.size(), &width, &height, &subsampling,
                      &colour_space);
  EXPECT_EQ(width, image.width);
  EXPECT_EQ(height, image.height);
  std::vector<std::uint8_t> pixels(image.rgb.size());
  tjDecompress2(decoder, bytes.data(), bytes.size(), pixels.data(), width, 0, height, TJPF_RGB, 0);
  tjDestroy(decoder);
  int worst = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    worst = std::max(worst, std::abs(pixels[i] - image.rgb[i]));
  }
  return {subsampling, worst};
}

TEST(EncodeImage, JpegIsCloseAndSubsamplesBelow90) {
  const Image image = Gradient();
  const auto low = EncodeImage(image, ImageFormat::kJpeg, 85);
  const auto high = EncodeImage(image, ImageFormat::kJpeg, 95);
  ASSERT_TRUE(low.ok() && high.ok());
  const auto [low_sampling, low_error] = DecodeJpeg(*low, image);
  const auto [high_sampling, high_error] = DecodeJpeg(*high, image);
  EXPECT_EQ(low_sampling, TJSAMP_420);
  EXPECT_EQ(high_sampling, TJSAMP_444);
  EXPECT_LE(low_error, 16);
  EXPECT_LE(high_error, 6);
  EXPECT_LT(low->size(), high->size());
}

TEST(EncodeImage, RejectsInvalidImagesAndQualities) {
  EXPECT_EQ(EncodeImage(Image{}, ImageFormat::kPng).status().where(), "image");
  EXPECT_EQ(EncodeImage(Image{4, 4, std::vector<std::uint8_t>(47), 0}, ImageFormat::kPng)
                .status()
                .where(),
            "image");
  for (const int quality : {0, 101, -5}) {
    const Status status = EncodeImage(Gradient(), ImageFormat::kJpeg, quality).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.where(), "quality");
  }
}

}  // namespace
}  // namespace furrow::render
