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

const character::MorphTarget* TargetOf(const character::Mesh& mesh, int shape) {
  const auto found = std::find_if(mesh.morph_targets.begin(), mesh.morph_targets.end(),
                                  [&](const auto& target) { return target.shape == shape; });
  return found == mesh.morph_targets.end() ? nullptr : &*found;
}

// The number of vertices that one of two shapes moves.
std::size_t CountMoved(const character::Mesh& mesh, int left, int right) {
  std::size_t count = 0;
  for (const int shape : {left, right}) {
    const character::MorphTarget* target = shape < 0 ? nullptr : TargetOf(mesh, shape);
    if (target == nullptr) continue;
    count += static_cast<std::size_t>(
        std::count_if(target->deltas.begin(), target->deltas.end(),
                      [](const auto& delta) { return glm::length(delta.position) > 0.0f; }));
  }
  return count;
}

vec3 ArgMax(std::span<const vec3> positions, const std::vector<vec3>& moves) {
  std::size_t best = 0;
  for (std::size_t v = 0; v < moves.size(); ++v) {
    if (glm::length(moves[v]) > glm::length(moves[best])) best = v;
  }
  return positions[best];
}

}  // namespace

bool HasShapeFace(const ShapeFinder& find) {
  constexpr const char* kNeeded[] = {"browInnerUp",    "browDownLeft",  "browDownRight",
                                     "eyeBlinkLeft",   "eyeBlinkRight", "mouthSmileLeft",
                                     "mouthSmileRight"};
  return std::all_of(std::begin(kNeeded), std::end(kNeeded),
                     [&](const char* name) { return find(name) >= 0; });
}

Result<FaceSkin> FaceSkin::Create(const character::Character& character, const ShapeFinder& find) {
  if (!HasShapeFace(find)) {
    return Status(StatusCode::kNotFound,
                  "the blend shapes browInnerUp, browDown, eyeBlink and mouthSmile are not all "
                  "there",
                  character.name, "name the shapes as ARKit does");
  }
  FaceSkin skin;
  skin.character_ = &character;
  skin.find_ = find;
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
  std::size_t most = 0;
  int best = -1;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const std::size_t brows = CountMoved(meshes[m], find_("browDownLeft"), find_("browDownRight"));
    const std::size_t mouth =
        CountMoved(meshes[m], find_("mouthSmileLeft"), find_("mouthSmileRight"));
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
  const int shape = find_(name);
  if (shape < 0) return {};
  std::vector<vec3> moves(positions_.size(), vec3(0.0f));
  bool any = false;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const character::MorphTarget* target =
        TargetOf(character_->meshes[static_cast<std::size_t>(meshes_[m])], shape);
    if (target == nullptr) continue;
    any = true;
    for (const character::MorphDelta& d : target->deltas) moves[welded_[m][d.vertex]] = d.position;
  }
  return any ? moves : std::vector<vec3>();
}

std::vector<vec3> FaceSkin::Moves(std::string_view name) const {
  std::vector<vec3> moves = AllMoves(name);
  const float least = kLeastMove * kHeadPerEyes * eye_distance_;
  const bool moved = std::any_of(moves.begin(), moves.end(),
                                 [&](const vec3& move) { return glm::length(move) >= least; });
  return moved ? moves : std::vector<vec3>();
}

}  // namespace furrow::authoring
