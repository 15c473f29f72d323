// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_skin.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/head/ear_mesh.h"
#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kGridTop = 0.01f;  // the grid's island in the atlas
constexpr float kGridHeight = 0.85f;
constexpr float kGridLeft = 0.01f;
constexpr float kGridWidth = 0.98f;
constexpr vec2 kMouthIsland(0.05f, 0.932f);
constexpr vec2 kMouthIslandSize(0.045f, 0.055f);

vec2 Atlas(const vec2& uv) {
  return {kGridLeft + kGridWidth * uv.x, kGridTop + kGridHeight * uv.y};
}

// Builds the surface of the grid and the parts behind its openings.
class SkinBuilder {
 public:
  SkinBuilder(const HeadShape& shape, int level) : layout_(shape, level) {}

  HeadMesh Build() {
    AddGrid();
    AddLids(1.0f);
    AddLids(-1.0f);
    AddMouth();
    AddEar(1.0f, layout_.level(), &head_);
    AddEar(-1.0f, layout_.level(), &head_);
    FinishSurface(&head_.mesh);
    return std::move(head_);
  }

 private:
  std::uint32_t GridIndex(int column, int row) const {
    return grid_[static_cast<std::size_t>(column + layout_.num_columns()) * layout_.num_rows() +
                 row];
  }

  HeadVertex GridVertex(int column, int row, const vec2& place) const {
    HeadVertex info;
    info.place = layout_.Surface(place);
    const int mouth = (layout_.mouth_row(0) + layout_.mouth_row(1)) / 2;
    const int eye = (layout_.eye_row(0) + layout_.eye_row(1)) / 2;
    info.mouth_side = static_cast<float>((row > mouth) - (row < mouth));
    info.eye_side = static_cast<float>((row > eye) - (row < eye));
    if (std::abs(column) == layout_.num_columns()) info.place.x = 0.0f;  // closes the seam
    return info;
  }

  void AddGrid() {
    const int last = layout_.num_columns();
    for (int c = -last; c <= last; ++c) {
      for (int r = 0; r < layout_.num_rows(); ++r) {
        const vec2 place = layout_.Warped(c, r);
        grid_.push_back(AddHeadVertex(&head_, GridVertex(c, r, place), Atlas(HeadUv(place))));
      }
    }
    for (int c = -last; c < last; ++c) {
      for (int r = 0; r + 1 < layout_.num_rows(); ++r) {
        if (layout_.InOpening(c, r)) continue;
        AddQuad(&head_.mesh, GridIndex(c, r), GridIndex(c + 1, r), GridIndex(c + 1, r + 1),
                GridIndex(c, r + 1));
      }
    }
  }

  // Connects two closed loops of equal length. If the surface continues inward from `outer`, that
  // loop runs clockwise from outside.
  void Bridge(const std::vector<std::uint32_t>& outer, const std::vector<std::uint32_t>& inner) {
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const std::size_t next = (i + 1) % outer.size();
      AddQuad(&head_.mesh, outer[i], outer[next], inner[next], inner[i]);
    }
  }

  // The edge of the lid turns in toward the eyeball and follows it back out of sight.
  void AddLids(float side) {
    std::vector<glm::ivec2> outline = layout_.EyeOutline();
    if (side < 0.0f) {
      for (glm::ivec2& vertex : outline) vertex.x = -vertex.x;
      std::reverse(outline.begin(), outline.end());
    }
    std::vector<std::uint32_t> ring;
    vec2 middle(0.0f);
    for (const glm::ivec2& vertex : outline) {
      ring.push_back(GridIndex(vertex.x, vertex.y));
      middle += layout_.Warped(vertex.x, vertex.y) / static_cast<float>(outline.size());
    }
    const vec3 centre = EyeCentre(side);
    struct Step {
      float radius;
      float open;
      float shrink;
    };
    constexpr Step kSteps[] = {{1.23f, 0.0f, 0.9f}, {1.215f, 0.25f, 0.75f}, {1.25f, 0.8f, 0.55f}};
    for (const Step& step : kSteps) {
      std::vector<std::uint32_t> next;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::uint32_t from = GridIndex(outline[i].x, outline[i].y);
        HeadVertex info = head_.info[from];
        vec3 direction = glm::normalize(info.place - centre);
        direction.z -= step.open;  // away from the opening
        info.place = centre + glm::normalize(direction) * step.radius;
        const vec2 place =
            glm::mix(middle, layout_.Warped(outline[i].x, outline[i].y), step.shrink);
        next.push_back(AddHeadVertex(&head_, info, Atlas(HeadUv(place))));
      }
      Bridge(ring, next);
      ring = std::move(next);
    }
  }

  // Builds a dark bag behind the line of the lips. It has a round UV island of its own, since the
  // closed lips leave it no room in the grid's island.
  void AddMouth() {
    const std::vector<glm::ivec2> outline = layout_.MouthOutline();
    const auto island = [&](std::size_t i, float radius) {
      const float turn = 2.0f * kPi * static_cast<float>(i) / static_cast<float>(outline.size());
      return kMouthIsland + radius * kMouthIslandSize * vec2(std::cos(turn), -std::sin(turn));
    };
    struct Step {
      float back;
      float height;
      float narrow;
      float radius;
    };
    // Behind their line the lips overlap a little, so that closed lips show no gap.
    constexpr Step kSteps[] = {{0.0f, 0.0f, 1.0f, 1.0f},      {0.08f, -0.015f, 0.995f, 0.93f},
                               {0.22f, -0.01f, 0.99f, 0.86f}, {0.42f, 0.06f, 0.98f, 0.78f},
                               {0.9f, 0.35f, 0.97f, 0.62f},   {2.6f, 1.1f, 0.95f, 0.4f},
                               {4.6f, 0.7f, 0.6f, 0.18f}};
    std::vector<std::uint32_t> ring;
    for (const Step& step : kSteps) {
      std::vector<std::uint32_t> next;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        HeadVertex info = head_.info[GridIndex(outline[i].x, outline[i].y)];
        // The first ring is the line of the lips and stays skin, since it must move like the grid.
        if (!ring.empty()) info.part = kMouthInside;
        const float corner = 1.0f - std::abs(info.place.x) / kMouthCornerX;
        info.place.x *= step.narrow;
        info.place.y += info.mouth_side * step.height * std::sqrt(std::max(corner, 0.0f));
        // Behind the corner, the cheek's lining joins the lips: a shallow web, and no black slit.
        info.place.z -= step.back * glm::mix(0.25f, 1.0f, Smoothstep(0.0f, 0.4f, corner));
        next.push_back(AddHeadVertex(&head_, info, island(i, step.radius)));
      }
      if (!ring.empty()) Bridge(ring, next);
      ring = std::move(next);
    }
    HeadVertex back;
    back.part = kMouthInside;
    back.place = vec3(0.0f, kMouthY, 3.6f);
    const std::uint32_t tip = AddHeadVertex(&head_, back, kMouthIsland);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      AddQuad(&head_.mesh, ring[i], ring[(i + 1) % ring.size()], tip, tip);
    }
  }

  HeadGrid layout_;
  HeadMesh head_;
  std::vector<std::uint32_t> grid_;
};

}  // namespace

HeadMesh MakeHeadSkin(const HeadShape& shape, int level) {
  HeadMesh head = SkinBuilder(shape, level).Build();
  head.mesh.name = "head";
  return head;
}

}  // namespace furrow::authoring
