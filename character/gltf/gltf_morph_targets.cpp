// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_morph_targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "character/mesh/morph_normals.h"

namespace furrow::character {
namespace {

using gltf::Accessor;

constexpr float kZeroPart = 1e-7f;  // of the mesh's extent
constexpr float kZeroTurn = 1e-4f;  // of a unit vector

// The length below which a delta does not move a vertex. Relative, because quantised files and
// files in centimetres have other units.
float ZeroLength(const Mesh& mesh) {
  if (mesh.vertices.empty()) return 0.0f;
  glm::vec3 low = mesh.vertices.front().position;
  glm::vec3 high = low;
  for (const Vertex& vertex : mesh.vertices) {
    low = glm::min(low, vertex.position);
    high = glm::max(high, vertex.position);
  }
  const glm::vec3 size = high - low;
  return kZeroPart * std::max({size.x, size.y, size.z});
}

std::vector<bool> UsedVertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const std::uint32_t index : mesh.indices) used[index] = true;
  return used;
}

// Removes deltas that are zero and deltas of vertices without a triangle.
void DropZeroDeltas(const std::vector<bool>& used, float zero, std::vector<MorphDelta>* deltas) {
  std::erase_if(*deltas, [&](MorphDelta& delta) {
    // Not moved at all is exact, so that normals are computed for moved vertices only.
    if (glm::length(delta.position) <= zero) delta.position = glm::vec3(0.0f);
    const bool zero_turn =
        glm::length(delta.normal) <= kZeroTurn && glm::length(delta.tangent) <= kZeroTurn;
    return !used[delta.vertex] || (zero_turn && delta.position == glm::vec3(0.0f));
  });
}

// Steps through the elements of an accessor that may differ from zero, in ascending order.
class Cursor {
 public:
  Cursor(const Accessor& accessor, glm::vec3 MorphDelta::*part)
      : accessor_(&accessor), part_(part) {}

  [[nodiscard]] bool done() const { return next_ == accessor_->num_candidates(); }
  [[nodiscard]] std::size_t element() const { return accessor_->Candidate(next_); }

  // Reads the part of `delta` and goes on, if the accessor has an element for that vertex. False if
  // the element is not finite.
  bool Take(MorphDelta* delta) {
    if (done() || element() != delta->vertex) return true;
    glm::vec3& to = delta->*part_;
    for (int i = 0; i < 3; ++i) to[i] = accessor_->Float(delta->vertex, i);
    ++next_;
    return std::isfinite(to.x) && std::isfinite(to.y) && std::isfinite(to.z);
  }

 private:
  const Accessor* accessor_;
  glm::vec3 MorphDelta::*part_;
  std::size_t next_ = 0;
};

void AddScaled(const std::vector<MorphDelta>& from, float weight, std::vector<MorphDelta>* to) {
  for (MorphDelta delta : from) {
    delta.position *= weight;
    delta.normal *= weight;
    delta.tangent *= weight;
    to->push_back(delta);
  }
}

// One delta per vertex, the sum of those in the list, in ascending order.
void MergeDeltas(std::vector<MorphDelta>* deltas) {
  std::stable_sort(deltas->begin(), deltas->end(),
                   [](const MorphDelta& a, const MorphDelta& b) { return a.vertex < b.vertex; });
  std::vector<MorphDelta> merged;
  for (const MorphDelta& delta : *deltas) {
    if (merged.empty() || merged.back().vertex != delta.vertex) {
      merged.push_back(delta);
      continue;
    }
    merged.back().position += delta.position;
    merged.back().normal += delta.normal;
    merged.back().tangent += delta.tangent;
  }
  *deltas = std::move(merged);
}

// The least element that a cursor has not taken yet.
std::optional<std::size_t> NextElement(const std::vector<Cursor>& cursors) {
  std::optional<std::size_t> next;
  for (const Cursor& cursor : cursors) {
    if (!cursor.done()) next = std::min(next.value_or(cursor.element()), cursor.element());
  }
  return next;
}

}  // namespace

Status GltfMorphTargets::Read(const gltf::Mesh& from, const gltf::Primitive& primitive,
                              const std::string& at, const Base& base, Mesh* mesh) {
  for (const std::string& name : from.morph_target_names) {
    if (is_stated_.insert(name).second) stated_.push_back(name);
  }
  if (primitive.morph_targets.empty()) return {};
  const auto where = [&at](std::size_t i) { return at + ".targets[" + std::to_string(i) + "]"; };
  // All are counted before one is read: a file with too many is refused at once.
  std::vector<std::vector<Part>> parts(primitive.morph_targets.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    FURROW_RETURN_IF_ERROR(
        OpenTarget(primitive.morph_targets[i], where(i), base, *mesh, &parts[i]));
  }
  const float zero = ZeroLength(*mesh);
  const std::vector<bool> used = UsedVertices(*mesh);
  std::vector<Found> found;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const gltf::MorphTarget& target = primitive.morph_targets[i];
    MorphTarget to;
    FURROW_RETURN_IF_ERROR(ReadDeltas(parts[i], where(i), &to.deltas));
    DropZeroDeltas(used, zero, &to.deltas);
    if (to.deltas.empty()) continue;
    to.deltas.shrink_to_fit();
    if (to.deltas.size() > deltas_) {
      return {StatusCode::kLimit, "the morph targets move too many vertices", where(i),
              "reduce the mesh, or the number of its shapes"};
    }
    deltas_ -= to.deltas.size();
    to.shape = ShapeOf(from.morph_target_names[i]);
    if (to.shape < 0) continue;
    found.push_back(
        {std::move(to), static_cast<int>(i), !base.has_normals || target.normal == gltf::kNone});
  }
  FURROW_RETURN_IF_ERROR(AddMixes(from, at, &found));
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.target.shape < b.target.shape; });
  std::vector<bool> lacking;
  std::size_t before = 0;
  for (Found& one : found) {
    before += one.target.deltas.size();
    mesh->morph_targets.push_back(std::move(one.target));
    lacking.push_back(one.lacks_normals);
  }
  Status status = ComputeMorphNormals(lacking, before + deltas_, mesh);
  if (!status.ok()) return status.At(at + ".targets");
  std::size_t after = 0;
  for (const MorphTarget& target : mesh->morph_targets) after += target.deltas.size();
  deltas_ -= after - before;
  return {};
}

