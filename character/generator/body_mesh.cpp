// SPDX-License-Identifier: Apache-2.0
#include "character/generator/body_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "character/generator/mesh_tools.h"
#include "character/generator/skinning.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kPi = std::numbers::pi_v<float>;

// A station of a tube: its middle and its half axes across (`a`) and `b`, metres.
struct Station {
  vec3 middle;
  float a;
  float b;
};

struct Rect {
  vec2 low;
  vec2 high;
};

// A tube through stations, of elliptic section (or squarer, by `power` > 2).
struct Tube {
  std::vector<Station> stations;
  vec3 across;    // unit, of `a`
  vec3 up;        // unit, of `b`; cross(across, up) points along the tube
  int rings = 2;  // pieces between two stations
  int segments = 16;
  float power = 2.0f;
  Rect uv;  // u round the tube, v along it
};

Station At(const std::vector<Station>& s, std::size_t i, float t) {
  // Catmull-Rom on middles and radii alike: no kink where stations meet.
  const Station& p0 = s[i > 0 ? i - 1 : 0];
  const Station& p1 = s[i];
  const Station& p2 = s[i + 1];
  const Station& p3 = s[std::min(i + 2, s.size() - 1)];
  const auto spline = [t](auto a, auto b, auto c, auto d) {
    return 0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * (t * t) +
                   (3.0f * b - a - 3.0f * c + d) * (t * t * t));
  };
  return {spline(p0.middle, p1.middle, p2.middle, p3.middle),
          std::max(spline(p0.a, p1.a, p2.a, p3.a), 1e-4f),
          std::max(spline(p0.b, p1.b, p2.b, p3.b), 1e-4f)};
}

std::vector<Station> Refine(const Tube& tube) {
  std::vector<Station> fine;
  for (std::size_t i = 0; i + 1 < tube.stations.size(); ++i) {
    for (int k = 0; k < tube.rings; ++k) {
      fine.push_back(At(tube.stations, i, static_cast<float>(k) / static_cast<float>(tube.rings)));
    }
  }
  fine.push_back(tube.stations.back());
  return fine;
}

// Appends a tube; returns its first vertex. Seam at angle 0, which faces -b: inside or behind.
std::size_t AddTube(const Tube& tube, Mesh* mesh) {
  const std::vector<Station> stations = Refine(tube);
  const std::size_t first = mesh->vertices.size();
  std::vector<float> along{0.0f};
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const float step = glm::distance(stations[i].middle, stations[i - 1].middle) +
                       std::abs(stations[i].a - stations[i - 1].a);
    along.push_back(along.back() + std::max(step, 1e-4f));
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    for (int k = 0; k <= tube.segments; ++k) {
      const float turn = static_cast<float>(k) / static_cast<float>(tube.segments);
      const float angle =
          2.0f * kPi * static_cast<float>(k % tube.segments) / static_cast<float>(tube.segments) -
          0.5f * kPi;
      const auto bend = [&](float v) {
        return std::copysign(std::pow(std::abs(v), 2.0f / tube.power), v);
      };
      Vertex vertex;
      vertex.position = stations[i].middle + tube.across * (stations[i].a * bend(std::cos(angle))) +
                        tube.up * (stations[i].b * bend(std::sin(angle)));
      vertex.uv = glm::mix(tube.uv.low, tube.uv.high, vec2(turn, along[i] / along.back()));
      mesh->vertices.push_back(vertex);
    }
  }
  const auto index = [&](std::size_t ring, int k) {
    return static_cast<std::uint32_t>(first + ring * (tube.segments + 1) + k);
  };
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    for (int k = 0; k < tube.segments; ++k) {
      AddQuad(mesh, index(i, k), index(i, k + 1), index(i + 1, k + 1), index(i + 1, k));
    }
  }
  return first;
}

void AddSkinnedTube(const wrinkle::Skeleton& skeleton, BodyPart part, const Tube& tube,
                    Mesh* mesh) {
  const std::size_t first = AddTube(tube, mesh);
  SkinBody(skeleton, part, std::span(mesh->vertices).subspan(first));
}

