// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/contained_jaw.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "rig/shapes/shape_meaning.h"

namespace furrow::authoring {
namespace {

using wrinkle::ShapeRule;

constexpr float kFar = 0.5f;    // of the farthest move: what an opening jaw carries along
constexpr float kChin = 0.25f;  // the lowest part of that, of its height
constexpr float kShare = 0.5f;  // of jawOpen's move at the chin

// A vertex that jawOpen moves.
struct Moved {
  float height;
  glm::vec3 by_jaw;
  glm::vec3 by_close{0.0f};
};

std::vector<Moved> VerticesOf(std::span<const character::Mesh> meshes, int jaw, int close) {
  std::vector<Moved> moved;
  for (const character::Mesh& mesh : meshes) {
    std::vector<glm::vec3> by_jaw(mesh.vertices.size(), glm::vec3(0.0f));
    std::vector<glm::vec3> by_close = by_jaw;
    for (const character::MorphTarget& target : mesh.morph_targets) {
      if (target.shape != jaw && target.shape != close) continue;
      auto& moves = target.shape == jaw ? by_jaw : by_close;
      for (const character::MorphDelta& delta : target.deltas) {
        moves[delta.vertex] = delta.position;
      }
    }
    for (std::size_t v = 0; v < by_jaw.size(); ++v) {
      if (by_jaw[v] != glm::vec3(0.0f)) {
        moved.push_back({mesh.vertices[v].position.y, by_jaw[v], by_close[v]});
      }
    }
  }
  return moved;
}

// How far mouthClose moves the chin, as a share of jawOpen's move and in its direction.
float ShareAtChin(std::vector<Moved> moved) {
  float farthest = 0.0f;
  for (const Moved& one : moved) farthest = std::max(farthest, glm::length(one.by_jaw));
  std::erase_if(moved, [&](const Moved& one) { return glm::length(one.by_jaw) < kFar * farthest; });
  if (moved.empty()) return 0.0f;
  const auto [lowest, highest] = std::ranges::minmax_element(moved, {}, &Moved::height);
  const float top = lowest->height + kChin * (highest->height - lowest->height);
  double along = 0.0;
  double all = 0.0;
  for (const Moved& one : moved) {
    if (one.height > top) continue;
    along += static_cast<double>(glm::dot(one.by_close, one.by_jaw));
    all += static_cast<double>(glm::dot(one.by_jaw, one.by_jaw));
  }
  return all > 0.0 ? static_cast<float>(along / all) : 0.0f;
}

}  // namespace

bool NoteContainedJaw(const rig::ShapeMatcher& matcher, character::Character* character) {
  const rig::ShapeMeanings meanings = matcher.MeaningsOf(character->shapes);
  const int jaw = meanings.Find("jawOpen");
  const int close = meanings.Find("mouthClose");
  if (jaw < 0 || close < 0) return false;
  if (ShareAtChin(VerticesOf(character->meshes, jaw, close)) < kShare) return false;
  const auto shape = static_cast<std::uint32_t>(close);
  auto rule = std::ranges::find(character->shape_rules, shape, &ShapeRule::shape);
  if (rule == character->shape_rules.end()) {
    rule = character->shape_rules.insert(rule, ShapeRule{.shape = shape});
  }
  rule->contains = static_cast<std::uint32_t>(jaw);
  return true;
}

}  // namespace furrow::authoring
