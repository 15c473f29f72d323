// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/raw_document.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/text.h"
#include "gltf/container/json_guard.h"
#include "gltf/container/uri.h"
#include "gltf/document/draco_primitives.h"
#include "gltf/document/meshopt_view.h"
#include "gltf/document/moving_nodes.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using Json = nlohmann::json;

// Required extensions that do not change what this code reads. Any other required extension is a
// warning, except kDracoExtension below.
constexpr std::string_view kHarmless[] = {"KHR_mesh_quantization",
                                          "EXT_texture_webp",
                                          "EXT_meshopt_compression",
                                          "KHR_meshopt_compression",
                                          "KHR_texture_transform",
                                          "KHR_materials_unlit",
                                          "KHR_materials_volume",
                                          "KHR_materials_emissive_strength",
                                          "KHR_materials_pbrSpecularGlossiness",
                                          "VRMC_vrm_animation",
                                          "VRM",
                                          "VRMC_vrm"};

// What to do about a required extension that is ignored.
std::string RemedyFor(std::string_view extension) {
  if (extension.ends_with("_texture_basisu") || extension.ends_with("_texture_dds") ||
      extension.ends_with("_texture_avif")) {
    return "export PNG, JPEG or WebP textures";
  }
  if (extension == "EXT_mesh_gpu_instancing") return "export each instance as a node of its own";
  if (extension.find("_materials_") != std::string_view::npos) {
    return "materials look different; export base colour, roughness and normal map";
  }
  if (extension.find("_lights_") != std::string_view::npos) return "lights are not imported";
  return "if something is missing, export the file without the extension";
}

// A file that does not require it has uncompressed meshes as well.
constexpr std::string_view kDracoExtension = "KHR_draco_mesh_compression";

// The member, or null. Also null if `object` is none, because the file decides about types.
const Json* Find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

// The member if it is an array, else an empty one.
const Json& Array(const Json& object, const char* key) {
  static const Json kEmpty = Json::array();
  const Json* found = Find(object, key);
  return found != nullptr && found->is_array() ? *found : kEmpty;
}

