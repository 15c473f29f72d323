// SPDX-License-Identifier: Apache-2.0
#include "third_party/tinygltf/glb.h"

namespace furrow::gltf {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

// Little-endian, as the container says; the host's order does not matter.
std::uint32_t ReadU32(std::string_view bytes, std::size_t at) {
  const auto* b = reinterpret_cast<const unsigned char*>(bytes.data()) + at;
  return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
}

GlbStatus ReadChunks(std::string_view bytes, Glb& glb) {
  std::size_t at = kHeaderBytes;
  for (; bytes.size() - at >= kChunkHeaderBytes; ++glb.num_chunks) {
    const std::size_t size = ReadU32(bytes, at);
    const std::uint32_t type = ReadU32(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (size > bytes.size() - at) return GlbStatus::kBadChunkLength;
    if (glb.num_chunks == 0) {
      if (type != kJsonChunk) return GlbStatus::kBadFirstChunk;
      glb.json = bytes.substr(at, size);
    } else if (type == kBinaryChunk && !glb.has_binary) {
      glb.binary = bytes.substr(at, size);
      glb.has_binary = true;
    }
    at += size;
  }
  glb.unread_bytes = bytes.size() - at;
  return GlbStatus::kOk;
}

}  // namespace

GlbStatus ReadGlb(std::string_view bytes, Glb& glb) {
  glb = {};
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes) return GlbStatus::kTooShort;
  if (!bytes.starts_with("glTF")) return GlbStatus::kBadMagic;
  glb.version = ReadU32(bytes, 4);
  glb.stated_bytes = ReadU32(bytes, 8);
  if (glb.version != 2) return GlbStatus::kBadVersion;
  if (glb.stated_bytes > bytes.size() || glb.stated_bytes < kHeaderBytes + kChunkHeaderBytes) {
    return GlbStatus::kBadLength;
  }
  return ReadChunks(bytes.substr(0, glb.stated_bytes), glb);
}

bool IsNestedTooDeep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

}  // namespace furrow::gltf