Status GltfMorphTargets::AddMixes(const gltf::Mesh& from, const std::string& at,
                                  std::vector<Found>* found) {
  const std::size_t num_targets = found->size();
  for (const gltf::MorphMix& mix : from.mixes) {
    Found sum;
    std::size_t count = 0;
    for (const auto& [index, weight] : mix.targets) {
      for (std::size_t f = 0; f < num_targets; ++f) {
        const Found& part = (*found)[f];
        if (part.index != index) continue;
        count += part.target.deltas.size();
        if (count > deltas_) {
          return {StatusCode::kLimit, "the expressions move too many vertices", at + ".targets",
                  "reduce the mesh, or the number of its expressions"};
        }
        AddScaled(part.target.deltas, weight, &sum.target.deltas);
        sum.lacks_normals |= part.lacks_normals;
      }
    }
    if (sum.target.deltas.empty()) continue;
    MergeDeltas(&sum.target.deltas);
    deltas_ -= sum.target.deltas.size();
    sum.target.shape = ShapeOf(mix.name);
    if (sum.target.shape >= 0) found->push_back(std::move(sum));
  }
  return {};
}

Status GltfMorphTargets::OpenTarget(const gltf::MorphTarget& target, const std::string& at,
                                    const Base& base, const Mesh& mesh, std::vector<Part>* parts) {
  struct Attribute {
    const char* name;
    int accessor;
    glm::vec3 MorphDelta::*member;
  };
  // Deltas of normals and tangents belong to the file's own, not to computed ones.
  const std::array<Attribute, 3> attributes = {{
      {"POSITION", target.position, &MorphDelta::position},
      {"NORMAL", base.has_normals ? target.normal : gltf::kNone, &MorphDelta::normal},
      {"TANGENT", base.has_tangents ? target.tangent : gltf::kNone, &MorphDelta::tangent},
  }};
  for (const Attribute& attribute : attributes) {
    if (attribute.accessor == gltf::kNone) continue;
    const std::string where = at + "." + attribute.name;
    const Result<Accessor> opened =
        Accessor::Create(document_, attribute.accessor, gltf::ElementType::kVec3, where);
    FURROW_RETURN_IF_ERROR(opened);
    if (opened->size() != mesh.vertices.size()) {
      return {StatusCode::kSchema,
              std::to_string(opened->size()) + " elements for " +
                  std::to_string(mesh.vertices.size()) + " vertices",
              where};
    }
    if (opened->num_candidates() > elements_) {
      return {StatusCode::kLimit, "the morph targets have too many vertices together", where,
              "reduce the mesh, or the number of its shapes"};
    }
    elements_ -= opened->num_candidates();
    parts->push_back({attribute.name, *opened, attribute.member});
  }
  return {};
}

Status GltfMorphTargets::ReadDeltas(const std::vector<Part>& parts, const std::string& at,
                                    std::vector<MorphDelta>* deltas) {
  std::vector<Cursor> cursors;
  for (const Part& part : parts) cursors.emplace_back(part.accessor, part.member);
  while (const std::optional<std::size_t> element = NextElement(cursors)) {
    MorphDelta delta{.vertex = static_cast<std::uint32_t>(*element)};
    for (std::size_t i = 0; i < cursors.size(); ++i) {
      if (!cursors[i].Take(&delta)) {
        return {StatusCode::kNonFinite, "vertex " + std::to_string(*element) + " is not finite",
                at + "." + parts[i].name};
      }
    }
    // Most elements of a dense target are zero; DropZeroDeltas() needs the others.
    if (delta.position != glm::vec3(0.0f) || delta.normal != glm::vec3(0.0f) ||
        delta.tangent != glm::vec3(0.0f)) {
      deltas->push_back(delta);
    }
  }
  return {};
}

int GltfMorphTargets::ShapeOf(const std::string& name) {
  const auto found = index_of_.find(name);
  if (found != index_of_.end()) return found->second;
  if (names_.size() == kMaxShapes) {
    surplus_.insert(name);
    return -1;
  }
  names_.push_back(name);
  return index_of_[name] = static_cast<int>(names_.size()) - 1;
}

std::vector<std::string> GltfMorphTargets::idle_names() const {
  std::vector<std::string> idle;
  for (const std::string& name : stated_) {
    if (index_of_.count(name) == 0 && surplus_.count(name) == 0) idle.push_back(name);
  }
  return idle;
}

}  // namespace furrow::character
