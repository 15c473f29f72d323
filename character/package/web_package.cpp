// SPDX-License-Identifier: Apache-2.0
#include "character/package/web_package.h"

#include <string>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "character/package/package.h"
#include "gltf/container/glb.h"
#include "gltf/container/json_guard.h"
#include "gltf/limits.h"

namespace furrow::character {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// The member `name` of an object, or null.
Json Member(const Json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? *found : Json();
}

// The extra `furrow_source` of the first scene that has one, or null.
Result<Json> ReadSource(std::string_view bytes) {
  const auto container = gltf::SplitContainer(bytes);
  FURROW_RETURN_IF_ERROR(container);
  FURROW_RETURN_IF_ERROR(gltf::CheckJsonSize(container->json));
  const Json root = Json::parse(container->json, nullptr, /*allow_exceptions=*/false);
  if (root.is_discarded()) return Status(StatusCode::kParse, "malformed JSON");
  for (const Json& scene : Member(root, "scenes")) {
    Json source = Member(Member(scene, "extras"), "furrow_source");
    if (!source.is_null()) return source;
  }
  return Json();
}

// True if `stated` describes the content of `file`.
Result<bool> Describes(const Json& stated, const fs::path& file) {
  const auto bytes = ReadFile(file, gltf::kMaxFileBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  return Member(stated, "bytes") == bytes->size() && Member(stated, "fnv1a") == Checksum(*bytes);
}

Status Check(const fs::path& web, const fs::path& glb) {
  const auto bytes = ReadFile(web, kMaxWebPackageBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  const auto source = ReadSource(*bytes);
  FURROW_RETURN_IF_ERROR(source);
  if (source->is_null()) return {StatusCode::kSchema, "does not state what it was made of"};
  for (const auto& [name, file] : {std::pair("character", glb), {"rig", RigBeside(glb)}}) {
    const auto describes = Describes(Member(*source, name), file);
    FURROW_RETURN_IF_ERROR(describes);
    if (!*describes) {
      return {StatusCode::kInvalidArgument,
              "was made of another version of " + file.filename().string()};
    }
  }
  return {};
}

}  // namespace

fs::path WebPackageBeside(const fs::path& glb) {
  return glb.parent_path() / (glb.stem().string() + ".web.glb");
}

Status CheckWebPackage(const fs::path& web, const fs::path& glb) {
  const Status status = Check(web, glb);
  if (status.ok()) return status;
  return {status.code(), status.what(), web.string(),
          "make it again: pack_character.mjs " + glb.string() + " " + web.string()};
}

std::uint32_t Checksum(std::string_view bytes) {
  std::uint32_t value = 0x811c9dc5;
  for (const char byte : bytes) value = (value ^ static_cast<std::uint8_t>(byte)) * 0x01000193;
  return value;
}

}  // namespace furrow::character
