// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/mesh/unwrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// A triangle in its own plane, with the cotangent of the angle opposite each edge (k, k + 1).
struct FlatTriangle {
  std::array<int, 3> corner;
  std::array<vec2, 3> place;
  std::array<float, 3> weight;
};

float Cross(const vec2& a, const vec2& b) { return a.x * b.y - a.y * b.x; }

// Lays a triangle into its own plane without distortion: the shape that the fit tries to keep.
FlatTriangle Flatten(const QuadNet& net, const std::array<int, 3>& corner) {
  FlatTriangle t;
  t.corner = corner;
  vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = net.points[net.corners[corner[k]].point].place;
  const vec3 side = p[1] - p[0];
  const float length = std::max(glm::length(side), 1e-6f);
  const vec3 other = p[2] - p[0];
  const float along = glm::dot(other, side) / length;
  const float across = glm::length(glm::cross(side, other)) / length;
  // Texture coordinates grow downward, so counter-clockwise triangles are flipped.
  t.place = {vec2(0.0f), vec2(length, 0.0f), vec2(along, -across)};
  for (int k = 0; k < 3; ++k) {
    const vec2 a = t.place[k] - t.place[(k + 2) % 3];
    const vec2 b = t.place[(k + 1) % 3] - t.place[(k + 2) % 3];
    const float cotangent = glm::dot(a, b) / std::max(std::abs(Cross(a, b)), 1e-10f);
    t.weight[k] = std::clamp(cotangent, 0.02f, 20.0f);  // keeps the fit positive definite
  }
  return t;
}

// The least-squares fit to rotated triangles: a Laplacian, solved by conjugate gradients from the
// current corners.
class Fit {
 public:
  Fit(const std::vector<FlatTriangle>& triangles, std::vector<QuadNet::Corner>* corners)
      : triangles_(triangles), corners_(corners), diagonal_(corners->size(), 0.0f) {
    for (const FlatTriangle& t : triangles_) {
      for (int k = 0; k < 3; ++k) {
        diagonal_[t.corner[k]] += t.weight[k];
        diagonal_[t.corner[(k + 1) % 3]] += t.weight[k];
      }
    }
  }

  // Both steps of the method: Residual() finds the best rotation of each triangle, and conjugate
  // gradients with a diagonal preconditioner fit the corners to the rotated triangles. A fit that
  // stops early is improved by the next step.
  void Step() {
    const std::size_t n = corners_->size();
    std::vector<vec2> x(n), r(n), d(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = (*corners_)[i].uv;
    r = Residual(x);
    const auto precondition = [&](std::size_t i) {
      return diagonal_[i] > 0.0f ? r[i] / diagonal_[i] : vec2(0.0f);
    };
    double rho = 0.0;
    for (std::size_t i = 0; i < n; ++i) d[i] = precondition(i), rho += glm::dot(r[i], d[i]);
    for (int round = 0; round < 60 && rho > 1e-14; ++round) {
      const std::vector<vec2> ad = Laplacian(d);
      double dad = 0.0;
      for (std::size_t i = 0; i < n; ++i) dad += glm::dot(d[i], ad[i]);
      const auto alpha = static_cast<float>(rho / dad);
      double next = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        x[i] += alpha * d[i];
        r[i] -= alpha * ad[i];
        next += glm::dot(r[i], precondition(i));
      }
      const auto beta = static_cast<float>(next / rho);
      for (std::size_t i = 0; i < n; ++i) d[i] = precondition(i) + beta * d[i];
      rho = next;
    }
    for (std::size_t i = 0; i < n; ++i) (*corners_)[i].uv = x[i];
  }

 private:
  // The matrix of the fit times `x`, without storing the matrix. It does not depend on rotations.
  // Moving a whole panel changes nothing, so each panel stays where it starts.
  std::vector<vec2> Laplacian(const std::vector<vec2>& x) const {
    std::vector<vec2> out(x.size(), vec2(0.0f));
    for (const FlatTriangle& t : triangles_) {
      for (int k = 0; k < 3; ++k) {
        const int a = t.corner[k], b = t.corner[(k + 1) % 3];
        const vec2 pull = t.weight[k] * (x[a] - x[b]);
        out[a] += pull;
        out[b] -= pull;
      }
    }
    return out;
  }

