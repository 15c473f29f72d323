// SPDX-License-Identifier: Apache-2.0
#include "character/picture.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "character/asset_path.h"
#include "wrinkle/finite.h"

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
  if (starts_with({0x76, 0x2f, 0x31, 0x01})) return "openexr";
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

struct Pixels {
  OIIO::TypeDesc type;
  void* data = nullptr;
};

// Room for `values` of a file's type, in the list that keeps all of their precision.
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

// What a picture holds, and how much of it.
std::pair<OIIO::TypeDesc, const void*> Held(const Picture& picture, std::size_t* values) {
  if (!picture.pixels_float.empty()) {
    *values = picture.pixels_float.size();
    return {OIIO::TypeDesc::FLOAT, picture.pixels_float.data()};
  }
  if (!picture.pixels16.empty()) {
    *values = picture.pixels16.size();
    return {OIIO::TypeDesc::UINT16, picture.pixels16.data()};
  }
  *values = picture.pixels.size();
  return {OIIO::TypeDesc::UINT8, picture.pixels.data()};
}

// `file` names the format by its ending; `stored` is the type in the file.
Result<std::string> Encode(const Picture& picture, const std::string& file,
                           const OIIO::TypeDesc& stored) {
  std::size_t values = 0;
  const auto [type, pixels] = Held(picture, &values);
  const bool fits = picture.width > 0 && picture.height > 0 && picture.channels >= 1 &&
                    picture.channels <= 4 &&
                    values == static_cast<std::size_t>(picture.width) * picture.height *
                                  static_cast<std::size_t>(picture.channels);
  if (!fits) {
    return Status(StatusCode::kInvalidArgument,
                  "the pixels of picture '" + picture.name + "' do not fit its size");
  }
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, stored);
  spec["oiio:UnassociatedAlpha"] = 1;
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(file, &memory);
  if (output == nullptr || !output->open(file, spec) || !output->write_image(type, pixels) ||
      !output->close()) {
    return Status(StatusCode::kInternal,
                  "cannot encode picture '" + picture.name +
                      "': " + OneLine(output == nullptr ? OIIO::geterror() : output->geterror()));
  }
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace

Result<Picture> DecodePicture(std::string name, std::span<const std::uint8_t> bytes) {
  const std::string_view format = FormatOf(bytes);
  if (format.empty()) {
    return Status(StatusCode::kUnsupported, "the picture is none of PNG, JPEG and OpenEXR");
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
  const Pixels pixels = Allocate(spec.format, values, &picture);
  if (!input->read_image(0, 0, 0, spec.nchannels, pixels.type, pixels.data)) {
    return Status(StatusCode::kParse, "the picture is damaged: " + OneLine(input->geterror()));
  }
  if (!wrinkle::AllFinite(picture.pixels_float)) {
    return Status(StatusCode::kNonFinite, "the picture holds texels that are no numbers");
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
  if (!picture.pixels_float.empty()) {
    return Status(StatusCode::kUnsupported,
                  "picture '" + picture.name + "' holds floats, which a PNG cannot");
  }
  return Encode(picture, "picture.png",
                picture.pixels16.empty() ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16);
}

Result<std::string> EncodeExr(const Picture& picture) {
  return Encode(picture, "picture.exr", OIIO::TypeDesc::HALF);
}

float ChannelAt(const Picture& picture, const glm::vec2& uv, int channel) {
  if (channel >= picture.channels) return 0.0f;
  const auto place = [](float t, int size) {
    const float wrapped = t >= 0.0f && t <= 1.0f ? t : t - std::floor(t);
    return std::min(static_cast<int>(wrapped * static_cast<float>(size)), size - 1);
  };
  const std::size_t index = (static_cast<std::size_t>(place(uv.y, picture.height)) *
                                 static_cast<std::size_t>(picture.width) +
                             static_cast<std::size_t>(place(uv.x, picture.width))) *
                                static_cast<std::size_t>(picture.channels) +
                            static_cast<std::size_t>(channel);
  if (!picture.pixels_float.empty()) return std::clamp(picture.pixels_float[index], 0.0f, 1.0f);
  if (!picture.pixels16.empty()) return static_cast<float>(picture.pixels16[index]) / 65535.0f;
  return static_cast<float>(picture.pixels[index]) / 255.0f;
}

}  // namespace furrow::character
