// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "third_party/tinygltf/glb.h"

// The way from a file's bytes to a JSON text that a glTF library may see; private to motion/.
namespace furrow::motion {

// The parts of a GLB, or a .gltf's text as `json` alone; header and chunk sizes are checked against
// the bytes that are there. Errors: kParse, kLimit.
[[nodiscard]] Result<gltf::Glb> SplitGlb(std::string_view bytes, std::string_view source_name);

// What an animation reader needs of a glTF JSON.
struct ReducedGltf {
  std::string json;  // asset, nodes, skins, animations, accessors, bufferViews, VRMC_vrm_animation
  std::vector<std::vector<std::string>> morph_targets;  // names, a mesh
  std::vector<std::vector<unsigned char>> buffers;
};

// Parses the JSON (bounded in size and depth), drops everything else, and fetches the buffers: the
// GLB's chunk, data URIs, files directly in `folder`.
//
// Errors: kParse, kSchema, kLimit, kUnsupported (an extension that changes buffers or accessors is
// required), kNotFound and kIo (a buffer's file).
[[nodiscard]] Result<ReducedGltf> ReduceGltf(const gltf::Glb& chunks, std::string_view source_name,
                                             const std::filesystem::path& folder);

}  // namespace furrow::motion
