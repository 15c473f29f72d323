// SPDX-License-Identifier: Apache-2.0
#include "gltf/container/glb.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/text.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr const char* kCutOff = "the file seems to be cut off";

// GLB is little-endian on every host.
std::uint32_t ReadU32(std::string_view bytes, std::size_t at) {
  const auto* b = reinterpret_cast<const unsigned char*>(bytes.data()) + at;
  return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
}

Status ParseError(std::string what, std::string where, std::string todo = {}) {
  return {StatusCode::kParse, std::move(what), std::move(where), std::move(todo)};
}

std::string ChunkField(std::size_t chunk, const char* member) {
  return "chunks[" + std::to_string(chunk) + "]" + member;
}

// The layout of a chunk: u32 length, u32 type, then `length` bytes.
Status ReadChunks(std::string_view bytes, Container* container) {
  std::size_t at = kHeaderBytes;
  for (std::size_t chunk = 0; bytes.size() - at >= kChunkHeaderBytes; ++chunk) {
    const std::size_t size = ReadU32(bytes, at);
    const std::uint32_t type = ReadU32(bytes, at + 4);
    at += kChunkHeaderBytes;
    // The subtraction cannot wrap: `at` never passes the end.
    if (size > bytes.size() - at) {
      return ParseError("the chunk is longer than the file", ChunkField(chunk, ".length"));
    }
    if (size % 4 != 0) {
      container->warnings.push_back(ChunkField(chunk, ".length: is not a multiple of 4"));
    }
    if (chunk == 0) {
      if (type != kJsonChunk) {
        return ParseError("the first chunk is not JSON", ChunkField(0, ".type"));
      }
      container->json = bytes.substr(at, size);
    } else if (type == kBinaryChunk && !container->has_binary) {
      container->binary = bytes.substr(at, size);
      container->has_binary = true;
    }
    at += size;
  }
  if (at != bytes.size()) {
    container->warnings.push_back("chunks: ignored " + Counted(bytes.size() - at, "byte") +
                                  " after the last chunk");
  }
  return {};
}

Result<Container> SplitBinary(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes) {
    return ParseError("the GLB header is incomplete", "header", kCutOff);
  }
  const std::uint32_t version = ReadU32(bytes, 4);
  if (version != 2) {
    return Status(StatusCode::kUnsupported,
                  "GLB version " + std::to_string(version) + " is not supported, only version 2",
                  "header.version");
  }
  const std::size_t stated = ReadU32(bytes, 8);
  if (stated > bytes.size() || stated < kHeaderBytes + kChunkHeaderBytes) {
    return ParseError("the header states " + Counted(stated, "byte") + ", the file has " +
                          Counted(bytes.size(), "byte"),
                      "header.length", stated > bytes.size() ? kCutOff : "");
  }
  Container container;
  if (stated < bytes.size()) {
    container.warnings.push_back("header.length: ignored " +
                                 Counted(bytes.size() - stated, "byte") + " after the stated end");
  }
  FURROW_RETURN_IF_ERROR(ReadChunks(bytes.substr(0, stated), &container));
  return container;
}

}  // namespace

Result<Container> SplitContainer(std::string_view bytes) {
  if (bytes.empty()) return ParseError("the file is empty", "header");
  if (bytes.size() > kMaxFileBytes) {
    return Status(StatusCode::kLimit, "the file is larger than 1 GiB", "header");
  }
  if (bytes.starts_with("glTF")) return SplitBinary(bytes);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string_view::npos || bytes[first] != '{') {
    return ParseError("the file is neither a GLB (which begins with 'glTF') nor JSON", "header");
  }
  Container container;
  container.json = bytes;
  return container;
}

}  // namespace furrow::gltf
