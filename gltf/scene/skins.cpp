// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/skins.h"

#include <cmath>
#include <string>

#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include "gltf/document/accessor.h"

namespace furrow::gltf {
namespace {

std::string SkinField(std::size_t skin, const char* member) {
  return "skins[" + std::to_string(skin) + "]" + member;
}

}  // namespace

std::size_t NumSkins(const Document& document) { return document.model().skins.size(); }

Result<std::vector<int>> ReadSkinJoints(const Document& document, std::size_t skin) {
  const std::string where = SkinField(skin, ".joints");
  const std::vector<int>& joints = document.model().skins[skin].joints;
  if (joints.empty()) return Status(StatusCode::kSchema, "the skin has no joints", where);
  for (const int node : joints) {
    if (node < 0 || node >= static_cast<int>(document.model().nodes.size())) {
      return Status(StatusCode::kSchema, "node " + std::to_string(node) + " does not exist", where);
    }
  }
  return joints;
}

Result<std::vector<glm::mat4>> ReadInverseBindMatrices(const Document& document, std::size_t skin) {
  const std::string where = SkinField(skin, ".inverseBindMatrices");
  const tinygltf::Skin& from = document.model().skins[skin];
  // Identity matrices are glTF's default.
  std::vector<glm::mat4> matrices(from.joints.size(), glm::mat4(1.0f));
  if (from.inverseBindMatrices < 0) return matrices;
  const Result<Accessor> accessor =
      Accessor::Create(document, from.inverseBindMatrices, ElementType::kMat4, where);
  FURROW_RETURN_IF_ERROR(accessor);
  if (accessor->size() < matrices.size()) {
    return Status(StatusCode::kSchema, "there are fewer matrices than joints", where);
  }
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    for (int k = 0; k < 16; ++k) {
      float& number = glm::value_ptr(matrices[i])[k];
      number = accessor->Float(i, k);
      if (std::isfinite(number)) continue;
      return Status(StatusCode::kNonFinite, "matrix " + std::to_string(i) + " is not finite",
                    where);
    }
  }
  return matrices;
}

}  // namespace furrow::gltf