Tube Torso() {
  Tube tube;
  const float rows[][4] = {// y, half width, half depth, z of the middle
                           {0.885f, 0.160f, 0.108f, 0.000f},   {0.878f, 0.180f, 0.128f, 0.000f},
                           {0.895f, 0.184f, 0.132f, 0.000f},   {0.94f, 0.179f, 0.128f, 0.002f},
                           {1.00f, 0.168f, 0.119f, 0.004f},    {1.07f, 0.161f, 0.113f, 0.006f},
                           {1.14f, 0.163f, 0.114f, 0.006f},    {1.22f, 0.173f, 0.121f, 0.004f},
                           {1.30f, 0.184f, 0.126f, 0.000f},    {1.36f, 0.188f, 0.122f, -0.008f},
                           {1.402f, 0.180f, 0.112f, -0.016f},  {1.428f, 0.156f, 0.098f, -0.022f},
                           {1.445f, 0.122f, 0.086f, -0.028f},  {1.457f, 0.094f, 0.079f, -0.031f},
                           {1.470f, 0.080f, 0.0765f, -0.031f}, {1.486f, 0.0755f, 0.0755f, -0.030f},
                           {1.490f, 0.072f, 0.072f, -0.030f},  {1.472f, 0.066f, 0.066f, -0.030f}};
  for (const auto& r : rows) tube.stations.push_back({{0, r[0], r[3]}, r[1], r[2]});
  tube.across = {-1, 0, 0};
  tube.up = {0, 0, 1};
  tube.segments = 44;
  tube.power = 2.35f;
  tube.uv = {{0.01f, 0.49f}, {0.55f, 0.01f}};
  return tube;
}

Tube Sleeve(float side) {
  Tube tube;
  const float rows[][4] = {// x, half height, half depth, y of the middle
                           {0.120f, 0.052f, 0.060f, 1.392f}, {0.150f, 0.063f, 0.070f, 1.394f},
                           {0.185f, 0.068f, 0.071f, 1.400f}, {0.225f, 0.065f, 0.067f, 1.406f},
                           {0.275f, 0.060f, 0.061f, 1.413f}, {0.330f, 0.055f, 0.056f, 1.417f},
                           {0.385f, 0.052f, 0.053f, 1.420f}, {0.425f, 0.050f, 0.051f, 1.422f},
                           {0.455f, 0.049f, 0.050f, 1.424f}, {0.485f, 0.048f, 0.049f, 1.425f},
                           {0.530f, 0.047f, 0.048f, 1.425f}, {0.590f, 0.044f, 0.045f, 1.425f},
                           {0.650f, 0.039f, 0.041f, 1.425f}, {0.690f, 0.036f, 0.039f, 1.425f},
                           {0.708f, 0.036f, 0.040f, 1.425f}, {0.711f, 0.032f, 0.036f, 1.425f},
                           {0.690f, 0.027f, 0.032f, 1.425f}};
  for (const auto& r : rows) {
    const float z = -0.010f - 0.012f * SmoothStep(0.12f, 0.45f, r[0]);
    tube.stations.push_back({{side * r[0], r[3], z}, r[2], r[1]});
  }
  tube.across = {0, 0, -side};
  tube.up = {0, 1, 0};
  tube.segments = 26;
  tube.uv =
      side > 0.0f ? Rect{{0.57f, 0.49f}, {0.77f, 0.01f}} : Rect{{0.79f, 0.49f}, {0.99f, 0.01f}};
  return tube;
}

Tube Pelvis() {
  Tube tube;
  const float rows[][4] = {{0.778f, 0.006f, 0.030f, 0.0f},  {0.783f, 0.020f, 0.055f, 0.0f},
                           {0.800f, 0.045f, 0.082f, 0.0f},  {0.830f, 0.090f, 0.098f, 0.0f},
                           {0.875f, 0.150f, 0.106f, 0.0f},  {0.92f, 0.168f, 0.112f, 0.0f},
                           {0.98f, 0.155f, 0.106f, 0.002f}, {1.03f, 0.145f, 0.100f, 0.004f}};
  for (const auto& r : rows) tube.stations.push_back({{0, r[0], r[3]}, r[1], r[2]});
  tube.across = {-1, 0, 0};
  tube.up = {0, 0, 1};
  tube.segments = 36;
  tube.power = 2.2f;
  tube.uv = {{0.01f, 0.99f}, {0.37f, 0.76f}};
  return tube;
}

