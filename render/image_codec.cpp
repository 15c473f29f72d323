// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <turbojpeg.h>

#include "render/renderer.h"

namespace furrow::render {
namespace {

Result<std::vector<std::uint8_t>> EncodeJpeg(const Image& image, int quality) {
  struct Close {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Close> compressor(tjInitCompress());
  const int subsampling = quality < 90 ? TJSAMP_420 : TJSAMP_444;
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
  std::vector<std::uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("picture.png");
  const auto failure = [&] {
    return Status(StatusCode::kInternal, output ? output->geterror() : OIIO::geterror(), "PNG");
  };
  if (!output || !output->set_ioproxy(&memory)) return failure();
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel",
                 4);  // half the time of the default for a few percent of size
  if (!output->open("picture.png", spec)) return failure();
  if (!output->write_image(OIIO::TypeDesc::UINT8, image.rgb.data())) return failure();
  if (!output->close()) return failure();
  return bytes;
}

}  // namespace

Result<std::vector<std::uint8_t>> EncodeImage(const Image& image, ImageFormat format, int quality) {
  const std::size_t bytes = static_cast<std::size_t>(image.width) * image.height * 3;
  if (image.width < 1 || image.height < 1 || image.rgb.size() != bytes) {
    return Status(StatusCode::kInvalidArgument, "its pixels do not fit its size", "image");
  }
  if (format == ImageFormat::kPng) return EncodePng(image);
  if (quality < 1 || quality > 100) {
    return Status(StatusCode::kInvalidArgument, std::to_string(quality) + " is outside [1, 100]",
                  "quality");
  }
  return EncodeJpeg(image, quality);
}

}  // namespace furrow::render
