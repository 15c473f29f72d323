// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/face_parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/head/lid_strips.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/noise.h"
#include "authoring/paint/teeth.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// The point at the share `t` of the vertices of a line.
vec3 Along(const std::vector<vec3>& line, float t) {
  const float at = t * static_cast<float>(line.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), line.size() - 2);
  return glm::mix(line[i], line[i + 1], at - static_cast<float>(i));
}

// Adds one lash: a strip with three cross-sections, wider than the hair that PaintLash() paints on
// it.
void AddLash(const vec3& root, const vec3& out, const vec3& curl, const vec3& across, float length,
             float eye_side, HeadMesh* lashes) {
  const auto first = static_cast<std::uint32_t>(lashes->mesh.vertices.size());
  constexpr float kHalf = 0.036f;
  for (int k = 0; k < 3; ++k) {
    const float t = 0.5f * static_cast<float>(k);
    const vec3 middle = root + length * (out * t + curl * (t * t));
    for (const float s : {-1.0f, 1.0f}) {
      HeadVertex info;
      info.part = kLash;
      info.root = root;
      info.eye_side = eye_side;
      info.place = middle + across * (s * kHalf);
      AddHeadVertex(lashes, info, vec2(0.5f + 0.49f * s, 0.01f + 0.98f * t));
    }
  }
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t a = first + 2 * k;
    AddQuad(&lashes->mesh, a, a + 1, a + 3, a + 2);
  }
}

void AddLashRow(const HeadGrid& grid, float side, bool upper, HeadMesh* lashes) {
  const std::vector<vec3> edge = LidEdge(grid, side, upper);
  const vec3 centre = EyeCentre(side);
  const int count = upper ? 46 : 24;
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + 0.7f) / (static_cast<float>(count) + 0.4f);
    const float stray = RandomAt(i, upper, side > 0.0f) - 0.5f;
    // On the edge of the lid, just outside the eyeball.
    const vec3 skin = Along(edge, t);
    const vec3 root =
        centre + glm::normalize(skin - centre) * (glm::distance(skin, centre) - 0.05f);
    const vec3 fan(side * (1.3f * (t - 0.4f) + 0.35f * stray), 0.0f, 0.0f);
    const float rise = upper ? 0.15f : -0.35f;
    const vec3 out = glm::normalize(vec3(0, rise, 1.0f) + fan);
    const vec3 curl(0, upper ? 0.55f : -0.15f, -0.1f);
    const float length = (upper ? 0.55f : 0.22f) *
                         (0.55f + 0.45f * std::sin(kPi * std::min(t + 0.12f, 1.0f))) *
                         (0.85f + 0.3f * RandomAt(i, 3, upper));
    const vec3 across = glm::normalize(glm::cross(out, vec3(0, 1, 0)));
    AddLash(root, out, curl, across, length, upper ? 1.0f : -1.0f, lashes);
  }
}

// Teeth belong to the skull or to the jaw; mouth_side says which.
void AddTeethRow(const ToothArch& arch, HeadMesh* teeth) {
  const ToothRow row = MakeToothRow(arch);
  const auto first = static_cast<std::uint32_t>(teeth->mesh.vertices.size());
  for (std::size_t i = 0; i < row.positions.size(); ++i) {
    HeadVertex info;
    info.part = kTeeth;
    info.mouth_side = arch.upper ? 1.0f : -1.0f;
    info.place = row.positions[i];
    AddHeadVertex(teeth, info, row.uvs[i]);
  }
  for (std::size_t i = 0; i < row.quads.size(); i += 4) {
    const auto corner = [&](std::size_t k) { return first + row.quads[i + k]; };
    AddQuad(&teeth->mesh, corner(0), corner(1), corner(2), corner(3));
  }
}

