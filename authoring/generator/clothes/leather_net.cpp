// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/leather_net.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/body/body_skinning.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kAround = 20;  // columns of a shoe at level 0

// The shape of a left shoe by z, metres: half width of the sole, height of the ridge.
constexpr Knot kWidth[] = {
    {-0.083f, 0.000f}, {-0.080f, 0.014f}, {-0.070f, 0.026f}, {-0.050f, 0.0325f}, {-0.020f, 0.0345f},
    {0.020f, 0.0360f}, {0.060f, 0.0410f}, {0.100f, 0.0465f}, {0.130f, 0.0460f},  {0.160f, 0.0395f},
    {0.180f, 0.0300f}, {0.193f, 0.0175f}, {0.199f, 0.000f}};
constexpr Knot kRidge[] = {{-0.045f, 0.112f}, {0.005f, 0.112f}, {0.03f, 0.100f}, {0.06f, 0.083f},
                           {0.09f, 0.070f},   {0.12f, 0.0605f}, {0.145f, 0.055f}};
constexpr float kWelt = 0.020f;  // height where upper and sole meet

class ShoeMaker {
 public:
  ShoeMaker(const BodyShape& shape, float side, int panel, QuadNet* net)
      : shape_(shape),
        side_(side),
        panel_(panel),
        net_(net),
        f_(1 << shape.parameters().level),
        columns_(kAround * f_),
        middle_(shape.skeleton().rest_model()[shape.skeleton().Find("foot_l")][3].x) {}

  void Make() {
    MakeUpper();
    MakeSole();
    for (QuadNet::Point& point : net_->points) {
      point.place.x *= side_;
      point.skin = ShoeInfluences(shape_, point.place);
    }
  }

 private:
  // The outline of the sole as (x, z), from the toe over the outer side to the heel and back.
  vec2 Outline(int k) const {
    const float turn = 2.0f * kPi * static_cast<float>(k) / static_cast<float>(columns_);
    const float z = 0.058f + 0.141f * std::cos(turn);
    const float half = Interpolate(kWidth, z);
    return {MiddleX(z) + (std::sin(turn) >= 0.0f ? half : -half), z};
  }

  float MiddleX(float z) const {  // feet turn out slightly, toes turn in again
    return middle_ + 0.075f * std::max(z, 0.0f) - 0.35f * std::max(z, 0.0f) * std::max(z, 0.0f);
  }

  vec3 UpperPlace(int k, float t) const {
    const vec2 edge = Outline(k);
    const float z = std::clamp(edge.y, -0.045f, 0.145f);
    const vec2 ridge(MiddleX(z), z);
    const float angle = 0.5f * kPi * t;
    const vec2 place =
        glm::mix(edge, ridge, 1.0f - std::pow(std::max(std::cos(angle), 0.0f), 0.85f));
    const float rise = std::pow(std::sin(angle), 0.9f);
    return {place.x, kWelt + (Interpolate(kRidge, z) - kWelt) * rise, place.y};
  }

  // Both sides share the points on the middle line. At its ends several columns share one point.
  int OnRidge(const vec3& place, std::map<long, int>* ridge) {
    const auto [found, is_new] = ridge->emplace(std::lround(place.z * 1e5f), 0);
    if (is_new) found->second = net_->AddPoint(place);
    return found->second;
  }

  void MakeUpper() {
    const int rows = 5 * f_;
    PointGrid grid(rows + 1, columns_ + 1);
    std::map<long, int> ridge;
    for (int r = 0; r <= rows; ++r) {
      const float t = static_cast<float>(r) / static_cast<float>(rows);
      for (int k = 0; k < columns_; ++k) {
        grid.At(r, k) =
            r == rows ? OnRidge(UpperPlace(k, t), &ridge) : net_->AddPoint(UpperPlace(k, t));
      }
      grid.At(r, columns_) = grid.At(r, 0);
    }
    LayDisk(grid, panel_, true, 1.6f);
  }

  void MakeSole() {
    const auto ring = [&](int k, float out, float y) {
      const vec2 edge = Outline(k);
      const vec2 from(MiddleX(std::clamp(edge.y, -0.045f, 0.145f)),
                      std::clamp(edge.y, -0.045f, 0.145f));
      const vec2 place = edge + glm::normalize(edge - from) * out;
      return vec3(place.x, y, place.y);
    };
    const auto ground = [](float z) {  // the sole is raised in front of the heel
      return 0.013f * Smoothstep(-0.026f, -0.018f, z) * Smoothstep(0.075f, 0.02f, z);
    };
    PointGrid grid(5, columns_ + 1);
    std::map<long, int> ridge;
    for (int k = 0; k < columns_; ++k) {
      const float low = ground(Outline(k).y);
      const float z = std::clamp(Outline(k).y, -0.045f, 0.145f);
      const vec3 places[] = {ring(k, -0.002f, kWelt + 0.001f), ring(k, 0.004f, kWelt),
                             ring(k, 0.0035f, low + 0.002f), ring(k, 0.001f, low),
                             vec3(MiddleX(z), ground(z), z)};
      for (int r = 0; r < 5; ++r) {
        grid.At(r, k) = r == 4 ? OnRidge(places[r], &ridge) : net_->AddPoint(places[r]);
      }
    }
    for (int r = 0; r < 5; ++r) grid.At(r, columns_) = grid.At(r, 0);
    LayDisk(grid, panel_ + 1, false, 1.3f);
  }

