// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/face_skin.h"

#include <algorithm>
#include <array>
#include <map>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kHeadPerEyes = 3.6f;  // a head of 230 mm, pupils 64 mm apart
constexpr float kLeastMove = 1e-4f;   // of the head's height: less is not a motion
constexpr float kLeastEyes = 1e-6f;   // metres

// The number of vertices that shapes with a weight move.
std::size_t CountMoved(const character::Mesh& mesh, std::span<const float> weights) {
  std::vector<bool> moved(mesh.vertices.size(), false);
  for (const character::MorphTarget& target : mesh.morph_targets) {
    if (weights[static_cast<std::size_t>(target.shape)] == 0.0f) continue;
    for (const character::MorphDelta& delta : target.deltas) {
      if (glm::length(delta.position) > 0.0f) moved[delta.vertex] = true;
    }
  }
  return static_cast<std::size_t>(std::count(moved.begin(), moved.end(), true));
}

vec3 ArgMax(std::span<const vec3> positions, const std::vector<vec3>& moves) {
  std::size_t best = 0;
  for (std::size_t v = 0; v < moves.size(); ++v) {
    if (glm::length(moves[v]) > glm::length(moves[best])) best = v;
  }
  return positions[best];
}

}  // namespace

Result<FaceSkin> FaceSkin::Create(const character::Character& character, const ArkitFace& face) {
  if (!HasShapeFace(face)) {
    return Status(StatusCode::kNotFound,
                  "the blend shapes browInnerUp, browDown, eyeBlink and mouthSmile are not all "
                  "there",
                  character.name,
                  "name the shapes as ARKit does, or as another vocabulary of docs/SHAPES.md");
  }
  FaceSkin skin;
  skin.character_ = &character;
  skin.face_ = &face;
  skin.FindMeshes();
  if (skin.meshes_.empty()) {
    return Status(StatusCode::kNotFound, "no mesh is moved by both browDown and mouthSmile",
                  character.name, "check that the blend shapes move the skin of the head");
  }
  skin.Weld();
  FURROW_RETURN_IF_ERROR(skin.MeasureEyes());
  return skin;
}

void FaceSkin::FindMeshes() {
  const auto& meshes = character_->meshes;
  using Both = std::array<ArkitFace::Coefficient, 2>;
  const auto brow_shapes = face_->Weights(Both{{{"browDownLeft", 1.0f}, {"browDownRight", 1.0f}}});
  const auto mouth_shapes =
      face_->Weights(Both{{{"mouthSmileLeft", 1.0f}, {"mouthSmileRight", 1.0f}}});
  std::size_t most = 0;
  int best = -1;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const std::size_t brows = CountMoved(meshes[m], brow_shapes);
    const std::size_t mouth = CountMoved(meshes[m], mouth_shapes);
    // A beard or a mask that moves with both is smaller than the skin below it.
    if (std::min(brows, mouth) <= most) continue;
    most = std::min(brows, mouth);
    best = static_cast<int>(m);
  }
  if (best < 0) return;
  material_ = meshes[static_cast<std::size_t>(best)].material;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const bool same = material_ >= 0 && meshes[m].material == material_;
    if (same || static_cast<int>(m) == best) meshes_.push_back(static_cast<int>(m));
  }
}

void FaceSkin::Weld() {
  std::map<std::array<float, 3>, std::uint32_t> at;
  for (const int index : meshes_) {
    const character::Mesh& mesh = character_->meshes[static_cast<std::size_t>(index)];
    std::vector<std::uint32_t>& welded = welded_.emplace_back();
    for (const character::Vertex& vertex : mesh.vertices) {
      const vec3 p = vertex.position + vec3(0.0f);  // -0 becomes 0
      const auto [place, fresh] =
          at.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(positions_.size()));
      if (fresh) positions_.push_back(p);
      welded.push_back(place->second);
    }
  }
  neighbours_.resize(positions_.size());
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const auto& indices = character_->meshes[static_cast<std::size_t>(meshes_[m])].indices;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      const std::uint32_t a = welded_[m][indices[i]], b = welded_[m][indices[next]];
      if (a == b) continue;
      neighbours_[a].push_back(b);
      neighbours_[b].push_back(a);
    }
  }
  for (std::vector<std::uint32_t>& list : neighbours_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

Status FaceSkin::MeasureEyes() {
  const std::vector<vec3> left = AllMoves("eyeBlinkLeft"), right = AllMoves("eyeBlinkRight");
  if (!left.empty() && !right.empty()) {
    const vec3 a = ArgMax(positions_, left), b = ArgMax(positions_, right);
    middle_ = 0.5f * (a.x + b.x);
    eye_distance_ = a.x - b.x;
  }
  if (eye_distance_ > kLeastEyes) return {};
  return {StatusCode::kNotFound, "eyeBlinkLeft and eyeBlinkRight do not close two eyes",
          character_->name, "the character must face +Z, and its left eye must be at the larger x"};
}

// Seams weld to one vertex, whose halves have equal deltas; the last one counts.
std::vector<vec3> FaceSkin::AllMoves(std::string_view name) const {
  const std::vector<float> weights = face_->Weights(name);
  std::vector<vec3> moves(positions_.size(), vec3(0.0f));
  bool any = false;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const character::Mesh& mesh = character_->meshes[static_cast<std::size_t>(meshes_[m])];
    std::vector<vec3> of_mesh(mesh.vertices.size(), vec3(0.0f));
    for (const character::MorphTarget& target : mesh.morph_targets) {
      const float weight = weights[static_cast<std::size_t>(target.shape)];
      if (weight == 0.0f) continue;
      any = true;
      for (const character::MorphDelta& d : target.deltas) of_mesh[d.vertex] += weight * d.position;
    }
    for (std::size_t v = 0; v < of_mesh.size(); ++v) {
      if (of_mesh[v] != vec3(0.0f)) moves[welded_[m][v]] = of_mesh[v];
    }
  }
  return any ? moves : std::vector<vec3>();
}

std::vector<std::array<std::uint32_t, 3>> FaceSkin::Triangles() const {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const auto& indices = character_->meshes[static_cast<std::size_t>(meshes_[m])].indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      triangles.push_back(
          {welded_[m][indices[i]], welded_[m][indices[i + 1]], welded_[m][indices[i + 2]]});
    }
  }
  return triangles;
}

std::vector<vec3> FaceSkin::Moves(std::string_view name) const {
  std::vector<vec3> moves = AllMoves(name);
  const float least = kLeastMove * kHeadPerEyes * eye_distance_;
  const bool moved = std::any_of(moves.begin(), moves.end(),
                                 [&](const vec3& move) { return glm::length(move) >= least; });
  return moved ? moves : std::vector<vec3>();
}

}  // namespace furrow::authoring
