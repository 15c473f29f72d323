// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/mesh/quad_net.h"

#include <algorithm>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/mesh/mesh_tools.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// The mean distance between the points of columns (or rows) `i` and `i + 1`.
float MeanStep(const PointGrid& grid, const QuadNet& net, bool along_rows, int i) {
  float sum = 0.0f;
  int count = 0;
  for (int k = 0; k < (along_rows ? grid.columns : grid.rows); ++k) {
    const int a = along_rows ? grid.At(i, k) : grid.At(k, i);
    const int b = along_rows ? grid.At(i + 1, k) : grid.At(k, i + 1);
    if (a < 0 || b < 0) continue;
    sum += glm::distance(net.points[a].place, net.points[b].place);
    ++count;
  }
  return count > 0 ? sum / static_cast<float>(count) : 0.0f;
}

// Creates the midpoints of edges and quads, each once.
class Divider {
 public:
  Divider(const Solid& solid, QuadNet* net) : solid_(solid), net_(net) {}

  // The key is the sorted corners, so both quads of an edge get the same midpoint. Corners are
  // separate per panel, but their points are shared, so seams stay closed.
  int Middle(std::vector<int> corners) {
    std::sort(corners.begin(), corners.end());
    const auto [found, is_new] = corners_.emplace(corners, static_cast<int>(net_->corners.size()));
    if (!is_new) return found->second;
    QuadNet::Corner middle{0, net_->corners[corners[0]].panel, vec2(0.0f)};
    std::vector<int> points;
    for (const int c : corners) {
      middle.uv += net_->corners[c].uv / static_cast<float>(corners.size());
      points.push_back(net_->corners[c].point);
    }
    middle.point = MiddlePoint(std::move(points));
    net_->corners.push_back(middle);
    return found->second;
  }

 private:
  // The midpoint of a chord lies inside the solid, so it is moved out to the surface.
  int MiddlePoint(std::vector<int> points) {
    std::sort(points.begin(), points.end());
    const auto [found, is_new] = points_.emplace(points, static_cast<int>(net_->points.size()));
    if (!is_new) return found->second;
    QuadNet::Point middle;
    InfluenceSum sum;
    const float share = 1.0f / static_cast<float>(points.size());
    for (const int i : points) {
      middle.place += net_->points[i].place * share;
      sum.Add(net_->points[i].skin, share);
    }
    middle.place = OnSurface(solid_, middle.place);
    middle.skin = sum.Strongest();
    net_->points.push_back(middle);
    return found->second;
  }

  const Solid& solid_;
  QuadNet* net_;
  std::map<std::vector<int>, int> corners_, points_;
};

}  // namespace

int QuadNet::AddPoint(const vec3& place, float slack) {
  points.push_back({place, slack, {}});
  return static_cast<int>(points.size()) - 1;
}

void AddPatch(const PointGrid& grid, int panel, bool mirrored,
              const std::function<bool(int, int)>& skip, QuadNet* net) {
  std::vector<float> us{0.0f}, vs{0.0f};
  for (int c = 0; c + 1 < grid.columns; ++c) us.push_back(us[c] + MeanStep(grid, *net, false, c));
  for (int r = 0; r + 1 < grid.rows; ++r) vs.push_back(vs[r] - MeanStep(grid, *net, true, r));
  std::vector<int> corner_at(grid.points.size(), -1);
  const auto corner = [&](int row, int column) {
    // A grid point that several cells share becomes one corner.
    int& index = corner_at[row * grid.columns + column];
    if (index < 0) {
      index = static_cast<int>(net->corners.size());
      const float u = mirrored ? -us[column] : us[column];
      net->corners.push_back({grid.At(row, column), panel, vec2(u, vs[row])});
    }
    return index;
  };
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int c = 0; c + 1 < grid.columns; ++c) {
      if (skip && skip(r, c)) continue;
      std::array<int, 4> quad = {corner(r, c), corner(r, c + 1), corner(r + 1, c + 1),
                                 corner(r + 1, c)};
      // Mirroring reverses the winding; swapping restores it.
      if (mirrored) std::swap(quad[1], quad[3]);
      net->quads.push_back(quad);
    }
  }
}