  // Adds quads for a grid with closed rows, seen from above or below. Their first UVs are the plan
  // view, with the rim `spread` times as far from the middle line.
  void LayDisk(const PointGrid& grid, int panel, bool from_above, float spread) {
    std::map<int, int> corners;
    const auto corner = [&](int r, int k) {
      const auto [found, is_new] =
          corners.emplace(grid.At(r, k), static_cast<int>(net_->corners.size()));
      if (is_new) {
        const vec2 edge = Outline(k);
        const float z = std::clamp(edge.y, -0.045f, 0.145f);
        const vec2 ridge(MiddleX(z), z);
        const float t = static_cast<float>(grid.rows - 1 - r) / static_cast<float>(grid.rows - 1);
        const vec2 plan = ridge + (edge - ridge) * (spread * t);
        const float u = plan.x * side_;
        net_->corners.push_back({grid.At(r, k), panel, {u, from_above ? plan.y : -plan.y}});
      }
      return found->second;
    };
    for (int r = 0; r + 1 < grid.rows; ++r) {
      for (int k = 0; k + 1 < grid.columns; ++k) {
        std::array<int, 4> quad = {corner(r, k), corner(r, k + 1), corner(r + 1, k + 1),
                                   corner(r + 1, k)};
        // Columns run from the toe over the left side, clockwise from above. The mirrored shoe runs
        // the other way.
        if ((side_ > 0.0f) != from_above) std::swap(quad[1], quad[3]);
        net_->quads.push_back(quad);
      }
    }
  }

  const BodyShape& shape_;
  float side_;
  int panel_;
  QuadNet* net_;
  int f_;
  int columns_;
  float middle_;
};

}  // namespace

QuadNet MakeShoe(const BodyShape& shape, float side, int panel) {
  QuadNet net;
  ShoeMaker(shape, side, panel, &net).Make();
  return net;
}

QuadNet MakeBelt(const BodyShape& shape, int panel) {
  QuadNet net;
  const int columns = 36 << shape.parameters().level;
  const Solid trousers = [&](const vec3& p) { return shape.Trousers(p); };
  struct Row {
    float y;
    float out;
  };
  // Bottom to top: the belt rises from the cloth, is flat outside and returns to the cloth.
  constexpr Row kRows[] = {
      {1.006f, 0.0005f}, {1.0065f, 0.0042f}, {1.037f, 0.0045f}, {1.0375f, 0.0f}};
  PointGrid grid(4, columns + 1);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < columns; ++c) {
      const float turn = 2.0f * kPi * static_cast<float>(c) / static_cast<float>(columns);
      const vec3 out(std::sin(turn + kPi), 0.0f, std::cos(turn + kPi));  // the seam is at the back
      const vec3 place = CastOut(trousers, {0, kRows[r].y, 0}, out, 0.4f) + out * kRows[r].out;
      grid.At(r, c) = net.AddPoint(place);
      net.points.back().skin = TrouserInfluences(shape, place);
    }
    grid.At(r, columns) = grid.At(r, 0);
  }
  AddPatch(grid, panel, false, {}, &net);

  // The buckle: a plate with bevelled edges.
  const vec3 front = CastOut(trousers, {0, 1.0215f, 0}, {0, 0, 1}, 0.4f);
  constexpr float kAcross[] = {-0.024f, -0.0225f, 0.0225f, 0.024f};
  constexpr float kUp[] = {-0.0185f, -0.017f, 0.017f, 0.0185f};
  PointGrid buckle(4, 4);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      const bool rim = r % 3 == 0 || c % 3 == 0;
      const vec3 place = front + vec3(kAcross[c], kUp[r], rim ? 0.0f : 0.0085f);
      buckle.At(r, c) = net.AddPoint(place);
      net.points.back().skin = TrouserInfluences(shape, vec3(0.0f, place.y, place.z));
    }
  }
  AddPatch(buckle, panel + 1, false, {}, &net);
  return net;
}

}  // namespace furrow::authoring
