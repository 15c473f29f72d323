// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "gltf/container/glb.h"
#include "gltf/document/buffer_view.h"
#include "gltf/document/draco_mesh.h"

// The checks that come before tinygltf; private to gltf/document/.
namespace furrow::gltf {

// What a reader needs of a file. Other parts are dropped unread, so faults in them do no harm.
enum class Contents : std::uint8_t {
  kAnimation,  // nodes, joints of skins, animations, VRMC_vrm_animation, morph target names
  kCharacter,  // nodes, skins, meshes with their morph targets, materials, images
};

struct OpenOptions {
  Contents contents = Contents::kCharacter;
  std::optional<std::filesystem::path> folder;  // for external files; see FindExternalFile()
  const DracoDecoder* draco = nullptr;  // for kCharacter; null: files that require it are refused
};

// One entry of `images`, still encoded. Either `view` or `uri` says where the bytes are.
struct ImageSource {
  std::string name;
  std::string uri;
  int view = -1;  // checked: in range
};

// The morph targets of a mesh. `names` may be shorter than `count`, and names may be empty.
struct MorphTargetSource {
  std::string mesh_name;
  std::size_t count = 0;
  std::vector<std::string> names;
};

// A glTF file, taken apart.
struct RawDocument : BufferViews {
  std::string json;  // for tinygltf: without buffers, buffer views, images and unused parts
  std::vector<ImageSource> images;               // of kCharacter
  std::vector<MorphTargetSource> morph_targets;  // one per mesh
  std::size_t num_meshes = 0;
  std::vector<int> moving_nodes;      // that any animation moves: ascending, each below kMaxNodes
  std::vector<std::string> warnings;  // "field: what"
};

// Parses the JSON within the limits of gltf/limits.h, checks version and required extensions,
// loads the buffers and checks the range of every buffer view.
//
// The views refer to `container`'s bytes, which must outlive them.
//
// Errors: kParse, kSchema, kLimit, kUnsupported (version; Draco without a decoder),
// FindExternalFile()'s, ReadFile()'s and the Draco decoder's. `where` is a field.
[[nodiscard]] Result<RawDocument> ReadRawDocument(const Container& container,
                                                  const OpenOptions& options);

}  // namespace furrow::gltf
