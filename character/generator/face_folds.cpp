// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <initializer_list>
#include <vector>

#include <glm/vec2.hpp>

#include "character/generator/folds.h"
#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;
using paint::FoldStroke;

// A fold as one draws it on the face seen from the front: centimetres, head space, left side.
struct Line {
  std::vector<vec2> points;
  float width;  // centimetres
  float depth;
  float taper = 0.8f;
};

vec3 OnFace(const vec2& p) {
  return HeadToModel(CastOnHead({p.x, p.y, 20.0f}, {0.0f, 0.0f, -1.0f}, 20.0f));
}

// Lays a line onto the skin, each vertex strayed a little, so that left and right differ.
FoldStroke Lay(const Line& line, float side, int seed) {
  std::vector<vec3> control;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const int k = static_cast<int>(i);
    const vec2 stray(Hash(seed, k, 1) - 0.5f, Hash(seed, k, 2) - 0.5f);
    const vec2 p = line.points[i] + stray * (0.5f * line.width);
    control.push_back(OnFace({p.x * side, p.y}));
  }
  FoldStroke stroke;
  stroke.points = paint::Smooth(control, 8);
  // The spline leaves the skin between its control points: back onto it.
  for (vec3& point : stroke.points) {
    vec3 p = ModelToHead(point);
    for (int i = 0; i < 2; ++i) p -= HeadNormal(p) * HeadDistance(p);
    point = HeadToModel(p);
  }
  const float vary = 0.8f + 0.4f * Hash(seed, 7, 3);
  stroke.width = line.width * 0.01f * (0.9f + 0.2f * Hash(seed, 5, 5));
  stroke.depth = line.depth * 0.01f * vary;
  stroke.taper = line.taper;
  return stroke;
}

void LayPair(const Line& line, int seed, std::vector<FoldStroke>* strokes) {
  strokes->push_back(Lay(line, 1.0f, seed));
  strokes->push_back(Lay(line, -1.0f, seed + 1000));
}

// Frontalis: furrows across the forehead, broken, shorter and shallower toward the hair.
void AddForehead(std::vector<FoldStroke>* strokes) {
  const struct {
    float y, reach, depth;
  } kFurrows[] = {{3.15f, 4.3f, 0.042f},
                  {3.75f, 4.9f, 0.058f},
                  {4.4f, 4.5f, 0.060f},
                  {5.0f, 3.8f, 0.050f},
                  {5.65f, 2.9f, 0.036f}};
  int seed = 10;
  for (const auto& f : kFurrows) {
    // Two arcs that pass each other over the middle.
    const float inner = 0.9f * Hash(seed, 0, 0) - 0.55f;
    const Line arc{{{inner, f.y - 0.18f},
                    {0.3f * f.reach + 0.3f, f.y + 0.08f},
                    {0.65f * f.reach, f.y + 0.12f},
                    {f.reach, f.y - 0.40f}},
                   0.26f,
                   f.depth,
                   0.7f};
    LayPair(arc, seed, strokes);
    seed += 10;
  }
  // Outer ends, over the tails of the brows.
  LayPair({{{3.6f, 3.3f}, {4.6f, 3.25f}, {5.4f, 2.8f}}, 0.2f, 0.026f}, 71, strokes);
  LayPair({{{1.2f, 4.1f}, {2.1f, 4.15f}, {2.9f, 4.1f}}, 0.18f, 0.018f}, 81, strokes);
}

void AddChin(std::vector<FoldStroke>* strokes) {
  for (int i = 0; i < 26; ++i) {
    const float x = 3.0f * (Hash(i, 1, 40) - 0.5f);
    const float y = -10.1f + 1.5f * (Hash(i, 2, 40) - 0.5f);
    const float turn = 6.28f * Hash(i, 3, 40);
    const vec2 step = 0.16f * vec2(std::cos(turn), std::sin(turn));
    strokes->push_back(Lay(
        {{vec2(x, y) - step, vec2(x, y), vec2(x, y) + step}, 0.14f, 0.022f, 1.0f}, 1.0f, 300 + i));
  }
}

void AddLipLines(std::vector<FoldStroke>* strokes) {
  for (int i = 0; i < 9; ++i) {
    const float x = -1.8f + 0.45f * static_cast<float>(i) + 0.2f * (Hash(i, 1, 50) - 0.5f);
    const float y = -5.75f - 0.15f * Hash(i, 2, 50);
    strokes->push_back(
        Lay({{{x * 1.05f, y}, {x, y - 0.3f}, {x * 0.97f, y - 0.6f}}, 0.10f, 0.010f, 1.0f}, 1.0f,
            330 + i));
  }
}

}  // namespace