  // The residual for every triangle at its best rotation.
  std::vector<vec2> Residual(const std::vector<vec2>& x) const {
    std::vector<vec2> out(x.size(), vec2(0.0f));
    for (const FlatTriangle& t : triangles_) {
      vec2 turn(0.0f);  // cosine and sine of the rotation, unnormalised
      for (int k = 0; k < 3; ++k) {
        const vec2 have = x[t.corner[k]] - x[t.corner[(k + 1) % 3]];
        const vec2 want = t.place[k] - t.place[(k + 1) % 3];
        turn += t.weight[k] * vec2(glm::dot(want, have), Cross(want, have));
      }
      const float length = glm::length(turn);
      turn = length > 0.0f ? turn / length : vec2(1.0f, 0.0f);
      for (int k = 0; k < 3; ++k) {
        const int a = t.corner[k], b = t.corner[(k + 1) % 3];
        const vec2 want = t.place[k] - t.place[(k + 1) % 3];
        const vec2 turned(turn.x * want.x - turn.y * want.y, turn.y * want.x + turn.x * want.y);
        const vec2 pull = t.weight[k] * (turned - (x[a] - x[b]));
        out[a] += pull;
        out[b] -= pull;
      }
    }
    return out;
  }

  const std::vector<FlatTriangle>& triangles_;
  std::vector<QuadNet::Corner>* corners_;
  std::vector<float> diagonal_;
};

struct Box {
  vec2 low{std::numeric_limits<float>::max()};
  vec2 high{std::numeric_limits<float>::lowest()};
  [[nodiscard]] vec2 size() const { return high - low; }
};

// Places boxes in rows, the tallest first. Returns nothing if they do not fit at this scale.
std::optional<std::vector<vec2>> PlaceInRows(const std::vector<Box>& boxes,
                                             const std::vector<int>& order, float scale,
                                             float margin) {
  std::vector<vec2> places(boxes.size());
  vec2 pen(margin);
  float row = 0.0f;
  for (const int i : order) {
    const vec2 size = boxes[i].size() * scale;
    if (pen.x + size.x + margin > 1.0f) {
      pen = vec2(margin, pen.y + row + margin);
      row = 0.0f;
    }
    if (pen.x + size.x + margin > 1.0f || pen.y + size.y + margin > 1.0f) return std::nullopt;
    places[i] = pen - boxes[i].low * scale;
    pen.x += size.x + margin;
    row = std::max(row, size.y);
  }
  return places;
}

}  // namespace

void FlattenPanels(QuadNet* net) {
  std::vector<FlatTriangle> triangles;
  for (const std::array<int, 4>& quad : net->quads) {
    triangles.push_back(Flatten(*net, {quad[0], quad[1], quad[2]}));
    triangles.push_back(Flatten(*net, {quad[0], quad[2], quad[3]}));
  }
  Fit fit(triangles, &net->corners);
  constexpr int kRounds = 60;
  for (int i = 0; i < kRounds; ++i) fit.Step();
}

std::vector<PanelPlace> PackPanels(float margin, QuadNet* net) {
  std::vector<Box> boxes;
  for (const QuadNet::Corner& corner : net->corners) {
    if (corner.panel >= static_cast<int>(boxes.size())) boxes.resize(corner.panel + 1);
    Box& box = boxes[corner.panel];
    box.low = glm::min(box.low, corner.uv);
    box.high = glm::max(box.high, corner.uv);
  }
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return boxes[a].size().y > boxes[b].size().y; });
  // Bisection for the largest common scale, so that all panels have the same texel density.
  float fits = 0.0f;
  float too_large = 10.0f;
  std::vector<vec2> places;
  for (int i = 0; i < 24; ++i) {
    const float scale = 0.5f * (fits + too_large);
    const std::optional<std::vector<vec2>> found = PlaceInRows(boxes, order, scale, margin);
    (found ? fits : too_large) = scale;
    if (found) places = *found;
  }
  std::vector<PanelPlace> panels;
  for (const vec2& place : places) panels.push_back({place, fits});
  for (QuadNet::Corner& corner : net->corners) {
    corner.uv = panels[corner.panel].place + fits * corner.uv;
  }
  return panels;
}

}  // namespace furrow::authoring
