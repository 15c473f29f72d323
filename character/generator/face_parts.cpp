// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "character/generator/head_grid.h"
#include "character/generator/head_mesh.h"
#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kPi = std::numbers::pi_v<float>;

void AddVertex(HeadMesh* head, const HeadVertex& info, const vec2& uv) {
  Vertex vertex;
  vertex.position = HeadToModel(info.place);
  vertex.uv = uv;
  head->mesh.vertices.push_back(vertex);
  head->info.push_back(info);
}

// The edge of a lid from the inner to the outer corner, on the skin.
std::vector<vec3> LidEdge(const HeadGrid& grid, float side, bool upper) {
  const std::vector<glm::ivec2> outline = grid.EyeOutline();
  const std::size_t half = outline.size() / 2;
  std::vector<vec3> edge;
  for (std::size_t i = 0; i <= half; ++i) {
    const glm::ivec2 v = outline[upper ? (outline.size() - i) % outline.size() : i];
    edge.push_back(grid.Surface(grid.Warped(side > 0.0f ? v.x : -v.x, v.y)));
  }
  return edge;
}

vec3 Along(const std::vector<vec3>& line, float t) {
  const float at = t * static_cast<float>(line.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), line.size() - 2);
  return glm::mix(line[i], line[i + 1], at - static_cast<float>(i));
}

// One lash: a narrow strip of three joints that tapers to a point. `cell` places its UVs.
void AddLash(const vec3& root, const vec3& out, const vec3& curl, const vec3& across, float length,
             float eye_side, int cell, HeadMesh* lashes) {
  const auto first = static_cast<std::uint32_t>(lashes->mesh.vertices.size());
  constexpr float kHalf[] = {0.012f, 0.009f, 0.002f};
  const vec2 corner(static_cast<float>(cell % 16) / 16.0f, static_cast<float>(cell / 16) / 16.0f);
  for (int k = 0; k < 3; ++k) {
    const float t = 0.5f * static_cast<float>(k);
    const vec3 middle = root + length * (out * t + curl * (t * t));
    for (const float s : {-1.0f, 1.0f}) {
      HeadVertex info;
      info.part = kLash;
      info.eye_side = eye_side;
      info.place = middle + across * (s * kHalf[k]);
      AddVertex(lashes, info, corner + vec2(0.03f + 0.02f * s, 0.005f + 0.05f * t));
    }
  }
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t a = first + 2 * k;
    AddQuad(&lashes->mesh, a, a + 1, a + 3, a + 2);
  }
}

void AddLashRow(const HeadGrid& grid, float side, bool upper, int* cell, HeadMesh* lashes) {
  const std::vector<vec3> edge = LidEdge(grid, side, upper);
  const vec3 centre = EyeCentre(side);
  const int count = upper ? 46 : 24;
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + 0.7f) / (static_cast<float>(count) + 0.4f);
    const float stray = Hash(i, upper, side > 0.0f) - 0.5f;
    // On the edge of the lid, just outside the ball.
    const vec3 skin = Along(edge, t);
    const vec3 root =
        centre + glm::normalize(skin - centre) * (glm::distance(skin, centre) - 0.05f);
    const vec3 fan(side * (1.3f * (t - 0.4f) + 0.35f * stray), 0.0f, 0.0f);
    const float rise = upper ? 0.15f : -0.35f;
    const vec3 out = glm::normalize(vec3(0, rise, 1.0f) + fan);
    const vec3 curl(0, upper ? 0.55f : -0.15f, -0.1f);
    const float length = (upper ? 0.55f : 0.22f) *
                         (0.55f + 0.45f * std::sin(kPi * std::min(t + 0.12f, 1.0f))) *
                         (0.85f + 0.3f * Hash(i, 3, upper));
    const vec3 across = glm::normalize(glm::cross(out, vec3(0, 1, 0)));
    AddLash(root, out, curl, across, length, upper ? 1.0f : -1.0f, (*cell)++, lashes);
  }
}

// Half widths of the teeth from the middle outward, centimetres: incisors, canine, premolars,
// molars.
constexpr float kUpperTeeth[] = {0.43f, 0.33f, 0.38f, 0.35f, 0.34f, 0.50f, 0.48f};
constexpr float kLowerTeeth[] = {0.27f, 0.29f, 0.34f, 0.35f, 0.35f, 0.52f, 0.50f};