std::string Text(const Json& object, const char* key) {
  const Json* found = Find(object, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

// False if the member exists and is not an unsigned integer.
bool ReadUnsigned(const Json& object, const char* key, std::uint64_t fallback,
                  std::uint64_t* value) {
  *value = fallback;
  const Json* found = Find(object, key);
  if (found == nullptr) return true;
  if (!found->is_number_unsigned()) return false;
  *value = found->get<std::uint64_t>();
  return true;
}

std::string Entry(const char* list, std::size_t index) {
  return list + ("[" + std::to_string(index) + "]");
}

// Reads buffers and views itself, and leaves a reduced JSON for tinygltf, which trusts sizes and
// opens files that a document names.
class RawReader {
 public:
  RawReader(const Container& container, const OpenOptions& options)
      : container_(container), options_(options) {}

  Result<RawDocument> Run() {
    result_.warnings = container_.warnings;
    // Buffers come before views, and views before images: each refers to the one before.
    FURROW_RETURN_IF_ERROR(ParseJson());
    FURROW_RETURN_IF_ERROR(CheckVersion());
    FURROW_RETURN_IF_ERROR(CheckRequiredExtensions());
    FURROW_RETURN_IF_ERROR(ReadBuffers());
    FURROW_RETURN_IF_ERROR(ReadBufferViews());
    // Also of files that do not say that they require it.
    if (options_.contents == Contents::kCharacter && options_.draco != nullptr) {
      FURROW_RETURN_IF_ERROR(DecodeDracoPrimitives(*options_.draco, &json_, &result_));
    }
    result_.num_meshes = Array(json_, "meshes").size();
    FURROW_RETURN_IF_ERROR(ReadMorphTargets());
    result_.moving_nodes = ListMovingNodes(json_, result_.views);
    if (options_.contents == Contents::kCharacter) {
      FURROW_RETURN_IF_ERROR(ReadImages());
      UseTextureExtensions();
    }
    WriteReducedJson();
    return std::move(result_);
  }

 private:
  Status ParseJson() {
    FURROW_RETURN_IF_ERROR(CheckJsonSize(container_.json));
    json_ = Json::parse(container_.json.begin(), container_.json.end(), nullptr, false);
    if (json_.is_discarded()) {
      return {StatusCode::kParse, "the JSON is malformed or cut off", "json"};
    }
    if (!json_.is_object()) return {StatusCode::kSchema, "the JSON is not an object", "json"};
    return {};
  }

  Status CheckVersion() const {
    const Json* asset = Find(json_, "asset");
    const std::string version = asset != nullptr ? Text(*asset, "version") : std::string();
    if (version.starts_with("2.")) return {};
    const std::string found =
        version.empty() ? "it states no version" : "it states " + Quoted(version);
    return {StatusCode::kUnsupported, "the file is not glTF 2.x: " + found, "asset.version",
            "export it as glTF 2.0, or convert glTF 1.0 with 'gltf-pipeline -i OLD -o NEW'"};
  }

  Status CheckRequiredExtensions() {
    const Json* required = Find(json_, "extensionsRequired");
    if (required == nullptr) return {};
    if (!required->is_array()) {
      return {StatusCode::kSchema, "expected an array", "extensionsRequired"};
    }
    for (const Json& entry : *required) {
      const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
      if (name == kDracoExtension) {
        if (options_.contents == Contents::kAnimation) continue;
        if (options_.draco != nullptr) continue;
        return {StatusCode::kUnsupported, "the meshes are compressed with Draco",
                "extensionsRequired", "decompress it with 'furrow character import'"};
      }
      if (std::find(std::begin(kHarmless), std::end(kHarmless), name) == std::end(kHarmless)) {
        result_.warnings.push_back("extensionsRequired: the extension " + Quoted(name) +
                                   " is not supported and is ignored (" + RemedyFor(name) + ")");
      }
    }
    return {};
  }

  Status ReadBuffers() {
    const Json& buffers = Array(json_, "buffers");
    if (buffers.size() > kMaxBuffers) {
      return {StatusCode::kLimit, "more than " + std::to_string(kMaxBuffers) + " buffers",
              "buffers"};
    }
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      const std::string field = Entry("buffers", i);
      std::uint64_t length = 0;
      if (!ReadUnsigned(buffers[i], "byteLength", 0, &length) || length == 0) {
        return {StatusCode::kSchema, "expected a length of at least 1 byte", field + ".byteLength"};
      }
      if (IsMeshoptFallback(buffers[i], i)) {
        buffers_.emplace_back();
        continue;
      }
      const Result<std::span<const std::uint8_t>> bytes = ReadBuffer(buffers[i], i, field);
      FURROW_RETURN_IF_ERROR(bytes);
      if (length > bytes->size()) {
        return {StatusCode::kSchema,
                "states " + Counted(length, "byte") + ", the buffer has " +
                    Counted(bytes->size(), "byte"),
                field + ".byteLength"};
      }
      // Counts the loaded bytes, not the stated ones: many buffers may name the same large file.
      total += bytes->size();
      if (total > kMaxFileBytes) {
        return {StatusCode::kLimit, "the buffers are larger than 1 GiB together", field};
      }
      // The rest is padding. A GLB's binary chunk may be up to 3 bytes longer than its buffer.
      buffers_.push_back(bytes->first(length));
    }
    return {};
  }

  // The extension of meshopt in an object, or null.
  static const Json* FindMeshopt(const Json& object) {
    const Json* extensions = Find(object, "extensions");
    if (extensions == nullptr) return nullptr;
    const Json* khr = Find(*extensions, "KHR_meshopt_compression");
    return khr != nullptr ? khr : Find(*extensions, "EXT_meshopt_compression");
  }

  // A buffer without bytes, which stands for what compressed views decode to.
  [[nodiscard]] bool IsMeshoptFallback(const Json& buffer, std::size_t index) const {
    const bool has_bytes = index == 0 && container_.has_binary;
    return Find(buffer, "uri") == nullptr && !has_bytes && FindMeshopt(buffer) != nullptr;
  }

  Result<std::span<const std::uint8_t>> ReadBuffer(const Json& buffer, std::size_t index,
                                                   const std::string& field) {
    if (Find(buffer, "uri") == nullptr) {
      if (index != 0 || !container_.has_binary) {
        return Status(StatusCode::kSchema, "has no uri, and the file has no binary chunk", field);
      }
      return std::span(reinterpret_cast<const std::uint8_t*>(container_.binary.data()),
                       container_.binary.size());
    }
    const std::string uri = Text(buffer, "uri");
    Result<std::vector<std::uint8_t>> bytes =
        IsDataUri(uri) ? DecodeDataUri(uri) : ReadExternal(uri);
    if (!bytes.ok()) return bytes.status().At(field + ".uri");
    // The spans point into the vectors' memory, which stays in place when the outer list grows.
    result_.owned_buffers.push_back(std::move(*bytes));
    return std::span<const std::uint8_t>(result_.owned_buffers.back());
  }

  Result<std::vector<std::uint8_t>> ReadExternal(const std::string& uri) const {
    const Result<std::filesystem::path> path = FindExternalFile(uri, options_.folder);
    FURROW_RETURN_IF_ERROR(path);
    const Result<std::string> bytes = ReadFile(*path, kMaxFileBytes);
    FURROW_RETURN_IF_ERROR(bytes);
    return std::vector<std::uint8_t>(bytes->begin(), bytes->end());
  }

  Status ReadBufferViews() {
    const Json* views = Find(json_, "bufferViews");
    if (views == nullptr) return {};
    if (!views->is_array()) return {StatusCode::kSchema, "expected an array", "bufferViews"};
    for (std::size_t i = 0; i < views->size(); ++i) {
      FURROW_RETURN_IF_ERROR(ReadBufferView((*views)[i], Entry("bufferViews", i)));
    }
    return {};
  }

  Status ReadBufferView(const Json& view, const std::string& field) {
    std::uint64_t buffer = 0, offset = 0, length = 0, stride = 0;
    if (!view.is_object()) return {StatusCode::kSchema, "expected an object", field};
    if (const Json* meshopt = FindMeshopt(view); meshopt != nullptr) {
      return ReadMeshoptView(view, *meshopt, field + ".extensions.EXT_meshopt_compression");
    }
    if (!ReadUnsigned(view, "buffer", buffers_.size(), &buffer) || buffer >= buffers_.size()) {
      return {StatusCode::kSchema, "the buffer does not exist", field + ".buffer"};
    }
    if (!ReadUnsigned(view, "byteOffset", 0, &offset)) {
      return {StatusCode::kSchema, "expected an unsigned integer", field + ".byteOffset"};
    }
    if (!ReadUnsigned(view, "byteLength", 0, &length) || length == 0) {
      return {StatusCode::kSchema, "expected a length of at least 1 byte", field + ".byteLength"};
    }
    // glTF 2.0 limits the stride to 252 bytes.
    if (!ReadUnsigned(view, "byteStride", 0, &stride) || stride > kMaxByteStride) {
      return {StatusCode::kSchema, "expected an unsigned integer of at most 252",
              field + ".byteStride"};
    }
    const std::span<const std::uint8_t> bytes = buffers_[buffer];
    // In this order, neither side can overflow.
    if (offset > bytes.size() || length > bytes.size() - offset) {
      return {StatusCode::kSchema, "the view ends after the end of its buffer",
              field + ".byteLength"};
    }
    result_.views.push_back({bytes.subspan(offset, length), stride});
    return {};
  }

  // The view's own buffer holds an uncompressed copy at best, so it is not read.
  Status ReadMeshoptView(const Json& view, const Json& from, const std::string& field) {
    std::uint64_t buffer = 0, offset = 0, length = 0, stride = 0;
    MeshoptView meshopt{.mode = Text(from, "mode"), .filter = Text(from, "filter")};
    const bool read = ReadUnsigned(from, "buffer", buffers_.size(), &buffer) &&
                      ReadUnsigned(from, "byteOffset", 0, &offset) &&
                      ReadUnsigned(from, "byteLength", 0, &length) &&
                      ReadUnsigned(from, "byteStride", 0, &meshopt.stride) &&
                      ReadUnsigned(from, "count", 0, &meshopt.count) &&
                      ReadUnsigned(view, "byteStride", 0, &stride);
    if (!read || buffer >= buffers_.size() || stride > kMaxByteStride) {
      return {StatusCode::kSchema, "expected an existing buffer and unsigned integers", field};
    }
    const std::span<const std::uint8_t> bytes = buffers_[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset) {
      return {StatusCode::kSchema, "the view ends after the end of its buffer",
              field + ".byteLength"};
    }
    meshopt.bytes = bytes.subspan(offset, length);
    Result<std::vector<std::uint8_t>> decoded = DecodeMeshopt(meshopt, field);
    FURROW_RETURN_IF_ERROR(decoded);
    // Many views may name the same compressed bytes.
    decoded_bytes_ += decoded->size();
    if (decoded_bytes_ > kMaxFileBytes) {
      return {StatusCode::kLimit, "the buffers are larger than 1 GiB together", field};
    }
    result_.owned_buffers.push_back(std::move(*decoded));
    result_.views.push_back({result_.owned_buffers.back(), stride});
    return {};
  }

  Status ReadImages() {
    const Json& images = Array(json_, "images");
    if (images.size() > kMaxImages) {
      return {StatusCode::kLimit, "more than " + std::to_string(kMaxImages) + " images", "images"};
    }
    for (std::size_t i = 0; i < images.size(); ++i) {
      ImageSource image{Text(images[i], "name"), Text(images[i], "uri"), -1};
      if (Find(images[i], "bufferView") != nullptr) {
        std::uint64_t view = 0;
        if (!ReadUnsigned(images[i], "bufferView", 0, &view) || view >= result_.views.size()) {
          return {StatusCode::kSchema, "the buffer view does not exist",
                  Entry("images", i) + ".bufferView"};
        }
        image.view = static_cast<int>(view);
      }
      result_.images.push_back(std::move(image));
    }
    return {};
  }

  Status ReadMorphTargets() {
    std::size_t total = 0;
    for (const Json& mesh : Array(json_, "meshes")) {
      MorphTargetSource source;
      for (const Json& primitive : Array(mesh, "primitives")) {
        // Valid files have equally many targets in every primitive of a mesh.
        source.count = std::max(source.count, Array(primitive, "targets").size());
      }
      total += source.count;
      if (source.count > kMaxMorphTargets || total > kMaxAllMorphTargets) {
        return {StatusCode::kLimit,
                "more than " + std::to_string(kMaxMorphTargets) + " morph targets, or more than " +
                    std::to_string(kMaxAllMorphTargets) + " in the file",
                Entry("meshes", result_.morph_targets.size())};
      }
      source.mesh_name = Text(mesh, "name");
      const Json* extras = Find(mesh, "extras");
      // Names are in extras.targetNames by convention; some exporters write them into the mesh
      // itself.
      for (const Json& name : Array(extras != nullptr ? *extras : mesh, "targetNames")) {
        if (source.names.size() == source.count) break;
        source.names.push_back(name.is_string() ? name.get<std::string>() : std::string());
      }
      result_.morph_targets.push_back(std::move(source));
    }
    return {};
  }

  // Of VRM's extensions, characters need the human bones, the expressions, look-at and MToon's
  // textures.
  static void KeepVrm(const Json& extensions, Json* reduced) {
    constexpr std::pair<const char*, const char*> kParts[] = {
        {"VRM", "blendShapeMaster"}, {"VRM", "materialProperties"}, {"VRM", "firstPerson"},
        {"VRM", "humanoid"},         {"VRMC_vrm", "expressions"},   {"VRMC_vrm", "humanoid"},
        {"VRMC_vrm", "lookAt"}};
    for (const auto& [name, part] : kParts) {
      const Json* vrm = Find(extensions, name);
      const Json* kept = vrm != nullptr ? Find(*vrm, part) : nullptr;
      if (kept != nullptr) (*reduced)["extensions"][name][part] = *kept;
    }
  }

  // Copies what the reader needs. tinygltf parses extensions of nodes and accessors strictly, and
  // this code uses none of them, so only those of materials and VRM's at the root stay.
  void WriteReducedJson() {
    static constexpr const char* kAnimationParts[] = {"nodes", "skins", "animations", "accessors"};
    static constexpr const char* kCharacterParts[] = {
        "nodes", "skins", "meshes", "accessors", "materials", "textures", "scenes"};
    const bool animation = options_.contents == Contents::kAnimation;
    const std::span<const char* const> parts =
        animation ? std::span<const char* const>(kAnimationParts) : kCharacterParts;
    Json reduced = {{"asset", {{"version", "2.0"}}}};
    for (const char* part : parts) {
      const auto found = json_.find(part);
      if (found == json_.end()) continue;
      Json& list = reduced[part] = std::move(*found);
      if (!list.is_array() || std::string_view(part) == "materials") continue;
      for (Json& entry : list) {
        if (entry.is_object()) entry.erase("extensions");
      }
    }
    const Json* extensions = Find(json_, "extensions");
    const Json* vrm =
        extensions != nullptr && animation ? Find(*extensions, "VRMC_vrm_animation") : nullptr;
    if (vrm != nullptr) reduced["extensions"]["VRMC_vrm_animation"] = *vrm;
    if (extensions != nullptr && !animation) KeepVrm(*extensions, &reduced);
    AddViewStandIns(&reduced);
    // Replaces malformed UTF-8, for which dump() would throw.
    result_.json = reduced.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

  // Textures name their WebP image in an extension, beside a PNG or JPEG for other readers or
  // alone.
  void UseTextureExtensions() {
    Json& textures = json_["textures"];
    if (!textures.is_array()) return;
    for (std::size_t i = 0; i < textures.size(); ++i) {
      const Json* extensions = Find(textures[i], "extensions");
      if (extensions == nullptr || Find(textures[i], "source") != nullptr) continue;
      const Json* webp = Find(*extensions, "EXT_texture_webp");
      const Json* source = webp != nullptr ? Find(*webp, "source") : nullptr;
      if (source != nullptr && source->is_number_unsigned()) {
        textures[i]["source"] = Json(*source);
      } else if (extensions->is_object() && !extensions->empty()) {
        result_.warnings.push_back(Entry("textures", i) + ": the extension " +
                                   Quoted(extensions->begin().key()) +
                                   " is not supported and the texture is left out; export PNG, "
                                   "JPEG or WebP textures");
      }
    }
  }

  // tinygltf rejects primitives whose accessor refers to a buffer view that it does not know.
  void AddViewStandIns(Json* reduced) const {
    if (result_.views.empty()) return;
    const Json view = {{"buffer", 0}, {"byteLength", 1}};
    (*reduced)["bufferViews"] = Json(result_.views.size(), view);
  }

  const Container& container_;
  const OpenOptions& options_;
  Json json_;
  std::vector<std::span<const std::uint8_t>> buffers_;
  std::uint64_t decoded_bytes_ = 0;  // of compressed views
  RawDocument result_;
};

}  // namespace

Result<RawDocument> ReadRawDocument(const Container& container, const OpenOptions& options) {
  return RawReader(container, options).Run();
}

}  // namespace furrow::gltf
