// SPDX-License-Identifier: Apache-2.0
#include "character/gltf_container.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "base/asset_path.h"
#include "base/files.h"
#include "base/status.h"
#include "third_party/tinygltf/glb.h"

namespace furrow::character {
namespace {

using nlohmann::json;

Status Broken(std::string what, std::string where) {
  return {StatusCode::kParse, std::move(what), std::move(where)};
}

// An unsigned integer of a JSON object: false when it is there and is something else.
bool Unsigned(const json& object, const char* name, std::uint64_t otherwise, std::uint64_t* value) {
  *value = otherwise;
  const auto found = object.find(name);
  if (found == object.end()) return true;
  if (!found->is_number_unsigned()) return false;
  *value = found->get<std::uint64_t>();
  return true;
}

Status CheckBufferViews(const json& root) {
  if (!root.contains("bufferViews")) return {};
  const json none = json::array();
  const json& buffers = root.contains("buffers") ? root["buffers"] : none;
  const json& views = root["bufferViews"];
  if (!views.is_array() || !buffers.is_array()) {
    return {StatusCode::kSchema, "a list is due", views.is_array() ? "buffers" : "bufferViews"};
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string at = "bufferViews[" + std::to_string(i) + "]";
    const json& view = views[i];
    if (!view.is_object()) return {StatusCode::kSchema, "an object is due", at};
    std::uint64_t buffer = 0, offset = 0, length = 0, size = 0;
    if (!Unsigned(view, "buffer", UINT64_MAX, &buffer) || buffer >= buffers.size() ||
        !buffers[buffer].is_object()) {
      return {StatusCode::kSchema, "there is no such buffer", at + ".buffer"};
    }
    if (!Unsigned(view, "byteOffset", 0, &offset)) {
      return {StatusCode::kSchema, "not an unsigned integer", at + ".byteOffset"};
    }
    if (!Unsigned(view, "byteLength", 0, &length) || length == 0) {
      return {StatusCode::kSchema, "a length of at least 1 is due", at + ".byteLength"};
    }
    if (!Unsigned(buffers[buffer], "byteLength", 0, &size) || size == 0) {
      return {StatusCode::kSchema, "a length of at least 1 is due",
              "buffers[" + std::to_string(buffer) + "].byteLength"};
    }
    if (offset > size || length > size - offset) {
      return {StatusCode::kParse, "the view ends past its buffer", at + ".byteLength"};
    }
  }
  return {};
}

Status CheckRequiredExtensions(const json& root) {
  constexpr const char* kKnown[] = {"KHR_mesh_quantization", "KHR_materials_unlit"};
  const auto found = root.find("extensionsRequired");
  if (found == root.end()) return {};
  if (!found->is_array()) return {StatusCode::kSchema, "a list is due", "extensionsRequired"};
  for (const json& entry : *found) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
    if (std::find(std::begin(kKnown), std::end(kKnown), name) == std::end(kKnown)) {
      return {StatusCode::kUnsupported, "the file requires the extension " + name,
              "extensionsRequired", "export without it (no mesh compression)"};
    }
  }
  return {};
}

Status CheckJson(std::string_view text) {
  if (gltf::IsNestedTooDeep(text)) {
    return {StatusCode::kLimit, "the JSON is nested deeper than 64", "json"};
  }
  const json root = json::parse(text.begin(), text.end(), nullptr, false);
  if (root.is_discarded()) return Broken("the text is not JSON", "json");
  if (!root.is_object()) return {StatusCode::kSchema, "a JSON object is due", "json"};
  if (root.contains("buffers") && root["buffers"].is_array()) {
    for (std::size_t i = 0; i < root["buffers"].size(); ++i) {
      const json& buffer = root["buffers"][i];
      std::uint64_t size = 0;
      if (!buffer.is_object() || !Unsigned(buffer, "byteLength", 0, &size) || size == 0 ||
          size > kMaxGltfBytes) {
        return {StatusCode::kSchema, "a length of at least 1 is due",
                "buffers[" + std::to_string(i) + "].byteLength"};
      }
    }
  }
  FURROW_RETURN_IF_ERROR(CheckBufferViews(root));
  return CheckRequiredExtensions(root);
}

// tinygltf's way to the disk: the same rules as for any other file that a package names.
bool AssetExists(const std::string& name, void* folder) {
  return FindAsset(name, *static_cast<const std::filesystem::path*>(folder)).ok();
}

bool ReadAsset(std::vector<unsigned char>* out, std::string* error, const std::string& name,
               void* folder) {
  const auto path = FindAsset(name, *static_cast<const std::filesystem::path*>(folder));
  if (!path.ok()) {
    *error = path.status().what();
    return false;
  }
  const Result<std::string> bytes = ReadFile(*path, kMaxGltfBytes);
  if (!bytes.ok()) {
    *error = bytes.status().ToString();
    return false;
  }
  out->assign(bytes->begin(), bytes->end());
  return true;
}

bool WriteNothing(std::string* error, const std::string&, const std::vector<unsigned char>&,
                  void*) {
  *error = "read-only";
  return false;
}

std::string SameName(const std::string& name, void*) { return name; }

// Pictures stay encoded: one in a buffer view is found there later, one in a data URI is kept here.
bool KeepEncoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

Result<gltf::Glb> SplitGlb(std::string_view bytes) {
  gltf::Glb glb;
  const gltf::GlbStatus status = gltf::ReadGlb(bytes, glb);
  const auto chunk = [&](std::size_t index) { return "chunks[" + std::to_string(index) + "]"; };
  const auto broken_length = [&] {
    return Broken("the header says " + std::to_string(glb.stated_bytes) + " bytes, the file has " +
                      std::to_string(bytes.size()),
                  "header.length");
  };
  switch (status) {
    case gltf::GlbStatus::kOk: break;
    case gltf::GlbStatus::kTooShort:
      return Broken("too short for a GLB's header and first chunk", "header");
    case gltf::GlbStatus::kBadMagic:
      return Broken("not a GLB: it does not begin with 'glTF'", "header");
    case gltf::GlbStatus::kBadVersion:
      return Status(StatusCode::kUnsupported,
                    "GLB of version " + std::to_string(glb.version) + ", 2 is read",
                    "header.version");
    case gltf::GlbStatus::kBadLength: return broken_length();
    case gltf::GlbStatus::kBadChunkLength:
      return Broken("the chunk's length does not fit the file", chunk(glb.num_chunks) + ".length");
    case gltf::GlbStatus::kBadFirstChunk:
      return Broken("the first chunk is not JSON", chunk(glb.num_chunks) + ".type");
  }
  // tinygltf takes the file's word for these.
  if (glb.stated_bytes != bytes.size()) return broken_length();
  if (glb.unread_bytes != 0) return Broken("the chunk's header is cut off", chunk(glb.num_chunks));
  if (glb.json.size() % 4 != 0 || glb.binary.size() % 4 != 0) {
    return Broken("the chunk's length is no multiple of 4",
                  chunk(glb.json.size() % 4 != 0 ? 0 : 1) + ".length");
  }
  return glb;
}

Result<std::unique_ptr<tinygltf::Model>> ParseGltf(std::string_view bytes,
                                                   const std::filesystem::path& folder) {
  if (bytes.empty()) return Broken("the file is empty", "header");
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const bool binary = first == std::string_view::npos || bytes[first] != '{';
  std::string_view text = bytes;
  if (binary) {
    const Result<gltf::Glb> parts = SplitGlb(bytes);
    FURROW_RETURN_IF_ERROR(parts);
    text = parts->json;
  }
  FURROW_RETURN_IF_ERROR(CheckJson(text));

  auto folder_copy = folder;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(KeepEncoded, nullptr);
  loader.SetFsCallbacks({AssetExists, SameName, ReadAsset, WriteNothing, &folder_copy});
  auto model = std::make_unique<tinygltf::Model>();
  std::string error;
  std::string warning;
  bool ok = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    ok = binary ? loader.LoadBinaryFromMemory(model.get(), &error, &warning,
                                              reinterpret_cast<const unsigned char*>(bytes.data()),
                                              size, "")
                : loader.LoadASCIIFromString(model.get(), &error, &warning, bytes.data(), size, "");
  } catch (const std::exception& exception) {
    error = exception.what();  // of the JSON library, on a value of the wrong type
  }
  if (!ok) return Status(StatusCode::kSchema, "not a valid glTF: " + FirstLine(error), "json");
  return model;
}

}  // namespace furrow::character
