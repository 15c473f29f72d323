// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "gltf/document/raw_document.h"

namespace tinygltf {
class Model;
}

namespace furrow::gltf {

// An open glTF file: JSON parsed, buffers loaded, buffer views in range. The readers in gltf/scene/
// and gltf/animation/ check everything else when they read it.
//
// Every error that gltf/ returns has the field as `where` ("nodes[3].rotation"); callers prefix the
// file's name by Status::Within().
class Document {
 public:
  // The document refers to `bytes`, which must outlive it. Errors: SplitContainer()'s,
  // ReadRawDocument()'s, kSchema (a member of the wrong type).
  [[nodiscard]] static Result<Document> Open(std::string_view bytes, const OpenOptions& options);

  Document(Document&&) noexcept;
  Document& operator=(Document&&) noexcept;
  ~Document();

  // For gltf/ alone. Its buffers and images are empty, its buffer views are stand-ins: see views().
  [[nodiscard]] const tinygltf::Model& model() const { return *model_; }

  [[nodiscard]] std::span<const BufferView> views() const { return raw_.views; }
  [[nodiscard]] std::span<const ImageSource> images() const { return raw_.images; }
  [[nodiscard]] const OpenOptions& options() const { return options_; }
  [[nodiscard]] std::size_t num_meshes() const { return raw_.num_meshes; }

  // The number of a mesh's morph targets: that of its primitive with the most. 0 if `mesh` is -1.
  [[nodiscard]] std::size_t NumMorphTargets(int mesh) const;
  // Their names: `extras.targetNames`, else "<mesh>.<index>". Names may repeat.
  [[nodiscard]] std::vector<std::string> MorphTargetNames(int mesh) const;
  // The nodes that any animation of the file moves, turns or scales, in ascending order; see
  // ListMovingNodes(). A node may be beyond the nodes of the file.
  [[nodiscard]] std::span<const int> moving_nodes() const { return raw_.moving_nodes; }
  // The name of the first scene; may be empty.
  [[nodiscard]] std::string SceneName() const;

  // Adds a warning. Readers call it where they deviate from what the file says.
  void Warn(const std::string& field, const std::string& what);
  // All warnings so far: "field: what". At most kMaxWarnings and one line that counts the rest.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  Document(RawDocument raw, OpenOptions options);

  RawDocument raw_;
  OpenOptions options_;
  std::unique_ptr<tinygltf::Model> model_;
};

}  // namespace furrow::gltf
