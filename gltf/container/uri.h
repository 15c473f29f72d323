// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/status.h"

// What a `uri` of a glTF file may refer to.
namespace furrow::gltf {

[[nodiscard]] bool IsDataUri(std::string_view uri);

// The bytes of "data:<any media type>;base64,<base64>". Errors: kParse.
[[nodiscard]] Result<std::vector<std::uint8_t>> DecodeDataUri(std::string_view uri);

// The path of an external file. Percent escapes are decoded. The name is then looked up by
// FindAsset(): in `folder` or below it, then in the folders of FURROW_ASSET_PATH. Without `folder`
// no file is opened.
//
// Errors: kUnsupported (no folder), kInvalidArgument (an absolute path, "..", a URL, a broken
// percent escape), kNotFound.
[[nodiscard]] Result<std::filesystem::path> FindExternalFile(
    std::string_view uri, const std::optional<std::filesystem::path>& folder);

}  // namespace furrow::gltf
