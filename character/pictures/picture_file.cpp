// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture_file.h"

#include <algorithm>
#include <utility>

#include "base/files.h"
#include "base/status.h"
#include "character/pictures/picture_codec.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::character {
namespace {

constexpr std::size_t kMaxEncodedBytes = 256u << 20;

// The codec reads width * height * channels values without further checks.
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
    return Status(StatusCode::kNonFinite, "the picture contains NaN or infinite values", {},
                  "export it with finite values");
  }
  picture.name = std::move(name);
  return picture;
}

Result<std::string> EncodePicture(const Picture& picture, const PictureStorage& storage) {
  if (!PixelsFit(picture)) {
    const std::size_t values =
        std::max({picture.pixels_float.size(), picture.pixels16.size(), picture.pixels.size()});
    return Status(StatusCode::kInvalidArgument,
                  "picture '" + picture.name + "' has " + std::to_string(values) +
                      " values, which do not match its size of " + std::to_string(picture.width) +
                      " x " + std::to_string(picture.height) + " pixels with " +
                      std::to_string(picture.channels) + " channels (1 to 4)");
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
                  "picture '" + picture.name + "' has float pixels, which PNG cannot store");
  }
  using enum PictureStorage::Type;
  return EncodePicture(picture, {.type = picture.pixels16.empty() ? kU8 : kU16});
}

Result<std::string> EncodeExr(const Picture& picture) {
  return EncodePicture(
      picture, {.format = PictureStorage::Format::kExr, .type = PictureStorage::Type::kHalf});
}

}  // namespace furrow::character