Tube TrouserLeg(float side) {
  Tube tube;
  const float rows[][5] = {
      // y, half width, half depth, x, z of the middle
      {0.955f, 0.070f, 0.085f, 0.088f, 0.0f},    {0.90f, 0.083f, 0.102f, 0.088f, 0.0f},
      {0.85f, 0.086f, 0.104f, 0.090f, 0.0f},     {0.79f, 0.084f, 0.098f, 0.092f, 0.001f},
      {0.71f, 0.078f, 0.089f, 0.093f, 0.003f},   {0.63f, 0.072f, 0.081f, 0.094f, 0.005f},
      {0.56f, 0.067f, 0.074f, 0.095f, 0.006f},   {0.525f, 0.065f, 0.071f, 0.095f, 0.006f},
      {0.495f, 0.064f, 0.070f, 0.095f, 0.005f},  {0.465f, 0.063f, 0.069f, 0.096f, 0.003f},
      {0.42f, 0.063f, 0.070f, 0.096f, -0.002f},  {0.35f, 0.062f, 0.071f, 0.097f, -0.008f},
      {0.26f, 0.058f, 0.066f, 0.098f, -0.010f},  {0.18f, 0.055f, 0.063f, 0.099f, -0.010f},
      {0.115f, 0.054f, 0.064f, 0.100f, -0.008f}, {0.078f, 0.055f, 0.067f, 0.100f, -0.004f},
      {0.072f, 0.050f, 0.062f, 0.100f, -0.004f}, {0.095f, 0.042f, 0.052f, 0.100f, -0.008f}};
  for (const auto& r : rows) tube.stations.push_back({{side * r[3], r[0], r[4]}, r[1], r[2]});
  tube.across = {1, 0, 0};
  tube.up = {0, 0, 1};
  tube.segments = 26;
  tube.power = 2.1f;
  tube.uv =
      side > 0.0f ? Rect{{0.39f, 0.51f}, {0.68f, 0.99f}} : Rect{{0.70f, 0.51f}, {0.99f, 0.99f}};
  return tube;
}

Tube Shoe(float side) {
  Tube tube;
  const float rows[][3] = {
      // z, half width, height
      {-0.094f, 0.004f, 0.030f}, {-0.090f, 0.022f, 0.062f}, {-0.070f, 0.034f, 0.092f},
      {-0.030f, 0.038f, 0.106f}, {0.015f, 0.038f, 0.102f},  {0.060f, 0.042f, 0.080f},
      {0.110f, 0.048f, 0.062f},  {0.150f, 0.047f, 0.052f},  {0.180f, 0.036f, 0.043f},
      {0.195f, 0.020f, 0.034f},  {0.200f, 0.003f, 0.020f}};
  for (const auto& r : rows) {
    const float x = side * (0.100f + 0.04f * std::max(r[0], 0.0f));
    tube.stations.push_back({{x, 0.5f * r[2], r[0]}, r[1], 0.5f * r[2]});
  }
  tube.across = {1, 0, 0};
  tube.up = {0, 1, 0};
  tube.segments = 20;
  tube.power = 2.9f;
  tube.uv =
      side > 0.0f ? Rect{{0.01f, 0.01f}, {0.48f, 0.99f}} : Rect{{0.52f, 0.01f}, {0.99f, 0.99f}};
  return tube;
}

// A finger of the left hand from its knuckle, bending a little toward the palm.
struct Finger {
  vec3 knuckle;
  vec3 direction;
  float length;
  float radius;
};

const Finger kFingers[] = {{{0.776f, 1.424f, 0.018f}, {0.99f, -0.12f, 0.05f}, 0.078f, 0.0092f},
                           {{0.780f, 1.425f, -0.004f}, {1.00f, -0.13f, 0.00f}, 0.086f, 0.0094f},
                           {{0.776f, 1.424f, -0.025f}, {0.99f, -0.14f, -0.05f}, 0.079f, 0.0090f},
                           {{0.766f, 1.422f, -0.045f}, {0.98f, -0.15f, -0.10f}, 0.062f, 0.0080f},
                           {{0.725f, 1.415f, 0.012f}, {0.66f, -0.18f, 0.72f}, 0.088f, 0.0110f}};

