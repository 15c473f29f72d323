// SPDX-License-Identifier: Apache-2.0
#include "character/picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/files.h"
#include "base/status.h"
#include "character/picture_codec.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::character {
namespace {

constexpr std::size_t kMaxEncodedBytes = 256u << 20;

bool PixelsFit(const Picture& picture) {
  const std::size_t values =
      std::max({picture.pixels_float.size(), picture.pixels16.size(), picture.pixels.size()});
  return picture.width > 0 && picture.height > 0 && picture.channels >= 1 &&
         picture.channels <= 4 &&
         values == static_cast<std::size_t>(picture.width) * picture.height *
                       static_cast<std::size_t>(picture.channels);
}

}  // namespace

Result<Picture> DecodePicture(std::string name, std::span<const std::uint8_t> bytes) {
  const auto codec = GetPictureCodec();
  FURROW_RETURN_IF_ERROR(codec);
  Picture picture;
  std::string why;
  const StatusCode code = (*codec)->decode(bytes, &picture, &why);
  if (code != StatusCode::kOk) return Status(code, std::move(why));
  if (!wrinkle::AllFinite(picture.pixels_float)) {
    return Status(StatusCode::kNonFinite, "the picture holds texels that are no numbers");
  }
  picture.name = std::move(name);
  return picture;
}

Result<std::string> EncodePicture(const Picture& picture, const PictureStorage& storage) {
  if (!PixelsFit(picture)) {
    return Status(StatusCode::kInvalidArgument,
                  "the pixels of picture '" + picture.name + "' do not fit its size");
  }
  const auto codec = GetPictureCodec();
  FURROW_RETURN_IF_ERROR(codec);
  std::string bytes;
  std::string why;
  const StatusCode code = (*codec)->encode(picture, storage, &bytes, &why);
  if (code == StatusCode::kOk) return bytes;
  return Status(code, "cannot encode picture '" + picture.name + "': " + why);
}

Result<Picture> LoadPicture(std::string name, const std::filesystem::path& path) {
  const Result<std::string> bytes = ReadFile(path, kMaxEncodedBytes);
  FURROW_RETURN_IF_ERROR(bytes);
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
  using enum PictureStorage::Type;
  return EncodePicture(picture, {.type = picture.pixels16.empty() ? kU8 : kU16});
}

Result<std::string> EncodeExr(const Picture& picture) {
  return EncodePicture(
      picture, {.format = PictureStorage::Format::kExr, .type = PictureStorage::Type::kHalf});
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
