// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture_codec.h"

#include <filesystem>
#include <system_error>

#include <dlfcn.h>

#include "base/data_dir.h"

namespace furrow::character {
namespace {

std::filesystem::path ModulePath() {
  return InstallPrefix() / "lib" / "furrow" / "furrow-pictures.so";
}

// The module is never unloaded: some of OpenImageIO's libraries do not support that.
Result<const PictureCodec*> LoadModule() {
  const std::filesystem::path path = ModulePath();
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* make = module == nullptr ? nullptr : dlsym(module, "FurrowPictureCodec");
  if (make == nullptr) {
    const char* why = dlerror();
    return Status(StatusCode::kUnavailable,
                  std::string("pictures cannot be read or written: ") + (why ? why : "no codec"),
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
  return std::filesystem::exists(ModulePath(), error);
}

}  // namespace furrow::character
