// SPDX-License-Identifier: Apache-2.0
#include "render/request/image_codec.h"

#include <memory>
#include <string>

#include <turbojpeg.h>

#include "base/status.h"
#include "character/pictures/picture_file.h"

namespace furrow::render {
namespace {

Result<std::vector<std::uint8_t>> EncodeJpeg(const Image& image, int quality) {
  struct Close {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Close> compressor(tjInitCompress());
  // Chroma at half the resolution makes smaller files, but its colour fringes would show at high
  // quality.
  const int subsampling = quality < 90 ? TJSAMP_420 : TJSAMP_444;
  // The largest possible size, so that TurboJPEG never reallocates a buffer that it does not own.
  std::vector<std::uint8_t> bytes(tjBufSize(image.width, image.height, subsampling));
  unsigned char* data = bytes.data();
  unsigned long size = bytes.size();
  if (tjCompress2(compressor.get(), image.rgb.data(), image.width, 0, image.height, TJPF_RGB, &data,
                  &size, subsampling, quality, TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0) {
    return Status(StatusCode::kInternal, tjGetErrorStr2(compressor.get()), "TurboJPEG");
  }
  bytes.resize(size);
  return bytes;
}

Result<std::vector<std::uint8_t>> EncodePng(const Image& image) {
  character::Picture picture;
  picture.name = "PNG";
  picture.width = image.width;
  picture.height = image.height;
  picture.channels = 3;
  picture.pixels = image.rgb;
  // Takes half the time of the library's default level and adds a few percent to the size.
  const auto bytes = character::EncodePicture(picture, {.srgb = true, .compression = 4});
  FURROW_RETURN_IF_ERROR(bytes);
  return std::vector<std::uint8_t>(bytes->begin(), bytes->end());
}

}  // namespace

Result<std::vector<std::uint8_t>> EncodeImage(const Image& image, ImageFormat format, int quality) {
  const std::size_t bytes = static_cast<std::size_t>(image.width) * image.height * 3;
  if (image.width < 1 || image.height < 1 || image.rgb.size() != bytes) {
    return Status(StatusCode::kInvalidArgument,
                  std::to_string(image.rgb.size()) + " bytes of pixels do not match the size of " +
                      std::to_string(image.width) + " x " + std::to_string(image.height),
                  "image");
  }
  if (format == ImageFormat::kPng) return EncodePng(image);
  if (quality < 1 || quality > 100) {
    return Status(StatusCode::kInvalidArgument, std::to_string(quality) + " is outside [1, 100]",
                  "quality");
  }
  return EncodeJpeg(image, quality);
}

}  // namespace furrow::render
