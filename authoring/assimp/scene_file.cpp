// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/scene_file.h"

#include <algorithm>
#include <cstdio>
#include <new>
#include <optional>
#include <unordered_set>

#include <assimp/IOSystem.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>

#include "authoring/assimp/collada_text.h"

namespace furrow::authoring {
namespace {

// Denies access to files. The model is in memory, and files that it names are not opened.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

template <class T>
std::optional<T> Metadata(const aiScene& scene, const char* key) {
  T value{};
  if (scene.mMetaData != nullptr && scene.mMetaData->Get(key, value)) return value;
  return std::nullopt;
}

// Returns the steps that assimp runs after reading.
unsigned Configure(Purpose purpose, Assimp::Importer* importer) {
  const bool animation = purpose == Purpose::kAnimation;
  importer->SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, animation);
  importer->SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  if (!animation) {
    return aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
           aiProcess_ValidateDataStructure;
  }
  for (const char* key : {AI_CONFIG_IMPORT_FBX_READ_MATERIALS, AI_CONFIG_IMPORT_FBX_READ_TEXTURES,
                          AI_CONFIG_IMPORT_FBX_READ_CAMERAS, AI_CONFIG_IMPORT_FBX_READ_LIGHTS}) {
    importer->SetPropertyBool(key, false);
  }
  return 0;
}

// False for two nodes of one name below `node`.
bool NamesDiffer(const aiNode& node, std::unordered_set<std::string>* names) {
  if (!names->insert(node.mName.C_Str()).second) return false;
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    if (!NamesDiffer(*node.mChildren[c], names)) return false;
  return true;
}

// Collada gives nodes an id and a name: "Rig_hips" and "hips". Names are what people see and what
// skeleton maps know, but only ids are unique for certain, and assimp addresses nodes by one of the
// two.
const aiScene* ReadByNames(std::string_view bytes, unsigned steps, const std::string& extension,
                           Assimp::Importer* importer) {
  for (const bool names : {true, false}) {
    importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, names);
    const aiScene* scene =
        importer->ReadFileFromMemory(bytes.data(), bytes.size(), steps, extension.c_str() + 1);
    if (scene == nullptr || scene->mRootNode == nullptr || !names) return scene;
    std::unordered_set<std::string> taken;
    if (extension != ".dae" || NamesDiffer(*scene->mRootNode, &taken)) return scene;
  }
  return nullptr;
}

}  // namespace

Result<const aiScene*> ReadScene(std::string_view bytes, const std::string& extension,
                                 Purpose purpose, Assimp::Importer* importer) {
  if (extension.size() < 2 || !importer->IsExtensionSupported(extension)) {
    return Status(StatusCode::kUnsupported, "unknown file extension '" + OneLine(extension) + "'",
                  {},
                  "supported formats: glTF (.glb, .gltf, .vrm), FBX, Collada (.dae) and the other "
                  "formats of assimp");
  }
  // assimp would make a body of sticks of it.
  if (purpose == Purpose::kModel && extension == ".bvh") {
    return Status(StatusCode::kUnsupported, "the file is a recording, not a model", {},
                  "play it with 'furrow play', or draw it with 'furrow render'");
  }
  importer->SetIOHandler(new NoFiles);  // which owns it
  const unsigned steps = Configure(purpose, importer);
  const bool is_collada = extension == ".dae";
  const std::string collada = is_collada ? WithoutBlanksBeforeNumbers(bytes) : std::string();
  const aiScene* scene =
      ReadByNames(is_collada ? std::string_view(collada) : bytes, steps, extension, importer);
  if (scene != nullptr && scene->mRootNode != nullptr) return scene;
  const std::string reason = importer->GetErrorString();
  // assimp catches the exception and keeps its text.
  if (reason.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  return Status(StatusCode::kParse,
                "is not readable as " + extension.substr(1) + ": " + OneLine(reason), {},
                "check that the file is complete and has this format");
}

wrinkle::Transform SpaceOf(const aiScene& scene, std::vector<std::string>* remarks) {
  wrinkle::Transform space;
  const std::optional<int> up = Metadata<int>(scene, "UpAxis");
  const float sign = static_cast<float>(Metadata<int>(scene, "UpAxisSign").value_or(1));
  constexpr float kHalf = 0.70710678f;
  if (up == 0) space.rotation = glm::quat(kHalf, 0.0f, 0.0f, sign * kHalf);
  if (up == 2) space.rotation = glm::quat(kHalf, -sign * kHalf, 0.0f, 0.0f);
  if (up == 0 || up == 2) {
    remarks->push_back(std::string("the file states ") + (up == 0 ? "X" : "Z") +
                       " as up; rotated to +Y up");
  }
  const std::optional<double> exact = Metadata<double>(scene, "UnitScaleFactor");
  const float centimetres = exact ? static_cast<float>(*exact)
                                  : Metadata<float>(scene, "UnitScaleFactor").value_or(100.0f);
  if (centimetres > 1e-6f && centimetres < 1e6f && centimetres != 100.0f) {
    space.scale = glm::vec3(0.01f * centimetres);
    char unit[32];
    std::snprintf(unit, sizeof unit, "%.6g", static_cast<double>(centimetres));
    remarks->push_back("the file's unit is " + std::string(unit) + " cm; converted to metres");
  }
  return space;
}

std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text.substr(0, 300);
}

}  // namespace furrow::authoring
