// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/status.h"
#include "character/picture.h"

namespace furrow::character {

// How a picture is stored in a file.
struct PictureStorage {
  enum class Format { kPng, kExr };
  enum class Type { kU8, kU16, kHalf };
  Format format = Format::kPng;
  Type type = Type::kU8;
  bool srgb = false;    // said in the file; pixels stay as they are
  int compression = 0;  // PNG: 1 to 9; 0: the library's own
};

// What reads and writes picture files: OpenImageIO, which brings 250 libraries and 110 MiB of
// resident memory with it. So it is a module of its own, lib/furrow/furrow-pictures.so beside bin/,
// that is loaded with the first picture: a daemon that draws none never has it.
struct PictureCodec {
  // Fills all of `picture` but its name. kOk, or why not, with `why`: the errors of DecodePicture()
  // but for kNonFinite.
  StatusCode (*decode)(std::span<const std::uint8_t> bytes, Picture* picture, std::string* why);
  // Precondition: the pixels fit the size. kOk, or kInternal and `why`.
  StatusCode (*encode)(const Picture& picture, const PictureStorage& storage, std::string* bytes,
                       std::string* why);
};

// The codec, loaded once. Errors: kUnavailable, naming the module.
[[nodiscard]] Result<const PictureCodec*> GetPictureCodec();

// EncodePng() and EncodeExr() with all that can be chosen. Errors: theirs, GetPictureCodec()'s.
[[nodiscard]] Result<std::string> EncodePicture(const Picture& picture,
                                                const PictureStorage& storage);

}  // namespace furrow::character
