// SPDX-License-Identifier: Apache-2.0
#include "character/picture.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "character/asset_path.h"

namespace furrow::character {
namespace {

constexpr std::size_t kMaxEncodedBytes = 256u << 20;

// The name that tells OpenImageIO which decoder to take; empty for what we do not read.
std::string_view FormatOf(std::span<const std::uint8_t> bytes) {
  const auto starts_with = [&](std::initializer_list<std::uint8_t> magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
  };
  if (starts_with({0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a})) return "png";
  if (starts_with({0xff, 0xd8, 0xff})) return "jpeg";
  return {};
}

Status CheckSize(const OIIO::ImageSpec& spec) {
  const std::int64_t pixels = static_cast<std::int64_t>(spec.width) * spec.height;
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1) {
    return {StatusCode::kParse, "the picture has no extent"};
  }
  if (spec.width > kMaxPictureSide || spec.height > kMaxPictureSide || pixels > kMaxPicturePixels) {
    return {StatusCode::kLimit, "the picture has " + std::to_string(spec.width) + " x " +
                                    std::to_string(spec.height) + " pixels, too many to read"};
  }
  if (spec.nchannels < 1 || spec.nchannels > 4) {
    return {StatusCode::kUnsupported,
            "the picture has " + std::to_string(spec.nchannels) + " channels, 1 to 4 are read"};
  }
  return {};
}

std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

Result<Picture> DecodePicture(std::string name, std::span<const std::uint8_t> bytes) {
  const std::string_view format = FormatOf(bytes);
  if (format.empty()) {
    return Status(StatusCode::kUnsupported, "the picture is neither PNG nor JPEG");
  }
  OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec config;
  OIIO::ImageSpec spec;
  config["oiio:UnassociatedAlpha"] = 1;  // a mask's alpha is a channel like the others
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  const auto input = OIIO::ImageInput::create(std::string(format));
  if (input == nullptr || !input->open(std::string(format), spec, config)) {
    return Status(StatusCode::kParse,
                  "the picture is damaged: " +
                      OneLine(input == nullptr ? OIIO::geterror() : input->geterror()));
  }
  if (Status status = CheckSize(spec); !status.ok()) return status;

  Picture picture;
  picture.name = std::move(name);
  picture.width = spec.width;
  picture.height = spec.height;
  picture.channels = spec.nchannels;
  const auto values = static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels;
  const bool wide = spec.format.size() > 1;
  void* pixels = nullptr;
  if (wide) {
    picture.pixels16.resize(values);
    pixels = picture.pixels16.data();
  } else {
    picture.pixels.resize(values);
    pixels = picture.pixels.data();
  }
  const OIIO::TypeDesc type = wide ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
  if (!input->read_image(0, 0, 0, spec.nchannels, type, pixels)) {
    return Status(StatusCode::kParse, "the picture is damaged: " + OneLine(input->geterror()));
  }
  return picture;
}

Result<Picture> LoadPicture(std::string name, const std::filesystem::path& path) {
  const Result<std::string> bytes = ReadFile(path, kMaxEncodedBytes);
  if (!bytes.ok()) return bytes.status();
  Result<Picture> picture =
      DecodePicture(std::move(name),
                    std::span(reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()));
  if (!picture.ok()) return picture.status().At(path.string());
  return picture;
}

Result<std::string> EncodePng(const Picture& picture) {
  const bool wide = !picture.pixels16.empty();
  const std::size_t values = wide ? picture.pixels16.size() : picture.pixels.size();
  const bool fits = picture.width > 0 && picture.height > 0 && picture.channels >= 1 &&
                    picture.channels <= 4 &&
                    values == static_cast<std::size_t>(picture.width) * picture.height *
                                  static_cast<std::size_t>(picture.channels);
  if (!fits) {
    return Status(StatusCode::kInvalidArgument,
                  "the pixels of picture '" + picture.name + "' do not fit its size");
  }
  const OIIO::TypeDesc type = wide ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type);
  spec["oiio:UnassociatedAlpha"] = 1;
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("picture.png", &memory);
  const void* pixels = wide ? static_cast<const void*>(picture.pixels16.data())
                            : static_cast<const void*>(picture.pixels.data());
  if (output == nullptr || !output->open("picture.png", spec) ||
      !output->write_image(type, pixels) || !output->close()) {
    return Status(StatusCode::kInternal,
                  "cannot encode picture '" + picture.name +
                      "': " + OneLine(output == nullptr ? OIIO::geterror() : output->geterror()));
  }
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace furrow::character
