// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/document.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <tiny_gltf.h>

#include "base/text.h"
#include "gltf/container/glb.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

Status ParseModel(const std::string& json, tinygltf::Model* model) {
  std::string error;
  std::string warning;
  bool parsed = false;
  try {  // tinygltf throws on members of an unexpected type
    parsed = tinygltf::TinyGLTF().LoadASCIIFromString(model, &error, &warning, json.data(),
                                                      static_cast<unsigned int>(json.size()), "",
                                                      tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (parsed) return {};
  return {StatusCode::kSchema, "the file is not valid glTF: " + FirstLine(error), "json"};
}

}  // namespace

Document::Document(RawDocument raw, OpenOptions options)
    : raw_(std::move(raw)),
      options_(std::move(options)),
      model_(std::make_unique<tinygltf::Model>()) {}
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;
Document::~Document() = default;

Result<Document> Document::Open(std::string_view bytes, const OpenOptions& options) {
  const Result<Container> container = SplitContainer(bytes);
  FURROW_RETURN_IF_ERROR(container);
  Result<RawDocument> raw = ReadRawDocument(*container, options);
  FURROW_RETURN_IF_ERROR(raw);
  Document document(std::move(*raw), options);
  FURROW_RETURN_IF_ERROR(ParseModel(document.raw_.json, document.model_.get()));
  // Frees the memory; clear() would keep it.
  std::string().swap(document.raw_.json);
  return document;
}

std::size_t Document::NumMorphTargets(int mesh) const {
  if (mesh < 0 || static_cast<std::size_t>(mesh) >= raw_.morph_targets.size()) return 0;
  return raw_.morph_targets[static_cast<std::size_t>(mesh)].count;
}

std::vector<std::string> Document::MorphTargetNames(int mesh) const {
  std::vector<std::string> names;
  if (NumMorphTargets(mesh) == 0) return names;
  const MorphTargetSource& source = raw_.morph_targets[static_cast<std::size_t>(mesh)];
  // Blend shapes need names; unnamed ones are numbered per mesh.
  const std::string prefix = source.mesh_name.empty() ? "mesh_" + std::to_string(mesh)
                                                      : source.mesh_name.substr(0, kMaxNameBytes);
  for (std::size_t i = 0; i < source.count; ++i) {
    const bool named = i < source.names.size() && !source.names[i].empty();
    names.push_back(named ? source.names[i] : prefix + "." + std::to_string(i));
  }
  return names;
}

std::string Document::SceneName() const {
  return model_->scenes.empty() ? std::string() : model_->scenes.front().name;
}

void Document::Warn(const std::string& field, const std::string& what) {
  raw_.warnings.push_back(field + ": " + what);
}

std::vector<std::string> Document::warnings() const {
  const std::size_t shown = std::min(raw_.warnings.size(), kMaxWarnings);
  std::vector<std::string> warnings(raw_.warnings.begin(),
                                    raw_.warnings.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < raw_.warnings.size()) {
    warnings.push_back(Counted(raw_.warnings.size() - shown, "more warning"));
  }
  return warnings;
}

}  // namespace furrow::gltf
