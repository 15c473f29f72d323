// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "base/status.h"
#include "third_party/tinygltf/glb.h"

namespace tinygltf {
class Model;
}

namespace furrow::character {

inline constexpr std::size_t kMaxGltfBytes = 1u << 30;

// Splits a .glb after checking header and chunk lengths against the bytes there are.
// Errors: kParse, with `where` the field ("header.length", "chunks[1].length").
[[nodiscard]] Result<gltf::Glb> SplitGlb(std::string_view bytes);

// A .glb or .gltf as tinygltf's model: containers, nesting and every buffer view checked first,
// since tinygltf trusts them. Buffers beside a .gltf are read through FindAsset(); pictures stay
// encoded (see gltf_material.h). Accessors and everything that counts on them are not checked yet.
//
// Errors: kParse, kSchema, kLimit, kUnsupported (a required extension), kNotFound; `where` is a
// field.
[[nodiscard]] Result<std::unique_ptr<tinygltf::Model>> ParseGltf(
    std::string_view bytes, const std::filesystem::path& folder);

}  // namespace furrow::character