std::vector<std::vector<int>> Neighbours(const QuadNet& net) {
  std::vector<std::vector<int>> neighbours(net.points.size());
  for (const std::array<int, 4>& quad : net.quads) {
    for (int k = 0; k < 4; ++k) {
      const int a = net.corners[quad[k]].point;
      const int b = net.corners[quad[(k + 1) % 4]].point;
      if (a == b) continue;
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
  }
  for (std::vector<int>& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

// All points move at once, from the positions of the round before, so the result does not depend on
// their order.
void Relax(const Solid& solid, int rounds, QuadNet* net) {
  const std::vector<std::vector<int>> neighbours = Neighbours(*net);
  std::vector<vec3> next(net->points.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < net->points.size(); ++i) {
      const QuadNet::Point& point = net->points[i];
      next[i] = point.place;
      if (point.slack <= 0.0f || neighbours[i].empty()) continue;
      vec3 mean(0.0f);
      for (const int n : neighbours[i]) mean += net->points[n].place;
      mean /= static_cast<float>(neighbours[i].size());
      next[i] = OnSurface(solid, glm::mix(point.place, mean, 0.5f * point.slack));
    }
    for (std::size_t i = 0; i < net->points.size(); ++i) net->points[i].place = next[i];
  }
}

void Subdivide(const Solid& solid, QuadNet* net) {
  Divider divider(solid, net);
  std::vector<std::array<int, 4>> fine;
  for (const std::array<int, 4>& q : std::vector<std::array<int, 4>>(net->quads)) {
    const int centre = divider.Middle({q[0], q[1], q[2], q[3]});
    int side[4];
    for (int k = 0; k < 4; ++k) side[k] = divider.Middle({q[k], q[(k + 1) % 4]});
    for (int k = 0; k < 4; ++k) fine.push_back({q[k], side[k], centre, side[(k + 3) % 4]});
  }
  net->quads = std::move(fine);
}

void SmoothInfluences(int rounds, QuadNet* net) {
  const std::vector<std::vector<int>> neighbours = Neighbours(*net);
  std::vector<Influences> next(net->points.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < net->points.size(); ++i) {
      InfluenceSum sum;
      sum.Add(net->points[i].skin, 0.5f);
      const float share = 0.5f / static_cast<float>(std::max<std::size_t>(neighbours[i].size(), 1));
      for (const int n : neighbours[i]) sum.Add(net->points[n].skin, share);
      next[i] = sum.Strongest();
    }
    for (std::size_t i = 0; i < net->points.size(); ++i) net->points[i].skin = next[i];
  }
}

void Join(const QuadNet& from, QuadNet* to) {
  const int points = static_cast<int>(to->points.size());
  const int corners = static_cast<int>(to->corners.size());
  to->points.insert(to->points.end(), from.points.begin(), from.points.end());
  for (QuadNet::Corner corner : from.corners) {
    corner.point += points;
    to->corners.push_back(corner);
  }
  for (std::array<int, 4> quad : from.quads) {
    for (int& index : quad) index += corners;
    to->quads.push_back(quad);
  }
}

void AppendNet(const QuadNet& net, character::Mesh* mesh) {
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  for (const QuadNet::Corner& corner : net.corners) {
    const QuadNet::Point& point = net.points[corner.point];
    character::Vertex vertex;
    vertex.position = point.place;
    vertex.uv = corner.uv;
    point.skin.CopyTo(&vertex);
    mesh->vertices.push_back(vertex);
  }
  for (const std::array<int, 4>& quad : net.quads) {
    AddQuad(mesh, first + quad[0], first + quad[1], first + quad[2], first + quad[3]);
  }
}

}  // namespace furrow::authoring