Tube FingerTube(const Finger& finger, float side, const Rect& uv) {
  Tube tube;
  const float shape[][2] = {{-0.12f, 0.9f}, {0.0f, 1.05f},  {0.25f, 1.0f}, {0.48f, 1.02f},
                            {0.7f, 0.9f},   {0.88f, 0.82f}, {0.97f, 0.6f}, {1.0f, 0.12f}};
  const vec3 direction = glm::normalize(finger.direction);
  for (const auto& s : shape) {
    vec3 p = finger.knuckle + direction * (finger.length * s[0]);
    p.y -= finger.length * 0.16f * std::max(s[0], 0.0f) * s[0];
    p.x *= side;
    tube.stations.push_back({p, finger.radius * s[1], finger.radius * s[1]});
  }
  const vec3 along(direction.x * side, direction.y, direction.z);
  const vec3 up = glm::normalize(vec3(0, 1, 0) - along * along.y);
  tube.across = glm::cross(up, along);
  tube.up = up;
  tube.segments = 10;
  tube.uv = uv;
  return tube;
}

Tube Palm(float side, const Rect& uv) {
  Tube tube;
  const float rows[][4] = {// x, half depth, half thickness, z
                           {0.690f, 0.024f, 0.018f, -0.015f},  {0.712f, 0.028f, 0.0185f, -0.014f},
                           {0.735f, 0.037f, 0.0180f, -0.012f}, {0.758f, 0.042f, 0.0165f, -0.012f},
                           {0.776f, 0.043f, 0.0140f, -0.013f}, {0.787f, 0.040f, 0.0110f, -0.013f},
                           {0.790f, 0.030f, 0.0030f, -0.013f}};
  for (const auto& r : rows) tube.stations.push_back({{side * r[0], 1.424f, r[3]}, r[1], r[2]});
  tube.across = {0, 0, -side};
  tube.up = {0, 1, 0};
  tube.segments = 18;
  tube.power = 2.3f;
  tube.uv = uv;
  return tube;
}

}  // namespace

Mesh MakeClothes(const wrinkle::Skeleton& skeleton) {
  Mesh mesh;
  mesh.name = "clothes";
  AddTube(Torso(), &mesh);
  // The collar dips in front.
  for (Vertex& vertex : mesh.vertices) {
    vec3& p = vertex.position;
    p.y -= 0.22f * (p.z + 0.03f) * SmoothStep(1.41f, 1.47f, p.y);
  }
  SkinBody(skeleton, BodyPart::kTorso, mesh.vertices);

  AddSkinnedTube(skeleton, BodyPart::kPelvis, Pelvis(), &mesh);
  for (const float side : {1.0f, -1.0f}) {
    AddSkinnedTube(skeleton, BodyPart::kArm, Sleeve(side), &mesh);
    AddSkinnedTube(skeleton, BodyPart::kLeg, TrouserLeg(side), &mesh);
  }
  FinishSurface(&mesh);
  return mesh;
}

Mesh MakeShoes(const wrinkle::Skeleton& skeleton) {
  Mesh mesh;
  mesh.name = "shoes";
  for (const float side : {1.0f, -1.0f}) {
    AddSkinnedTube(skeleton, BodyPart::kShoe, Shoe(side), &mesh);
  }
  FinishSurface(&mesh);
  return mesh;
}

void AddHands(const wrinkle::Skeleton& skeleton, Mesh* skin) {
  for (const float side : {1.0f, -1.0f}) {
    const float left = side > 0.0f ? 0.415f : 0.502f;
    const auto column = [&](int i, int count) {
      const float x = left + 0.0139f * static_cast<float>(i);
      return Rect{{x, 0.875f}, {x + 0.0139f * static_cast<float>(count) - 0.002f, 0.99f}};
    };
    AddSkinnedTube(skeleton, BodyPart::kHand, Palm(side, column(5, 1)), skin);
    for (int i = 0; i < 5; ++i) {
      AddSkinnedTube(skeleton, BodyPart::kHand, FingerTube(kFingers[i], side, column(i, 1)), skin);
    }
  }
}

}  // namespace furrow::character::generator
