// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/status.h"
#include "character/pictures/picture.h"

namespace furrow::character {

// How a picture is stored in a file.
struct PictureStorage {
  enum class Format { kPng, kExr };
  enum class Type { kU8, kU16, kHalf };
  Format format = Format::kPng;
  Type type = Type::kU8;
  bool srgb = false;    // marks the file as sRGB; pixels are not converted
  int compression = 0;  // PNG: 1 to 9, or 0 for the library's default
};

// Reads and writes picture files with OpenImageIO. That library loads 250 others and takes 110 MiB
// of resident memory, so the codec is a module, lib/furrow/furrow-pictures.so beside bin/, which is
// loaded with the first picture. A daemon without pictures never loads it.
struct PictureCodec {
  // Fills `picture` except its name from a whole file. On failure returns kUnsupported, kLimit or
  // kParse, and sets `why` to the message. No pointer may be null.
  StatusCode (*decode)(std::span<const std::uint8_t> bytes, Picture* picture, std::string* why);
  // Precondition: the number of pixels matches the size. On failure returns kInternal and sets
  // `why`.
  StatusCode (*encode)(const Picture& picture, const PictureStorage& storage, std::string* bytes,
                       std::string* why);
};

// Returns the codec, which lives until the process ends. Loads it on the first call; safe on any
// thread. Error: kUnavailable, with the module's path.
[[nodiscard]] Result<const PictureCodec*> GetPictureCodec();

// True if the module is installed. Does not load it.
[[nodiscard]] bool IsPictureCodecInstalled();

}  // namespace furrow::character
