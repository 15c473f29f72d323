// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

#include "base/status.h"

// A glTF file opened safely; private to motion/'s glTF reader.
namespace furrow::motion {

// A verified model: every node, mesh, skin, animation index within it
// is in range and the nodes form a forest. Only what animation needs
// was kept; `model().meshes`, materials and pictures are empty.
class GltfDocument {
 public:
  // See ParseGltfAnimation() for what is accepted.
  [[nodiscard]] static Result<GltfDocument> Open(std::string_view bytes,
                                                 std::string_view source_name,
                                                 const std::filesystem::path& folder);

  [[nodiscard]] const tinygltf::Model& model() const { return model_; }
  [[nodiscard]] int num_nodes() const { return static_cast<int>(model_.nodes.size()); }
  // Parent of every node, or -1.
  [[nodiscard]] const std::vector<int>& parents() const { return parents_; }
  // Nodes parents first, depth first, in the file's order of children.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }
  // Names of the morph targets of a mesh; empty for -1.
  [[nodiscard]] const std::vector<std::string>& MorphTargets(int mesh) const;

  // An accessor's elements as floats; integers must be normalised.
  // `type` is TINYGLTF_TYPE_*. `field` names the user of the accessor
  // in errors. What one document hands out in all is bounded.
  [[nodiscard]] Result<std::vector<float>> ReadFloats(int accessor, int type,
                                                      const std::string& field);

  [[nodiscard]] Status Error(StatusCode code, const std::string& field, std::string what) const;

 private:
  Status LinkNodes();
  Status CheckNodes() const;
  Status CheckAnimations() const;
  // Start of the accessor's first element; `stride` between elements.
  Result<const unsigned char*> Locate(const tinygltf::Accessor& accessor, std::size_t element_bytes,
                                      const std::string& field, std::size_t* stride) const;

  std::string source_name_;
  tinygltf::Model model_;
  std::vector<std::vector<std::string>> morph_targets_;  // a mesh
  std::vector<int> parents_;
  std::vector<int> order_;
  std::size_t floats_read_ = 0;
};

}  // namespace furrow::motion
