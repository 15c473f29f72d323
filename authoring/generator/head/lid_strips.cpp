// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/lid_strips.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// Adds quads between `across` lines of equal length, whose vertices alternate. `flip`: the lines
// run the other way round the face.
void AddStripQuads(std::uint32_t first, std::size_t length, std::uint32_t across, bool flip,
                   HeadMesh* strip) {
  for (std::uint32_t i = 0; i + 1 < length; ++i) {
    for (std::uint32_t k = 0; k + 1 < across; ++k) {
      const std::uint32_t a = first + i * across + k, b = a + across;
      if (flip) {
        AddQuad(&strip->mesh, a, a + 1, b + 1, b);
      } else {
        AddQuad(&strip->mesh, a, b, b + 1, a + 1);
      }
    }
  }
}

// The surface of the liquid is hollow: it rises on the lid and on the eyeball.
void AddTearLine(const HeadGrid& grid, float side, HeadMesh* tears) {
  struct Line {
    float radius;  // from the centre of the eye, centimetres
    float rise;    // above the edge of the lid, on the unit sphere
  };
  constexpr Line kLines[] = {{1.262f, 0.0f}, {1.225f, 0.012f}, {1.212f, 0.045f}};
  constexpr std::uint32_t kAcross = std::size(kLines);
  const std::vector<vec3> edge = LidEdge(grid, side, false);
  const vec3 centre = EyeCentre(side);
  const auto first = static_cast<std::uint32_t>(tears->mesh.vertices.size());
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const float along = static_cast<float>(i) / static_cast<float>(edge.size() - 1);
    for (std::uint32_t k = 0; k < kAcross; ++k) {
      vec3 direction = glm::normalize(edge[i] - centre);
      // The line ends in the corners of the eye.
      direction.y += kLines[k].rise * std::sqrt(std::max(std::sin(kPi * along), 0.0f));
      HeadVertex info;
      info.eye_side = -1.0f;
      info.place = centre + glm::normalize(direction) * kLines[k].radius;
      const float across = static_cast<float>(k) / static_cast<float>(kAcross - 1);
      AddHeadVertex(tears, info, vec2(along, (side > 0.0f ? 0.02f : 0.52f) + 0.46f * across));
    }
  }
  AddStripQuads(first, edge.size(), kAcross, side < 0.0f, tears);
}

// One lid's strip. It follows the lid as a whole, so that a lid that turns about the centre of the
// eye carries it along the eyeball.
void AddLidShade(const HeadGrid& grid, float side, bool upper, HeadMesh* shades) {
  struct Line {
    float reach;  // beyond the edge of the lid, on the unit sphere; negative: under the lid
    float light;  // share that passes
  };
  constexpr Line kUpper[] = {
      {-0.06f, 0.0f}, {0.0f, 0.08f}, {0.10f, 0.42f}, {0.22f, 0.75f}, {0.40f, 1.0f}};
  constexpr Line kLower[] = {
      {-0.06f, 0.4f}, {0.0f, 0.5f}, {0.07f, 0.72f}, {0.14f, 0.88f}, {0.24f, 1.0f}};
  constexpr float kRadius = 1.285f;  // centimetres, just in front of the cornea
  const std::span<const Line> lines = upper ? std::span<const Line>(kUpper) : kLower;
  const std::vector<vec3> edge = LidEdge(grid, side, upper);
  const vec3 centre = EyeCentre(side);
  const auto first = static_cast<std::uint32_t>(shades->mesh.vertices.size());
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const float along = static_cast<float>(i) / static_cast<float>(edge.size() - 1);
    // The corners of the eye are narrow and shaded as a whole.
    const float width = 0.4f + 0.6f * std::sqrt(std::max(std::sin(kPi * along), 0.0f));
    for (const Line& line : lines) {
      vec3 direction = glm::normalize(edge[i] - centre);
      direction.y += (upper ? -width : width) * line.reach;
      HeadVertex info;
      info.part = kLash;
      info.root = edge[i];
      info.eye_side = upper ? 1.0f : -1.0f;
      info.place = centre + kRadius * glm::normalize(direction);
      AddHeadVertex(shades, info, vec2(along, 0.25f + 0.5f * line.light));
    }
  }
  AddStripQuads(first, edge.size(), static_cast<std::uint32_t>(lines.size()),
                upper == (side > 0.0f), shades);
}

}  // namespace

// The edge of a lid on the skin, from the inner to the outer corner.
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

HeadMesh MakeTears(const HeadShape& shape) {
  HeadMesh tears;
  tears.mesh.name = "tears";
  const HeadGrid grid(shape);
  AddTearLine(grid, 1.0f, &tears);
  AddTearLine(grid, -1.0f, &tears);
  FinishSurface(&tears.mesh);
  return tears;
}

HeadMesh MakeLidShades(const HeadShape& shape) {
  HeadMesh shades;
  shades.mesh.name = "lid_shades";
  const HeadGrid grid(shape);
  for (const float side : {1.0f, -1.0f}) {
    AddLidShade(grid, side, true, &shades);
    AddLidShade(grid, side, false, &shades);
  }
  FinishSurface(&shades.mesh);
  return shades;
}

}  // namespace furrow::authoring
