// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "character/generator/folds.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

using glm::vec3;
using paint::FoldStroke;

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0f;

// Draws folds onto a mesh of cloth.
class Draper {
 public:
  explicit Draper(const Mesh& mesh) : mesh_(mesh) {}

  void Add(const std::vector<vec3>& points, float width, float depth) {
    FoldStroke stroke;
    stroke.points = paint::Smooth(points, 6);
    for (vec3& point : stroke.points) point = OnCloth(point);
    stroke.width = width;
    stroke.depth = depth;
    stroke.ridge = 0.55f;  // cloth buckles: ridges nearly as high as valleys are deep
    stroke.taper = 0.9f;
    stroke.facing = FacingAt(stroke.points[stroke.points.size() / 2]);
    strokes_.push_back(std::move(stroke));
  }

  // A stack of folds across a limb that runs along `along`, from `low` to `high` metres beside
  // `joint`. They are centred on direction `inner`, span `span` degrees either way, slant by turns.
  void Stack(const vec3& joint, const vec3& along, const vec3& inner, float radius, float low,
             float high, int count, float span, float depth, int seed) {
    const vec3 side = glm::cross(along, inner);
    for (int i = 0; i < count; ++i) {
      const float t = (static_cast<float>(i) + 0.5f + 0.5f * (Hash(seed, i, 1) - 0.5f)) /
                      static_cast<float>(count);
      const float place = low + (high - low) * t;
      const float near = 1.0f - std::abs(2.0f * t - 1.0f);  // deepest at the joint
      const float slant = (i % 2 == 0 ? 1.0f : -1.0f) * (0.006f + 0.010f * Hash(seed, i, 2));
      const float reach = span * (0.7f + 0.3f * near) * (0.85f + 0.3f * Hash(seed, i, 3));
      const float off = 18.0f * (Hash(seed, i, 4) - 0.5f);
      std::vector<vec3> points;
      for (int k = -3; k <= 3; ++k) {
        const float angle = (off + reach * static_cast<float>(k) / 3.0f) * kDegrees;
        const float shift = slant * static_cast<float>(k) / 3.0f;
        points.push_back(joint + along * (place + shift) +
                         radius * (inner * std::cos(angle) + side * std::sin(angle)));
      }
      Add(points, 0.0085f + 0.004f * Hash(seed, i, 5), depth * (0.55f + 0.6f * near));
    }
  }

  std::vector<FoldStroke> Take() { return std::move(strokes_); }

 private:
  const Vertex& NearestVertex(const vec3& p) const {
    const Vertex* best = &mesh_.vertices.front();
    float distance = std::numeric_limits<float>::max();
    for (const Vertex& vertex : mesh_.vertices) {
      const float d = glm::dot(vertex.position - p, vertex.position - p);
      if (d < distance) {
        distance = d;
        best = &vertex;
      }
    }
    return *best;
  }

  vec3 OnCloth(const vec3& p) const {
    const Vertex& vertex = NearestVertex(p);
    return p - vertex.normal * glm::dot(p - vertex.position, vertex.normal);
  }

  vec3 FacingAt(const vec3& p) const { return NearestVertex(p).normal; }

  const Mesh& mesh_;
  std::vector<FoldStroke> strokes_;
};