std::vector<FoldStroke> StretchStrokes() {
  std::vector<FoldStroke> strokes;
  AddForehead(&strokes);
  // The lid's crease, which widened eyes deepen.
  LayPair({{{2.1f, 0.85f}, {3.2f, 1.05f}, {4.5f, 0.8f}}, 0.14f, 0.03f}, 91, &strokes);
  // Marionette lines and the crease under the lip.
  LayPair({{{2.75f, -7.2f}, {3.0f, -8.0f}, {3.1f, -9.0f}, {2.9f, -9.8f}}, 0.32f, 0.075f}, 101,
          &strokes);
  LayPair({{{3.5f, -7.9f}, {3.75f, -8.8f}, {3.6f, -9.6f}}, 0.26f, 0.03f}, 111, &strokes);
  strokes.push_back(
      Lay({{{-1.7f, -8.75f}, {-0.8f, -8.5f}, {0.0f, -8.45f}, {0.8f, -8.5f}, {1.7f, -8.75f}},
           0.3f,
           0.06f},
          1.0f, 121));
  AddChin(&strokes);
  return strokes;
}

std::vector<FoldStroke> SquashStrokes() {
  std::vector<FoldStroke> strokes;
  // Corrugator: verticals of the glabella, leaning outward. Procerus: across the root of the nose.
  LayPair({{{0.62f, 0.9f}, {0.72f, 1.7f}, {0.95f, 2.5f}, {1.05f, 3.3f}}, 0.24f, 0.075f}, 131,
          &strokes);
  LayPair({{{0.25f, 1.4f}, {0.25f, 2.1f}, {0.33f, 2.8f}}, 0.16f, 0.03f}, 141, &strokes);
  LayPair({{{1.35f, 2.2f}, {1.5f, 2.9f}, {1.7f, 3.4f}}, 0.2f, 0.03f}, 146, &strokes);
  strokes.push_back(Lay({{{-0.75f, 0.75f}, {0.0f, 0.6f}, {0.75f, 0.75f}}, 0.2f, 0.05f}, 1.0f, 151));
  strokes.push_back(
      Lay({{{-0.6f, 0.25f}, {0.0f, 0.15f}, {0.6f, 0.25f}}, 0.16f, 0.028f}, 1.0f, 156));
  // Nasalis: bunny lines, slanting down and outward across the side of the nose.
  for (int i = 0; i < 3; ++i) {
    const float drop = 0.48f * static_cast<float>(i);
    LayPair({{{0.4f, -0.55f - drop}, {0.85f, -0.85f - drop}, {1.45f, -1.45f - drop}},
             0.16f,
             0.045f - 0.008f * static_cast<float>(i)},
            161 + 5 * i, &strokes);
  }
  // Orbicularis oculi: crow's feet fan from the outer corner; lines under the lid.
  const vec2 ends[] = {{5.9f, 1.15f}, {6.2f, 0.6f}, {6.35f, 0.0f}, {6.2f, -0.65f}, {5.8f, -1.2f}};
  for (int i = 0; i < 5; ++i) {
    const vec2 from(4.98f + 0.06f * Hash(i, 0, 9), 0.32f - 0.17f * static_cast<float>(i));
    LayPair({{from, 0.5f * (from + ends[i]) + vec2(0.0f, -0.05f), ends[i]},
             0.15f,
             0.042f - 0.006f * std::abs(static_cast<float>(i) - 2.0f)},
            181 + 5 * i, &strokes);
  }
  LayPair({{{2.0f, -0.95f}, {2.7f, -1.25f}, {3.6f, -1.3f}, {4.5f, -0.95f}}, 0.18f, 0.040f}, 211,
          &strokes);
  LayPair({{{2.1f, -1.35f}, {2.9f, -1.75f}, {3.8f, -1.75f}, {4.7f, -1.35f}}, 0.22f, 0.034f}, 216,
          &strokes);
  LayPair({{{2.6f, -0.75f}, {3.3f, -0.9f}, {4.2f, -0.75f}}, 0.12f, 0.018f}, 221, &strokes);
  // Zygomaticus and levator: the nasolabial fold, and a second one beside the corner.
  LayPair({{{1.75f, -3.7f}, {2.15f, -4.5f}, {2.75f, -5.5f}, {3.2f, -6.6f}, {3.25f, -7.6f}},
           0.46f,
           0.15f,
           0.7f},
          231, &strokes);
  LayPair({{{3.75f, -5.6f}, {4.05f, -6.5f}, {3.95f, -7.5f}}, 0.3f, 0.055f}, 241, &strokes);
  LayPair({{{2.85f, -6.6f}, {2.98f, -7.0f}, {2.85f, -7.4f}}, 0.18f, 0.045f}, 251, &strokes);
  AddLipLines(&strokes);
  return strokes;
}

}  // namespace furrow::character::generator
