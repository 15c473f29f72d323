// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/status.h"
#include "character/pictures/picture.h"
#include "character/pictures/picture_codec.h"

namespace furrow::character {

// Decodes a PNG, JPEG or OpenEXR picture of 1 to 4 channels from the bytes of a whole file. The
// first bytes decide the format. Sizes are checked before memory is allocated.
//
// Errors: kUnsupported (another format, more channels), kLimit (too large), kParse (damaged),
// kNonFinite (an EXR texel), kUnavailable (no codec module).
[[nodiscard]] Result<Picture> DecodePicture(std::string name, std::span<const std::uint8_t> bytes);

// Reads and decodes a picture file. `name` becomes Picture::name. Errors: those of ReadFile() and
// DecodePicture(), with the path as `where`.
[[nodiscard]] Result<Picture> LoadPicture(std::string name, const std::filesystem::path& path);

// Encodes a PNG of 8 or 16 bits per channel, as the picture's pixels. Equal pictures give equal
// bytes. Errors: kInvalidArgument (the number of pixels does not match the size), kUnsupported
// (float pixels), kUnavailable (no codec module).
[[nodiscard]] Result<std::string> EncodePng(const Picture& picture);

// Encodes an OpenEXR with half floats (11 bits of precision, at most +-65504). Integer pixels are
// written as [0, 1]. Errors: kInvalidArgument (the number of pixels does not match the size),
// kUnavailable (no codec module).
[[nodiscard]] Result<std::string> EncodeExr(const Picture& picture);

// Encodes a picture as `storage` says. Errors: kInvalidArgument (the number of pixels does not
// match the size), kUnavailable (no codec module), kInternal (the library failed).
[[nodiscard]] Result<std::string> EncodePicture(const Picture& picture,
                                                const PictureStorage& storage);

}  // namespace furrow::character
