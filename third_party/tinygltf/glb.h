// SPDX-License-Identifier: Apache-2.0
// What must be checked before tinygltf or a JSON library sees a byte of a glTF from outside; both
// readers of glTF (motion/, character/) come by here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace furrow::gltf {

enum class GlbStatus : std::uint8_t {
  kOk = 0,
  kTooShort,        // no room for the header and one chunk
  kBadMagic,        // does not begin with "glTF"
  kBadVersion,      // not version 2
  kBadLength,       // states more bytes than there are, or too few for a chunk
  kBadChunkLength,  // a chunk ends past the container
  kBadFirstChunk,   // the first chunk is not JSON
};

// A .glb's parts, as views into it, and what its header and its faulty chunk say.
struct Glb {
  std::string_view json;
  std::string_view binary;  // the first chunk of that type behind the JSON; empty without one
  bool has_binary = false;
  std::uint32_t version = 0;
  std::size_t stated_bytes = 0;
  std::size_t num_chunks = 0;  // read; on kBadChunkLength and kBadFirstChunk the faulty one's index
  std::size_t unread_bytes =
      0;  // behind the last whole chunk: none in a file that keeps the standard
};

// Splits a .glb (Khronos, glTF 2.0, section 4) after checking header and chunk lengths against the
// bytes there are.
[[nodiscard]] GlbStatus ReadGlb(std::string_view bytes, Glb& glb);

// Libraries parse and copy JSON values recursively: text nested deeper than this is not for them.
inline constexpr int kMaxJsonDepth = 64;
[[nodiscard]] bool IsNestedTooDeep(std::string_view json);

}  // namespace furrow::gltf
