// SPDX-License-Identifier: Apache-2.0
// MakeHuman's meshes, garments and skeletons: indices are in range, and numbers are finite.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/makehuman/formats/mhclo.h"
#include "authoring/import/makehuman/formats/mhskel.h"
#include "authoring/import/makehuman/formats/obj.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kVertices = 100;

void Require(bool holds) {
  if (!holds) std::abort();
}

bool IsFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The base mesh: points on a line.
std::vector<glm::vec3> BaseMesh() {
  std::vector<glm::vec3> positions;
  for (std::size_t i = 0; i < kVertices; ++i) positions.emplace_back(0.01f * static_cast<float>(i));
  return positions;
}

void CheckMesh(const ObjMesh& mesh) {
  for (const glm::vec3& position : mesh.positions) Require(IsFinite(position));
  for (const ObjMesh::Corner& corner : mesh.corners) {
    Require(corner.position < mesh.positions.size());
    Require(corner.uv >= -1 && corner.uv < static_cast<std::int64_t>(mesh.uvs.size()));
  }
  for (const ObjMesh::Face& face : mesh.faces) {
    Require(face.num_corners >= 3);
    Require(std::size_t{face.first_corner} + face.num_corners <= mesh.corners.size());
    Require(face.group < mesh.groups.size());
  }
}

void CheckGarment(const Mhclo& garment) {
  Require(garment.deleted.size() <= kVertices);
  for (const Mhclo::GarmentVertex& vertex : garment.vertices) {
    for (const std::uint32_t base : vertex.base) Require(base < kVertices);
  }
  Require(garment.obj_file.find('/') == std::string::npos);
  Require(FitGarment(garment, BaseMesh()).size() == garment.vertices.size());
}

}  // namespace
}  // namespace furrow::authoring

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::authoring;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto mesh = ParseObj(text, "fuzz.obj"); mesh.ok()) CheckMesh(*mesh);
  if (const auto garment = ParseMhclo(text, "fuzz.mhclo", kVertices); garment.ok()) {
    CheckGarment(*garment);
  }
  if (const auto weights = ParseMhw(text, "fuzz.mhw"); weights.ok()) {
    for (const MhWeights::Joint& joint : weights->joints) {
      for (const auto& [vertex, weight] : joint.vertices) Require(weight >= 0.0f && weight <= 1.0f);
    }
  }
  if (const auto skeleton = ParseMhskel(text, "fuzz.mhskel"); skeleton.ok()) {
    (void)BuildSkeleton(*skeleton, BaseMesh(), "fuzz.mhskel");
  }
  return 0;
}