void AddLimbs(Draper* drape) {
  for (const float side : {1.0f, -1.0f}) {
    const int seed = side > 0.0f ? 400 : 500;
    const vec3 arm(side, 0, 0);
    // Elbow: stacked on the inside (in front, palms down), slack rings on the outside.
    const vec3 elbow(side * 0.455f, 1.424f, -0.02f);
    drape->Stack(elbow, arm, {0, 0, 1}, 0.05f, -0.075f, 0.075f, 7, 100, 0.0042f, seed);
    drape->Stack(elbow, arm, {0, 0, -1}, 0.05f, -0.06f, 0.06f, 4, 60, 0.0016f, seed + 20);
    // Armpit: drag lines toward the chest and the back.
    const vec3 shoulder(side * 0.165f, 1.40f, -0.015f);
    drape->Stack(shoulder, arm, {0, -0.5f, 0.87f}, 0.072f, -0.05f, 0.09f, 5, 75, 0.0034f,
                 seed + 40);
    drape->Stack(shoulder, arm, {0, -0.5f, -0.87f}, 0.072f, -0.05f, 0.09f, 5, 75, 0.0034f,
                 seed + 50);
    // Knee: stacked behind, slack in front.
    const vec3 leg(0, -1, 0);
    const vec3 knee(side * 0.095f, 0.495f, 0.005f);
    drape->Stack(knee, leg, {0, 0, -1}, 0.069f, -0.10f, 0.10f, 7, 105, 0.0048f, seed + 60);
    drape->Stack(knee, leg, {0, 0, 1}, 0.069f, -0.08f, 0.08f, 4, 60, 0.0018f, seed + 80);
    // Hem: the trousers break over the shoe.
    drape->Stack({side * 0.10f, 0.12f, -0.008f}, leg, {0, 0, 1}, 0.063f, -0.05f, 0.03f, 3, 90,
                 0.003f, seed + 90);
    // Groin: lines that radiate from the crotch outward and up; seat of the trousers below.
    for (int i = 0; i < 5; ++i) {
      const float rise = 0.11f - 0.045f * static_cast<float>(i);
      drape->Add({{side * 0.02f, 0.85f, 0.10f},
                  {side * 0.075f, 0.85f + 0.55f * rise, 0.105f},
                  {side * 0.15f, 0.85f + rise, 0.06f}},
                 0.010f, 0.0040f);
      drape->Add({{side * 0.03f, 0.80f - 0.01f * static_cast<float>(i), -0.10f},
                  {side * 0.09f, 0.80f + 0.3f * rise, -0.10f},
                  {side * 0.15f, 0.82f + 0.6f * rise, -0.05f}},
                 0.010f, 0.0028f);
    }
  }
}

void AddShirt(Draper* drape) {
  const vec3 waist(0, 1.07f, 0.0f);
  for (int i = 0; i < 6; ++i) {
    const float t = static_cast<float>(i) / 5.0f;
    const float y = waist.y - 0.13f + 0.26f * t;
    const float bow = 0.03f * (0.5f - t);
    for (const float side : {1.0f, -1.0f}) {
      const float stray = 0.03f * (Hash(i, side > 0 ? 1 : 2, 60) - 0.5f);
      const float inner = 0.02f + 0.07f * Hash(i, side > 0 ? 3 : 4, 61);
      // From the flank toward the middle, in front and behind.
      drape->Add({{side * 0.165f, y + stray, 0.02f},
                  {side * 0.12f, y + bow + stray, 0.095f},
                  {side * inner, y + 2.2f * bow - 0.4f * stray, 0.118f}},
                 0.011f, 0.0036f);
      drape->Add({{side * 0.165f, y - stray, -0.02f},
                  {side * 0.12f, y + bow - stray, -0.09f},
                  {side * inner, y + 2.0f * bow + 0.4f * stray, -0.115f}},
                 0.011f, 0.0034f);
    }
  }
  // Diagonals under the collar.
  for (int i = 0; i < 5; ++i) {
    for (const float side : {1.0f, -1.0f}) {
      const float x = side * (0.02f + 0.022f * static_cast<float>(i));
      drape->Add({{x, 1.475f - 0.006f * static_cast<float>(i), 0.05f},
                  {x + side * 0.03f, 1.44f, 0.08f},
                  {x + side * 0.07f, 1.40f, 0.10f}},
                 0.008f, 0.0024f);
    }
  }
}

}  // namespace

std::vector<FoldStroke> ClothStrokes(const Mesh& clothes) {
  Draper drape(clothes);
  AddLimbs(&drape);
  AddShirt(&drape);
  return drape.Take();
}

}  // namespace furrow::character::generator
