// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/head/face_parts.h"
#include "authoring/generator/head/hair_mesh.h"
#include "authoring/generator/head/head_skin.h"
#include "authoring/generator/head/lid_strips.h"
#include "authoring/generator/head/skinning.h"

namespace furrow::authoring {
namespace {

std::size_t Triangles(const HeadMesh& head) { return head.mesh.indices.size() / 3; }

TEST(HeadMesh, LevelsShareOneShape) {
  const HeadMesh coarse = MakeHeadSkin(DefaultHead(), 0);
  const HeadMesh middle = MakeHeadSkin(DefaultHead(), 1);
  const HeadMesh fine = MakeHeadSkin(DefaultHead(), 2);
  EXPECT_NEAR(static_cast<double>(Triangles(coarse)), 3000.0, 400.0);
  EXPECT_GT(Triangles(middle), 2 * Triangles(coarse));
  EXPECT_GT(Triangles(fine), 2 * Triangles(middle));
  // Vertices of the coarse grid are also vertices of the finer grids.
  int kept = 0, all = 0;
  for (std::size_t i = 0; i < coarse.info.size(); i += 7) {
    if (coarse.info[i].part != kFacePart) continue;
    ++all;
    float nearest = 1e9f;
    for (const HeadVertex& vertex : middle.info) {
      nearest = std::min(nearest, glm::distance(vertex.place, coarse.info[i].place));
    }
    kept += nearest < 1e-3f;
  }
  EXPECT_GT(kept, all * 9 / 10);
}

// The larger and the smaller principal stretch of a triangle in the unwrapping: surface length per
// texture length.
struct Stretch {
  double large;
  double small;
};

std::vector<Stretch> Stretches(const HeadMesh& head) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < head.mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &head.mesh.indices[i];
    if (head.info[t[0]].part != kFacePart) continue;
    const glm::vec3 middle =
        (head.info[t[0]].place + head.info[t[1]].place + head.info[t[2]].place) / 3.0f;
    if (middle.z < 3.0f || middle.y > 6.0f || middle.y < -10.0f) continue;  // outside the face
    const character::Vertex& a = head.mesh.vertices[t[0]];
    const character::Vertex& b = head.mesh.vertices[t[1]];
    const character::Vertex& c = head.mesh.vertices[t[2]];
    const glm::dvec3 e1(b.position - a.position), e2(c.position - a.position);
    const glm::dvec2 u1(b.uv - a.uv), u2(c.uv - a.uv);
    const double det = u1.x * u2.y - u1.y * u2.x;
    if (std::abs(det) < 1e-12) continue;
    // The metric of the map from the picture to the surface, and its principal stretches.
    const glm::dvec3 du = (e1 * u2.y - e2 * u1.y) / det;
    const glm::dvec3 dv = (e2 * u1.x - e1 * u2.x) / det;
    const double half = 0.5 * (glm::dot(du, du) + glm::dot(dv, dv));
    const double area = glm::length(glm::cross(du, dv));
    const double root = std::sqrt(std::max(half * half - area * area, 0.0));
    stretches.push_back({std::sqrt(half + root), std::sqrt(std::max(half - root, 0.0))});
  }
  return stretches;
}

TEST(HeadMesh, UnwrapsTheFaceWithLittleStretch) {
  const std::vector<Stretch> stretches = Stretches(MakeHeadSkin());
  ASSERT_GT(stretches.size(), 1500u);
  std::vector<double> ratios;
  for (const Stretch& s : stretches) ratios.push_back(s.large / std::max(s.small, 1e-9));
  std::sort(ratios.begin(), ratios.end());
  EXPECT_LT(ratios[ratios.size() / 2], 2.0);
  EXPECT_LT(ratios[ratios.size() * 9 / 10], 4.0);
}

// Closed lips show no gap: their inner sides overlap right behind the line.
TEST(HeadMesh, LipsOverlapBehindTheirLine) {
  const HeadMesh head = MakeHeadSkin();
  float upper = 1e9f, lower = -1e9f;
  for (const HeadVertex& vertex : head.info) {
    if (vertex.part != kMouthInside || std::abs(vertex.place.x) > 0.2f) continue;
    if (vertex.mouth_side > 0.0f) upper = std::min(upper, vertex.place.y);
    if (vertex.mouth_side < 0.0f) lower = std::max(lower, vertex.place.y);
  }
  EXPECT_LT(upper, lower - 0.005f);
}