// A sphere with a bulge for the cornea. Rings are dense at the edge of the bulge, at 31 degrees.
// The sphere ends behind the lids, at 112 degrees. Left and right eye share one picture.
void AddEye(float side, HeadMesh* eyes) {
  constexpr int kSegments = 28;
  constexpr float kAngles[] = {0, 5, 10, 15, 20, 24, 27.5f, 31, 36, 44, 56, 72, 90, 112};
  constexpr int kRings = static_cast<int>(std::size(kAngles));
  const auto first = static_cast<std::uint32_t>(eyes->mesh.vertices.size());
  const vec3 centre = EyeCentre(side);
  for (int i = 0; i < kRings; ++i) {
    const float angle = kAngles[i] * kPi / 180.0f;
    const float cornea = std::max(0.0f, 1.0f - kAngles[i] * kAngles[i] / (31.0f * 31.0f));
    const float radius = kEyeRadius + 0.07f * cornea;
    for (int k = 0; k <= kSegments; ++k) {
      const float turn = 2.0f * kPi * static_cast<float>(k % kSegments) / kSegments;
      const vec3 direction(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                           std::cos(angle));
      HeadVertex info;
      info.part = kEyeball;
      info.place = centre + direction * radius;
      const float spread = 0.48f * kAngles[i] / 112.0f;
      const vec2 uv(0.5f + spread * std::cos(turn), 0.5f - spread * std::sin(turn));
      AddHeadVertex(eyes, info, {(side > 0.0f ? 0.0f : 0.5f) + 0.5f * uv.x, uv.y});
    }
  }
  const auto index = [&](int ring, int k) {
    return first + static_cast<std::uint32_t>(ring * (kSegments + 1) + k);
  };
  for (int i = 0; i + 1 < kRings; ++i) {
    for (int k = 0; k < kSegments; ++k) {
      AddQuad(&eyes->mesh, index(i, k), index(i + 1, k), index(i + 1, k + 1), index(i, k + 1));
    }
  }
}

}  // namespace

HeadMesh MakeEyes() {
  HeadMesh eyes;
  eyes.mesh.name = "eyes";
  AddEye(1.0f, &eyes);
  AddEye(-1.0f, &eyes);
  FinishSurface(&eyes.mesh);
  return eyes;
}

HeadMesh MakeLashes(const HeadShape& shape) {
  HeadMesh lashes;
  lashes.mesh.name = "lashes";
  const HeadGrid grid(shape);
  for (const float side : {1.0f, -1.0f}) {
    AddLashRow(grid, side, true, &lashes);
    AddLashRow(grid, side, false, &lashes);
  }
  FinishSurface(&lashes.mesh);
  return lashes;
}

HeadMesh MakeTongue() {
  constexpr int kTurns = 24, kRings = 10;
  constexpr vec3 kCentre(0.0f, -8.0f, 5.4f), kRadii(1.95f, 0.85f, 2.95f);
  HeadMesh tongue;
  tongue.mesh.name = "tongue";
  for (int ring = 0; ring <= kRings; ++ring) {  // from the tip backward
    const float back = kPi * static_cast<float>(ring) / kRings;
    for (int turn = 0; turn <= kTurns; ++turn) {
      const float around = 2.0f * kPi * static_cast<float>(turn % kTurns) / kTurns;
      const vec3 out(std::sin(back) * std::cos(around), std::sin(back) * std::sin(around),
                     std::cos(back));
      HeadVertex info;
      info.part = kTeeth;
      info.mouth_side = -1.0f;  // follows the jaw
      info.place = kCentre + kRadii * out;
      // The furrow along the middle.
      if (out.y > 0.0f) info.place.y -= 0.16f * out.y * Bump(info.place.x, 0.35f);
      AddHeadVertex(&tongue, info, vec2(turn, ring) / vec2(kTurns, kRings));
    }
  }
  const auto at = [](int ring, int turn) {
    return static_cast<std::uint32_t>(ring * (kTurns + 1) + turn);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int turn = 0; turn < kTurns; ++turn) {
      AddQuad(&tongue.mesh, at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1),
              at(ring, turn + 1));
    }
  }
  FinishSurface(&tongue.mesh);
  return tongue;
}

HeadMesh MakeTeeth() {
  HeadMesh teeth;
  teeth.mesh.name = "teeth";
  AddTeethRow({true, {0.0f, -7.12f, 9.12f}, 2.8f, 4.3f}, &teeth);
  AddTeethRow({false, {0.0f, -6.93f, 8.7f}, 2.5f, 4.0f}, &teeth);
  FinishSurface(&teeth.mesh);
  return teeth;
}

}  // namespace furrow::authoring
