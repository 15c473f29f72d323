// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/collar_net.h"

#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/clothes/cloth_panels.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// A row of the collar: height above the neckline and distance from the neck, metres.
struct Row {
  float up;
  float out;
};

constexpr Row kStand[] = {{-0.004f, 0.000f}, {0.014f, 0.0005f}, {0.026f, 0.001f}};
constexpr Row kLining[] = {{0.030f, -0.0015f}, {0.029f, -0.004f}, {0.002f, -0.004f}};

// A point of the neckline with the local frame of the collar.
struct Foot {
  vec3 place;
  vec3 out;
  float front;  // 1 at the middle of the front, 0 at the sides and behind
};

std::vector<Foot> Feet(const std::vector<int>& neckline, const QuadNet& net) {
  vec3 middle(0.0f);
  for (std::size_t i = 0; i + 1 < neckline.size(); ++i) middle += net.points[neckline[i]].place;
  middle /= static_cast<float>(neckline.size() - 1);
  std::vector<Foot> feet;
  for (const int point : neckline) {
    const vec3 place = net.points[point].place;
    vec3 out = place - middle;
    out.y = 0.0f;
    out = glm::normalize(out);
    feet.push_back({place, out, Smoothstep(0.2f, 1.0f, out.z)});
  }
  return feet;
}

vec3 At(const Foot& foot, const Row& row) {
  return foot.place + foot.out * (row.out + 0.002f * foot.front * row.up / 0.03f) +
         vec3(0.0f, row.up * (1.0f - 0.12f * foot.front), 0.0f);
}

// Moves a point so that it is at least `height` above the shirt.
vec3 Above(const Solid& shirt, float height, const vec3& place) {
  const float lack = height - shirt(place);
  return lack > 0.0f ? place + SolidNormal(shirt, place) * lack : place;
}

}  // namespace

void AddCollar(const Solid& shirt, const std::vector<int>& neckline, QuadNet* net) {
  const std::vector<Foot> feet = Feet(neckline, *net);
  const int count = static_cast<int>(feet.size());
  const auto add = [&](int point, const vec3& place) {
    const int index = net->AddPoint(place);
    net->points[index].skin = net->points[neckline[point]].skin;
    return index;
  };
  // Stand and lining, close around the neck.
  const auto band = [&](std::span<const Row> rows, int panel) {
    PointGrid grid(static_cast<int>(rows.size()), count);
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c + 1 < count; ++c) grid.At(r, c) = add(c, At(feet[c], rows[r]));
      grid.At(r, count - 1) = grid.At(r, 0);
    }
    AddPatch(grid, panel, false, {}, net);
  };
  band(kStand, kCollarStand);
  band(kLining, kCollarLining);

  // The leaf folds down over the stand, from one collar point around to the other. Its edge turns
  // under. Rows run from the edge up.
  constexpr int kLeafRows = 6;
  PointGrid leaf(kLeafRows, count - 2);
  for (int c = 1; c + 1 < count; ++c) {
    const Foot& foot = feet[c];
    // The collar points reach farther down and forward, and spread apart.
    const float end = Smoothstep(0.45f, 1.0f, foot.front);
    const float drop = 0.040f + 0.022f * end;
    const float spread = 0.010f + 0.006f * end;
    const Row rows[kLeafRows] = {{0.032f - drop, spread - 0.0025f},
                                 {0.0305f - drop, spread},
                                 {0.030f - 0.62f * drop, 0.75f * spread + 0.002f},
                                 {0.030f - 0.25f * drop, 0.45f * spread + 0.002f},
                                 {0.032f, 0.0035f},
                                 {0.031f, -0.0005f}};
    const vec3 aside(foot.place.x < 0.0f ? -1.0f : 1.0f, 0.0f, 0.0f);
    for (int r = 0; r < kLeafRows; ++r) {
      const float down = (0.032f - rows[r].up) / 0.06f;
      const vec3 place = At(foot, rows[r]) + aside * (0.012f * end * down);
      leaf.At(r, c - 1) = add(c, Above(shirt, r == 0 ? 0.003f : 0.0045f, place));
    }
  }
  AddPatch(leaf, kCollarLeaf, false, {}, net);
}

}  // namespace furrow::authoring
