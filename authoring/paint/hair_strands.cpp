// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/hair_strands.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kTiles = kFullTiles + kSparseTiles;
constexpr float kGutter = 0.04f;  // fraction of a tile's width on either side
constexpr int kLayers = 3;        // strands on top of each other
constexpr int kWisps = 5;         // bundles of strands per tile, at the tips

// A repeatable random number in [0, 1).
float StrandRandom(int tile, int strand, int what) {
  return RandomFromBits(static_cast<std::uint32_t>(tile) * 0x9e3779b9u ^
                        static_cast<std::uint32_t>(strand) * 0x85ebca6bu ^
                        static_cast<std::uint32_t>(what) * 0xc2b2ae35u);
}

// One hair or a few that stick together. `Across` is a fraction of the tile's width, t in [0, 1]
// runs from root to tip.
struct Strand {
  float root = 0.5f;
  float tip = 0.5f;
  float wave = 0.0f;
  float phase = 0.0f;
  float begin = 0.0f;
  float end = 1.0f;
  float half_width = 0.01f;
  vec3 colour{0.0f};

  [[nodiscard]] float Across(float t) const {
    return glm::mix(root, tip, t * t * (2.0f - t)) + wave * t * std::sin(5.0f * t + phase);
  }
  [[nodiscard]] float HalfWidth(float t) const {
    const float in = glm::smoothstep(begin - 0.02f, begin + 0.16f, t);
    return half_width * (0.15f + 0.85f * in) * (1.0f - glm::smoothstep(end - 0.4f, end, t));
  }
};

Strand MakeStrand(const StrandLook& look, int tile, int layer, int number) {
  const int id = layer * 1000 + number;
  const auto random = [&](int what) { return StrandRandom(tile, id, what); };
  const bool sparse = tile >= kFullTiles;
  Strand strand;
  const float middle = 0.5f * (random(1) + random(2));  // fewer near the card's edges
  strand.root = glm::mix(0.06f, 0.94f, glm::mix(random(1), middle, 0.45f));
  const float wisp = (std::floor(strand.root * kWisps) + 0.25f + 0.5f * random(3)) / kWisps;
  strand.tip = glm::mix(strand.root, wisp, 0.6f) * 0.9f + 0.05f + 0.05f * (random(4) - 0.5f);
  strand.wave = 0.035f * (random(5) - 0.5f);
  strand.phase = 6.3f * random(6);
  strand.begin = (sparse ? 0.18f : 0.22f) * random(7);  // the roots of a card are staggered
  strand.end = glm::mix(0.52f, 1.0f, random(8));
  strand.half_width = (sparse ? 0.7f : 1.0f) * glm::mix(0.010f, 0.022f, random(9));
  const float silver =
      std::clamp(look.grey_share + 0.30f * (random(10) - 0.5f) * look.grey_share, 0.0f, 1.0f);
  const float depth = 0.66f + 0.17f * static_cast<float>(layer);  // lower layers are in shade
  const float tone =
      1.0f + 0.16f * (random(11) - 0.5f) + 0.06f * (StrandRandom(tile, 0, 12) - 0.5f);
  strand.colour = glm::mix(look.colour, look.grey, silver) * (depth * tone);
  return strand;
}

class TilePainter {
 public:
  TilePainter(character::Picture* colour, character::Picture* normals, int tile)
      : colour_(colour),
        normals_(normals),
        left_(static_cast<float>(tile) / kTiles * static_cast<float>(colour->width)),
        width_(static_cast<float>(colour->width) / kTiles),
        rows_(static_cast<int>(kStrandBottom * static_cast<float>(colour->height))) {}

  // Sets coverage to 0. The colour still matters, since mip levels mix it in at the strands' edges.
  void Clear(const vec3& colour) {
    for (int y = 0; y < rows_; ++y) {
      for (int x = static_cast<int>(left_); x < static_cast<int>(left_ + width_); ++x) {
        Put(x, y, colour, 0.0f, 0.0f);
      }
    }
  }

  void Draw(const Strand& strand) {
    for (int y = 0; y < rows_; ++y) {
      const float t = (static_cast<float>(y) + 0.5f) / static_cast<float>(rows_);
      if (t < strand.begin || t > strand.end) continue;
      const float x = left_ + width_ * strand.Across(t);
      // A thinner strand would miss the centres of some texels and break.
      const float half = std::max(width_ * strand.HalfWidth(t), 0.35f);
      // Roots are in the shade of the strands above them.
      const vec3 colour = strand.colour * glm::mix(0.90f, 1.0f, glm::smoothstep(0.05f, 0.5f, t));
      const int last = static_cast<int>(std::ceil(x + half));
      for (int column = static_cast<int>(x - half); column <= last; ++column) {
        const float from = static_cast<float>(column) + 0.5f - x;
        const float cover = std::clamp(half + 0.5f - std::abs(from), 0.0f, 1.0f);
        if (cover <= 0.0f || column < left_ || column >= left_ + width_) continue;
        const float side = std::clamp(from / half, -1.0f, 1.0f);
        Put(column, y, colour * (1.0f - 0.30f * side * side), side, cover);
      }
    }
  }

 private:
  // `side`: -1 at the strand's left edge, +1 at its right edge. A `cover` of 0 clears the texel.
  void Put(int x, int y, const vec3& colour, float side, float cover) {
    std::uint8_t* out = TexelAt(colour_, x, y);
    std::uint8_t* slope = TexelAt(normals_, x, y);
    const bool clear = cover <= 0.0f;
    const float share = clear ? 1.0f : cover;
    const vec3 normal =
        clear ? vec3(0.0f, 0.0f, 1.0f) : glm::normalize(vec3(0.55f * side, 0.0f, 1.0f));
    for (int c = 0; c < 3; ++c) {
      out[c] = Mixed(out[c], colour[c], share);
      slope[c] = Mixed(slope[c], 0.5f + 0.5f * normal[c], share);
    }
    out[3] = clear ? std::uint8_t{0} : std::max(out[3], ToByte(cover));
  }

  static std::uint8_t Mixed(std::uint8_t from, float to, float share) {
    return ToByte(glm::mix(static_cast<float>(from) / 255.0f, to, share));
  }

  character::Picture* colour_;
  character::Picture* normals_;
  float left_;
  float width_;
  int rows_;
};

}  // namespace

vec2 StrandUv(int tile, float across, float along) {
  const float in_tile = kGutter + (1.0f - 2.0f * kGutter) * (0.5f + 0.5f * across);
  return {(static_cast<float>(tile) + in_tile) / kTiles, kStrandBottom * (0.005f + 0.985f * along)};
}

void PaintStrands(const StrandLook& look, character::Picture* colour, character::Picture* normals) {
  const vec3 shade = 0.6f * glm::mix(look.colour, look.grey, look.grey_share);
  for (int tile = 0; tile < kTiles; ++tile) {
    TilePainter painter(colour, normals, tile);
    painter.Clear(shade);
    for (int layer = 0; layer < kLayers; ++layer) {
      const int count = (tile < kFullTiles ? 34 : 9) - 6 * layer / (tile < kFullTiles ? 1 : 4);
      for (int i = 0; i < count; ++i) painter.Draw(MakeStrand(look, tile, layer, i));
    }
  }
}

}  // namespace furrow::authoring