// Which tooth stands at arc length `s` from the middle, and where on it, [-1, 1].
struct OnTooth {
  int tooth;
  float across;
};

OnTooth ToothAt(float s, bool upper) {
  float start = 0.0f;
  for (int i = 0; i < 7; ++i) {
    const float half = upper ? kUpperTeeth[i] : kLowerTeeth[i];
    if (s < start + 2.0f * half || i == 6) return {i, (s - start) / half - 1.0f};
    start += 2.0f * half;
  }
  return {6, 1.0f};
}

// A row of teeth on an elliptic arch, with gums, seen from the front alone.
void AddTeethRow(bool upper, HeadMesh* teeth) {
  constexpr int kSteps = 72;      // on either side
  constexpr float kStep = 0.06f;  // centimetres of arc
  // Heights from the biting edge, where the crown ends and the gum begins.
  constexpr float kHeights[] = {0.0f, 0.06f, 0.25f, 0.55f, 0.8f, 0.92f, 1.05f, 1.5f};
  constexpr int kRows = static_cast<int>(std::size(kHeights));
  const auto first = static_cast<std::uint32_t>(teeth->mesh.vertices.size());
  const float edge = upper ? -7.12f : -7.2f;
  const float half_width = upper ? 2.75f : 2.5f;
  const float half_depth = upper ? 4.2f : 4.0f;
  const float front = upper ? 8.95f : 8.7f;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const float s = kStep * static_cast<float>(i);
    // The ellipse by its angle; arc length grows faster than the angle toward the sides.
    const float angle = std::atan2(s / half_width, 1.0f - 0.055f * s * s);
    const auto [tooth, across] = ToothAt(std::abs(s), upper);
    const float round = 1.0f - std::pow(std::abs(across), 5.0f);
    const bool canine = tooth == 2;
    for (int r = 0; r < kRows; ++r) {
      const float h = kHeights[r];
      const float gum = SmoothStep(0.80f, 0.95f, h + 0.12f * (1.0f - round));
      const float crown = 0.055f * round * (1.0f - gum) - (h < 0.05f ? 0.12f : 0.0f);
      const float out = crown + 0.05f * gum - 0.05f * SmoothStep(0.6f, 0.0f, h);
      const float worn = (canine ? -0.05f * (1.0f - std::abs(across)) : 0.05f * (1.0f - round)) +
                         (tooth == 1 ? 0.06f : 0.0f);
      const float lift = (h + worn * SmoothStep(0.5f, 0.0f, h)) * (upper ? 1.0f : -1.0f);
      HeadVertex info;
      info.part = kTeeth;
      info.mouth_side = upper ? 1.0f : -1.0f;
      info.place = vec3((half_width + out) * std::sin(angle), edge + lift,
                        front - half_depth + (half_depth + out) * std::cos(angle));
      AddVertex(teeth, info,
                {0.01f + 0.98f * (0.5f + 0.5f * static_cast<float>(i) / kSteps),
                 (upper ? 0.49f - 0.48f * h / 1.5f : 0.51f + 0.48f * h / 1.5f)});
    }
  }
  const auto index = [&](int i, int r) {
    return first + static_cast<std::uint32_t>(i * kRows + r);
  };
  for (int i = 0; i < 2 * kSteps; ++i) {
    for (int r = 0; r + 1 < kRows; ++r) {
      if (upper) {
        AddQuad(&teeth->mesh, index(i, r), index(i + 1, r), index(i + 1, r + 1), index(i, r + 1));
      } else {
        AddQuad(&teeth->mesh, index(i, r + 1), index(i + 1, r + 1), index(i + 1, r), index(i, r));
      }
    }
  }
}

}  // namespace

HeadMesh MakeLashes(const HeadShape& shape) {
  HeadMesh lashes;
  lashes.mesh.name = "lashes";
  const HeadGrid grid(shape);
  int cell = 0;
  for (const float side : {1.0f, -1.0f}) {
    AddLashRow(grid, side, true, &cell, &lashes);
    AddLashRow(grid, side, false, &cell, &lashes);
  }
  FinishSurface(&lashes.mesh);
  return lashes;
}

HeadMesh MakeTeeth() {
  HeadMesh teeth;
  teeth.mesh.name = "teeth";
  AddTeethRow(true, &teeth);
  AddTeethRow(false, &teeth);
  FinishSurface(&teeth.mesh);
  return teeth;
}

}  // namespace furrow::character::generator
