// SPDX-License-Identifier: Apache-2.0
#include "motion/gltf/gltf_json.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "base/files.h"
#include "base/status.h"
#include "motion/clip/limits.h"
#include "third_party/tinygltf/glb.h"

namespace furrow::motion {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxJsonBytes = 64u << 20;
constexpr std::size_t kMaxBuffers = 256;
constexpr std::size_t kMaxNameBytes = 255;

class Reducer {
 public:
  Reducer(const gltf::Glb& chunks, std::string_view source_name,
          const std::filesystem::path& folder)
      : chunks_(chunks), source_name_(source_name), folder_(folder) {}

  Result<ReducedGltf> Run() {
    FURROW_RETURN_IF_ERROR(ParseJson());
    FURROW_RETURN_IF_ERROR(CheckHead());
    FURROW_RETURN_IF_ERROR(ReadMorphTargets());
    FURROW_RETURN_IF_ERROR(ReadBuffers());
    WriteReduced();
    return std::move(result_);
  }

 private:
  Status Error(StatusCode code, std::string_view field, std::string what) const {
    return {code, std::move(what), source_name_ + ": " + std::string(field)};
  }

  Status ParseJson() {
    if (chunks_.json.size() > kMaxJsonBytes) {
      return Error(StatusCode::kLimit, "JSON", "larger than 64 MiB");
    }
    if (gltf::IsNestedTooDeep(chunks_.json)) {
      return Error(StatusCode::kLimit, "JSON", "nested deeper than 64 levels");
    }
    json_ = Json::parse(chunks_.json.begin(), chunks_.json.end(), nullptr, false);
    if (json_.is_discarded()) return Error(StatusCode::kParse, "JSON", "is malformed or cut off");
    if (!json_.is_object()) return Error(StatusCode::kSchema, "JSON", "is not an object");
    return {};
  }

  Status CheckHead() const {
    const Json* asset = Find(json_, "asset");
    const Json* version = asset != nullptr ? Find(*asset, "version") : nullptr;
    if (version == nullptr || !version->is_string() ||
        !version->get_ref<const std::string&>().starts_with("2.")) {
      return Error(StatusCode::kUnsupported, "asset.version", "is not glTF 2.x");
    }
    for (const Json& name : Array(json_, "extensionsRequired")) {
      if (name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression") {
        return Error(StatusCode::kUnsupported, "extensionsRequired",
                     "meshopt-compressed buffers are not read");
      }
    }
    return {};
  }

  static const Json* Find(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
  }

  static const Json& Array(const Json& object, const char* key) {
    static const Json kEmpty = Json::array();
    const Json* found = Find(object, key);
    return found != nullptr && found->is_array() ? *found : kEmpty;
  }

  static std::string Text(const Json& object, const char* key) {
    const Json* found = Find(object, key);
    return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
  }

  Status ReadMorphTargets() {
    for (const Json& mesh : Array(json_, "meshes")) {
      std::size_t count = 0;
      for (const Json& primitive : Array(mesh, "primitives")) {
        count = std::max(count, Array(primitive, "targets").size());
      }
      if (count > kMaxBlendShapes) return Error(StatusCode::kLimit, "meshes", "too many targets");
      const Json* extras = Find(mesh, "extras");
      const Json& given = Array(extras != nullptr ? *extras : mesh, "targetNames");
      std::string prefix = Text(mesh, "name").substr(0, kMaxNameBytes);
      if (prefix.empty()) prefix = "mesh_" + std::to_string(result_.morph_targets.size());
      std::vector<std::string> names;
      for (std::size_t i = 0; i < count; ++i) {
        const bool named = i < given.size() && given[i].is_string() && given[i] != "";
        names.push_back(named ? given[i].get<std::string>() : prefix + "." + std::to_string(i));
      }
      result_.morph_targets.push_back(std::move(names));
    }
    return {};
  }

  Status ReadBuffers() {
    const Json& buffers = Array(json_, "buffers");
    if (buffers.size() > kMaxBuffers) return Error(StatusCode::kLimit, "buffers", "more than 256");
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      const std::string field = "buffers[" + std::to_string(i) + "]";
      Result<std::vector<unsigned char>> bytes = ReadBuffer(buffers[i], i, field);
      FURROW_RETURN_IF_ERROR(bytes);
      const Json* length = Find(buffers[i], "byteLength");
      if (length == nullptr || !length->is_number_unsigned() ||
          length->get<std::uint64_t>() > bytes->size()) {
        return Error(StatusCode::kSchema, field + ".byteLength",
                     "is missing, or more than the " + std::to_string(bytes->size()) +
                         " bytes that are there");
      }
      bytes->resize(length->get<std::uint64_t>());
      total += bytes->size();
      if (total > kMaxFileBytes)
        return Error(StatusCode::kLimit, field, "the buffers are too large");
      result_.buffers.push_back(std::move(*bytes));
    }
    return {};
  }

