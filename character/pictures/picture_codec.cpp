// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture_codec.h"

#include <filesystem>
#include <string>
#include <system_error>

#include "base/process/module.h"

namespace furrow::character {
namespace {

constexpr char kModule[] = "furrow-pictures.so";

// The module is never unloaded: some of OpenImageIO's libraries do not support that.
Result<const PictureCodec*> LoadModule() {
  const std::filesystem::path path = ModulePath(kModule);
  std::string why;
  void* make = LoadFromModule(path, "FurrowPictureCodec", &why);
  if (make == nullptr) {
    return Status(StatusCode::kUnavailable,
                  "pictures cannot be read or written: " + (why.empty() ? "no codec" : why),
                  path.string(),
                  "install the package furrow-pictures, or build the target furrow_pictures");
  }
  return reinterpret_cast<const PictureCodec* (*)()>(make)();
}

}  // namespace

Result<const PictureCodec*> GetPictureCodec() {
  // Loaded once, on first use and safely from any thread. A program without pictures never loads
  // it.
  static const Result<const PictureCodec*> codec = LoadModule();
  return codec;
}

bool IsPictureCodecInstalled() {
  std::error_code error;
  return std::filesystem::exists(ModulePath(kModule), error);
}

}  // namespace furrow::character