// Weights change little between neighbouring vertices, except across the mouth and the eyes.
TEST(HeadMesh, SkinWeightsAreSmooth) {
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  HeadMesh head = MakeHeadSkin(DefaultHead(), kFinestLevel);
  SkinHead(skeleton, &head);
  const auto change = [&](std::uint32_t i, std::uint32_t j) {
    std::map<int, float> weights;
    for (int k = 0; k < 4; ++k) {
      weights[head.mesh.vertices[i].joints[k]] += head.mesh.vertices[i].skin_weights[k];
      weights[head.mesh.vertices[j].joints[k]] -= head.mesh.vertices[j].skin_weights[k];
    }
    float sum = 0.0f;
    for (const auto& [joint, difference] : weights) sum += std::abs(difference);
    return 0.5f * sum;
  };
  std::vector<float> changes;
  for (std::size_t i = 0; i < head.mesh.indices.size(); i += 3) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = head.mesh.indices[i + k], b = head.mesh.indices[i + (k + 1) % 3];
      const HeadVertex& va = head.info[a];
      const HeadVertex& vb = head.info[b];
      if (va.part != kFacePart || vb.part != kFacePart || va.place.z < 2.0f) continue;
      if (va.mouth_side != vb.mouth_side || va.eye_side != vb.eye_side) continue;
      if (glm::distance(va.place, vb.place) < 0.05f) continue;
      changes.push_back(change(a, b) / glm::distance(va.place, vb.place));
    }
  }
  std::sort(changes.begin(), changes.end());
  ASSERT_GT(changes.size(), 5000u);
  EXPECT_LT(changes[changes.size() / 2], 0.5f);  // per centimetre
  EXPECT_LT(changes[changes.size() * 99 / 100], 2.0f);
}

// The liquid touches the eyeball (12 mm) above the lid's edge, and it faces the viewer.
TEST(HeadMesh, TearsLieBetweenTheLowerLidsAndTheEyes) {
  const HeadMesh tears = MakeTears();
  float highest = -1e9f;
  for (const HeadVertex& vertex : tears.info) {
    const glm::vec3 d = vertex.place - EyeCentre(vertex.place.x > 0.0f ? 1.0f : -1.0f);
    EXPECT_GT(glm::length(d), kEyeRadius + 0.005f);
    EXPECT_LT(glm::length(d), kEyeRadius + 0.08f);
    EXPECT_LT(d.y, 0.25f);
    highest = std::max(highest, d.z);
  }
  EXPECT_GT(highest, 1.0f);
  int facing = 0;
  for (const character::Vertex& vertex : tears.mesh.vertices) facing += vertex.normal.z > 0.3f;
  EXPECT_GT(facing, static_cast<int>(tears.mesh.vertices.size()) * 3 / 4);
}

// The shells lie in front of the corneas (12.7 mm) and are as large as the openings of the eyes.
TEST(HeadMesh, LidShadesLieBetweenTheLidsInFrontOfTheEyes) {
  const HeadMesh shades = MakeLidShades();
  int facing = 0;
  for (std::size_t i = 0; i < shades.info.size(); ++i) {
    const glm::vec3 place = shades.info[i].place;
    const glm::vec3 d = place - EyeCentre(place.x > 0.0f ? 1.0f : -1.0f);
    EXPECT_GT(glm::length(d), kEyeRadius + 0.07f);
    EXPECT_LT(glm::length(d), kEyeRadius + 0.1f);
    EXPECT_GT(d.z, 0.0f);
    facing += shades.mesh.vertices[i].normal.z > 0.0f;
    EXPECT_GE(shades.mesh.vertices[i].uv.y, 0.25f);
    EXPECT_LE(shades.mesh.vertices[i].uv.y, 0.75f);
  }
  EXPECT_EQ(facing, static_cast<int>(shades.info.size()));
}

// A lash follows the edge of its lid from root to tip.
TEST(HeadMesh, LashesAreStiff) {
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  HeadMesh lashes = MakeLashes();
  SkinHead(skeleton, &lashes);
  constexpr std::size_t kPerLash = 6;
  ASSERT_EQ(lashes.mesh.vertices.size() % kPerLash, 0u);
  for (std::size_t v = 0; v < lashes.mesh.vertices.size(); ++v) {
    const character::Vertex& root = lashes.mesh.vertices[v / kPerLash * kPerLash];
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(lashes.mesh.vertices[v].joints[k], root.joints[k]);
      EXPECT_EQ(lashes.mesh.vertices[v].skin_weights[k], root.skin_weights[k]);
    }
  }
}

TEST(HeadMesh, HairCoversTheScalpButNotTheFace) {
  for (const float sex : {1.0f, -1.0f}) {
    const HeadShape shape({.sex = sex});
    const HeadMesh hair = MakeHair(shape);
    int in_face = 0;
    float lowest = 1e9f;
    for (const HeadVertex& vertex : hair.info) {
      const glm::vec3& p = vertex.place;
      in_face += std::abs(p.x) < 4.0f && p.y < 3.5f && p.z > 6.0f;
      lowest = std::min(lowest, p.y);
    }
    EXPECT_EQ(in_face, 0) << sex;
    EXPECT_LT(lowest, -5.0f) << sex;
    EXPECT_LT(Triangles(hair), 40000u);
  }
}

}  // namespace
}  // namespace furrow::authoring
