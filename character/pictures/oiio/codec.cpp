// SPDX-License-Identifier: Apache-2.0
// The picture codec: a module on top of OpenImageIO.
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "character/pictures/oiio/file_claims.h"
#include "character/pictures/picture_codec.h"

namespace furrow::character {
namespace {

// A file name that selects OpenImageIO's decoder; empty for formats that Furrow does not read.
std::string_view FormatOf(std::span<const std::uint8_t> bytes) {
  const auto starts_with = [&](std::initializer_list<std::uint8_t> magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
  };
  if (starts_with({0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a})) return "png";
  if (starts_with({0xff, 0xd8, 0xff})) return "jpeg";
  if (starts_with({0x76, 0x2f, 0x31, 0x01})) return "openexr";
  constexpr std::string_view kWebp = "WEBP";
  if (starts_with({'R', 'I', 'F', 'F'}) && bytes.size() >= 12 &&
      std::equal(kWebp.begin(), kWebp.end(), bytes.begin() + 8)) {
    return "webp";
  }
  return {};
}

StatusCode CheckSize(const OIIO::ImageSpec& spec, std::string* why) {
  const std::int64_t pixels = static_cast<std::int64_t>(spec.width) * spec.height;
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1) {
    *why = "the picture is empty";
    return StatusCode::kParse;
  }
  if (spec.width > kMaxPictureSide || spec.height > kMaxPictureSide || pixels > kMaxPicturePixels) {
    *why = "the picture has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
           " pixels, which exceeds the limit";
    return StatusCode::kLimit;
  }
  if (spec.nchannels < 1 || spec.nchannels > 4) {
    *why = "the picture has " + std::to_string(spec.nchannels) + " channels; 1 to 4 are supported";
    return StatusCode::kUnsupported;
  }
  return StatusCode::kOk;
}

std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

struct Pixels {
  OIIO::TypeDesc type;
  void* data = nullptr;
};

// Allocates `values` pixels in the list that keeps the file's full precision.
Pixels Allocate(const OIIO::TypeDesc& format, std::size_t values, Picture* picture) {
  if (format.is_floating_point()) {
    picture->pixels_float.resize(values);
    return {OIIO::TypeDesc::FLOAT, picture->pixels_float.data()};
  }
  if (format.size() > 1) {
    picture->pixels16.resize(values);
    return {OIIO::TypeDesc::UINT16, picture->pixels16.data()};
  }
  picture->pixels.resize(values);
  return {OIIO::TypeDesc::UINT8, picture->pixels.data()};
}

// The type of a picture's pixels.
std::pair<OIIO::TypeDesc, const void*> Held(const Picture& picture) {
  if (!picture.pixels_float.empty()) {
    return {OIIO::TypeDesc::FLOAT, picture.pixels_float.data()};
  }
  if (!picture.pixels16.empty()) {
    return {OIIO::TypeDesc::UINT16, picture.pixels16.data()};
  }
  return {OIIO::TypeDesc::UINT8, picture.pixels.data()};
}

OIIO::TypeDesc TypeOf(PictureStorage::Type type) {
  switch (type) {
    case PictureStorage::Type::kU8: return OIIO::TypeDesc::UINT8;
    case PictureStorage::Type::kU16: return OIIO::TypeDesc::UINT16;
    case PictureStorage::Type::kHalf: return OIIO::TypeDesc::HALF;
  }
  return OIIO::TypeDesc::UNKNOWN;
}

StatusCode Decode(std::span<const std::uint8_t> bytes, Picture* picture, std::string* why) {
  const std::string format(FormatOf(bytes));
  if (format.empty()) {
    *why = "the picture is not a PNG, JPEG, WebP or OpenEXR file";
    return StatusCode::kUnsupported;
  }
  if (format == "openexr" && !ExrHeadersFit(bytes)) {
    *why = "the picture is damaged: its header does not end";
    return StatusCode::kParse;
  }
  // The reader never writes; its interface lacks const.
  OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec config;
  OIIO::ImageSpec spec;
  config["oiio:UnassociatedAlpha"] = 1;  // keep a mask's alpha as an ordinary channel
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  const auto input = OIIO::ImageInput::create(format);
  if (input == nullptr || !input->open(format, spec, config)) {
    *why = "the picture is damaged: " +
           OneLine(input == nullptr ? OIIO::geterror() : input->geterror());
    return StatusCode::kParse;
  }
  // After the header and before the pixels, so that a small file cannot claim a huge picture.
  if (const StatusCode code = CheckSize(spec, why); code != StatusCode::kOk) return code;
  if (format == "png" && !PngPixelsFit(bytes)) {
    *why = "the picture is damaged: the file is too short for its pixels";
    return StatusCode::kParse;
  }
  picture->width = spec.width;
  picture->height = spec.height;
  picture->channels = spec.nchannels;
  const auto values = static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels;
  const Pixels pixels = Allocate(spec.format, values, picture);
  if (!input->read_image(0, 0, 0, spec.nchannels, pixels.type, pixels.data)) {
    *why = "the picture is damaged: " + OneLine(input->geterror());
    return StatusCode::kParse;
  }
  return StatusCode::kOk;
}

StatusCode Encode(const Picture& picture, const PictureStorage& storage, std::string* bytes,
                  std::string* why) {
  // The extension selects the format.
  const std::string file =
      storage.format == PictureStorage::Format::kExr ? "picture.exr" : "picture.png";
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, TypeOf(storage.type));
  spec["oiio:UnassociatedAlpha"] = 1;
  if (storage.srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (storage.compression > 0) spec.attribute("png:compressionLevel", storage.compression);
  std::vector<unsigned char> buffer;
  OIIO::Filesystem::IOVecOutput memory(buffer);
  const auto output = OIIO::ImageOutput::create(file, &memory);
  const auto [type, pixels] = Held(picture);
  if (output == nullptr || !output->open(file, spec) || !output->write_image(type, pixels) ||
      !output->close()) {
    *why = OneLine(output == nullptr ? OIIO::geterror() : output->geterror());
    return StatusCode::kInternal;
  }
  bytes->assign(buffer.begin(), buffer.end());
  return StatusCode::kOk;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const PictureCodec* FurrowPictureCodec() {
  static constexpr PictureCodec kCodec = {.decode = Decode, .encode = Encode};
  return &kCodec;
}

}  // namespace furrow::character