  Result<std::vector<unsigned char>> ReadBuffer(const Json& buffer, std::size_t index,
                                                const std::string& field) const {
    if (Find(buffer, "uri") == nullptr) {
      if (index != 0 || !chunks_.has_binary) {
        return Error(StatusCode::kSchema, field, "has no uri and no binary chunk");
      }
      return std::vector<unsigned char>(chunks_.binary.begin(), chunks_.binary.end());
    }
    const std::string uri = Text(buffer, "uri");
    if (uri.starts_with("data:")) return DecodeDataUri(uri, field);
    // A name in the folder itself: a file from outside reaches nothing outside its folder.
    if (folder_.empty() || uri.empty() || uri == ".." || uri == "." ||
        uri.find_first_of("/\\:%") != std::string::npos) {
      return Error(StatusCode::kUnsupported, field + ".uri",
                   "is neither a data URI nor a plain name of a file beside this one");
    }
    const Result<std::string> bytes = ReadFile(folder_ / uri, kMaxFileBytes);
    FURROW_RETURN_IF_ERROR(bytes);
    return std::vector<unsigned char>(bytes->begin(), bytes->end());
  }

  Result<std::vector<unsigned char>> DecodeDataUri(const std::string& uri,
                                                   const std::string& field) const {
    std::vector<unsigned char> bytes;
    std::string mime_type;
    if (!tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false)) {
      return Error(StatusCode::kParse, field + ".uri", "is no base64 data URI");
    }
    return bytes;
  }

  void WriteReduced() {
    Json reduced = Json::object();
    for (const char* key : {"asset", "nodes", "skins", "animations", "accessors", "bufferViews"}) {
      if (const Json* part = Find(json_, key)) reduced[key] = *part;
    }
    for (const char* key : {"nodes", "skins", "animations", "accessors", "bufferViews"}) {
      const auto found = reduced.find(key);
      if (found == reduced.end() || !found->is_array()) continue;
      for (Json& entry : *found) {
        if (entry.is_object()) entry.erase("extensions");
      }
    }
    if (const Json* extensions = Find(json_, "extensions")) {
      if (const Json* vrma = Find(*extensions, "VRMC_vrm_animation")) {
        reduced["extensions"]["VRMC_vrm_animation"] = *vrma;
      }
    }
    result_.json = reduced.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

  const gltf::Glb& chunks_;
  const std::string source_name_;
  const std::filesystem::path& folder_;
  Json json_;
  ReducedGltf result_;
};

}  // namespace

Result<gltf::Glb> SplitGlb(std::string_view bytes, std::string_view source_name) {
  const auto error = [&](StatusCode code, std::string what, std::string todo = {}) {
    return Status(code, std::move(what), std::string(source_name), std::move(todo));
  };
  if (bytes.empty()) return error(StatusCode::kParse, "the file is empty");
  if (bytes.size() > kMaxFileBytes) return error(StatusCode::kLimit, "the file is too large");
  gltf::Glb glb;
  if (!bytes.starts_with("glTF")) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first == std::string_view::npos || bytes[first] != '{') {
      return error(StatusCode::kParse, "is neither a binary glTF nor a JSON text");
    }
    glb.json = bytes;
    return glb;
  }
  constexpr const char* kCut = "the file seems to be cut off";
  switch (gltf::ReadGlb(bytes, glb)) {
    case gltf::GlbStatus::kOk:
    case gltf::GlbStatus::kBadMagic: break;
    case gltf::GlbStatus::kTooShort:
      return error(StatusCode::kParse, "the GLB header is incomplete", kCut);
    case gltf::GlbStatus::kBadVersion:
      return error(StatusCode::kUnsupported, "is not version 2 of GLB");
    case gltf::GlbStatus::kBadLength:
      return error(StatusCode::kParse,
                   "the GLB header states " + std::to_string(glb.stated_bytes) +
                       " bytes, there are " + std::to_string(bytes.size()),
                   kCut);
    case gltf::GlbStatus::kBadChunkLength:
      return error(StatusCode::kParse, "a GLB chunk is longer than the file");
    case gltf::GlbStatus::kBadFirstChunk:
      return error(StatusCode::kParse, "the first GLB chunk is not JSON");
  }
  return glb;
}

Result<ReducedGltf> ReduceGltf(const gltf::Glb& chunks, std::string_view source_name,
                               const std::filesystem::path& folder) {
  return Reducer(chunks, source_name, folder).Run();
}

}  // namespace furrow::motion
