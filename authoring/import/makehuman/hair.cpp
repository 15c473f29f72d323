// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/hair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/import/makehuman/face/skin_paint.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"
#include "character/mesh/tangents.h"

namespace furrow::authoring {
namespace {

constexpr int kSections = 4;          // of a lock, root to tip
constexpr float kLockArea = 0.4e-4f;  // square metres of scalp per lock
constexpr float kStreak = 0.08f;      // width of a lock in the picture, fraction of its width

// Finds the scalp: the vertices of the head above the chin.
class Scalp {
 public:
  Scalp(const character::Mesh& skin, const FaceLandmarks& face) : skin_(skin) {
    for (std::uint32_t v = 0; v < skin.vertices.size(); ++v) {
      if (skin.vertices[v].position.y > face.chin.y) head_.push_back(v);
    }
  }

  // The point at `height` above the surface near `p`. Also returns the surface normal there.
  glm::vec3 Over(const glm::vec3& p, float height, glm::vec3* normal) const {
    float nearest = std::numeric_limits<float>::max();
    const character::Vertex* found = nullptr;
    for (const std::uint32_t v : head_) {
      const glm::vec3 away = skin_.vertices[v].position - p;
      if (glm::dot(away, away) >= nearest) continue;
      nearest = glm::dot(away, away);
      found = &skin_.vertices[v];
    }
    if (found == nullptr) return p;
    *normal = found->normal;
    return p + found->normal * (glm::dot(found->position - p, found->normal) + height);
  }

 private:
  const character::Mesh& skin_;
  std::vector<std::uint32_t> head_;
};

// Adds locks to the hair's mesh.
class LockBuilder {
 public:
  LockBuilder(const character::Mesh& skin, const FaceLandmarks& face, character::Mesh* hair)
      : face_(face), scalp_(skin, face), hair_(hair) {}

  void Grow(const glm::vec3& root, const character::Vertex& influences, int number) {
    const auto random = [&](int what) { return HashLattice(number, what, 17); };
    const float amount = ScalpAmount(root, face_);
    const float top = glm::smoothstep(face_.sides[0].brow_middle.y, face_.crown.y, root.y);
    const float length = face_.Millimetres(
        glm::mix(16.0f, 38.0f, top) * (0.75f + 0.5f * random(1)) * glm::mix(0.5f, 1.0f, amount));
    const float lift = face_.Millimetres(glm::mix(1.2f, 5.5f, top) * (0.6f + 0.8f * random(2)));
    const float width = face_.Millimetres(glm::mix(2.4f, 4.2f, top) * (0.7f + 0.6f * random(3)));
    std::array<glm::vec3, kSections + 1> path;
    std::array<glm::vec3, kSections + 1> normals;
    glm::vec3 p = root;
    glm::vec3 way = Comb(root) + 0.5f * (glm::vec3(random(4), random(5), random(6)) - 0.5f);
    for (int i = 0; i <= kSections; ++i) {
      const float t = static_cast<float>(i) / kSections;
      normals[i] = glm::vec3(0.0f, 1.0f, 0.0f);
      path[i] = scalp_.Over(p, lift * std::sin(2.2f * t) + face_.Millimetres(0.3f), &normals[i]);
      way = way - normals[i] * glm::dot(way, normals[i]);
      if (glm::length(way) > 1e-6f) way = glm::normalize(way);
      p = path[i] + way * (length / kSections);
    }
    Add(path, normals, width, influences, random(7));
  }

 private:
  // The direction of combing: away from the whorl, and on top also forward and to the left, so that
  // the parting is on the right.
  [[nodiscard]] glm::vec3 Comb(const glm::vec3& p) const {
    const glm::vec3 whorl(face_.Millimetres(12.0f), face_.crown.y,
                          face_.head.z - face_.Millimetres(45.0f));
    const glm::vec3 away = p - whorl;
    const float top = glm::smoothstep(face_.sides[0].brow_outer.y, face_.crown.y, p.y);
    return glm::normalize(away) + top * glm::vec3(0.55f, 0.0f, 0.5f) +
           (1.0f - top) * glm::vec3(0.0f, -1.0f, 0.1f);
  }

  // Adds a strip with three vertices across, the middle one raised. It narrows to the tip.
  void Add(const std::array<glm::vec3, kSections + 1>& path,
           const std::array<glm::vec3, kSections + 1>& normals, float width,
           const character::Vertex& influences, float shade) {
    const auto first = static_cast<std::uint32_t>(hair_->vertices.size());
    for (int i = 0; i <= kSections; ++i) {
      const float t = static_cast<float>(i) / kSections;
      const glm::vec3 along =
          path[std::min(i + 1, kSections)] - path[std::max(i - 1, 0)] + glm::vec3(1e-9f);
      const glm::vec3 across = glm::normalize(glm::cross(normals[i], along));
      const float half = width * (1.0f - 0.85f * t * t);
      for (int side = -1; side <= 1; ++side) {
        character::Vertex vertex = influences;
        const auto s = static_cast<float>(side);
        vertex.position =
            path[i] + across * (s * half) + normals[i] * (side == 0 ? 0.2f * half : 0.0f);
        vertex.normal = glm::normalize(normals[i] + 0.35f * s * across);
        vertex.uv = {shade * (1.0f - kStreak) + kStreak * (0.5f + 0.5f * s), 1.0f - t};
        hair_->vertices.push_back(vertex);
      }
    }
    for (std::uint32_t i = 0; i < kSections; ++i) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        const std::uint32_t a = first + 3 * i + side;
        hair_->indices.insert(hair_->indices.end(), {a, a + 4, a + 1, a, a + 3, a + 4});
      }
    }
  }

  const FaceLandmarks& face_;
  Scalp scalp_;
  character::Mesh* hair_;
};

}  // namespace

character::Mesh BuildMakeHumanHair(const character::Mesh& skin, const FaceLandmarks& face,
                                   int material) {
  character::Mesh hair;
  hair.name = "hair";
  hair.material = material;
  LockBuilder locks(skin, face, &hair);
  float owed = 0.0f;  // area without locks so far
  int number = 0;
  const float area_of_lock = kLockArea * face.scale * face.scale;
  for (std::size_t i = 0; i + 2 < skin.indices.size(); i += 3) {
    const character::Vertex* corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &skin.vertices[skin.indices[i + k]];
    const glm::vec3& a = corners[0]->position;
    const glm::vec3 ab = corners[1]->position - a;
    const glm::vec3 ac = corners[2]->position - a;
    if (ScalpAmount(a + (ab + ac) / 3.0f, face) < 0.05f) continue;
    owed += 0.5f * glm::length(glm::cross(ab, ac));
    for (; owed > area_of_lock; owed -= area_of_lock) {
      ++number;
      float u = HashLattice(number, 8, 17), v = HashLattice(number, 9, 17);
      if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
      const glm::vec3 root = a + u * ab + v * ac;
      if (ScalpAmount(root, face) < HashLattice(number, 10, 17))
        continue;  // thins out the hairline
      locks.Grow(root, *corners[0], number);
    }
  }
  character::paint::ComputeTangents(hair.vertices, hair.indices);
  return hair;
}

character::Mesh BuildLashes(const BaseMesh& base, std::string_view group, const glm::vec3& eye,
                            float reach, int material) {
  character::Mesh lashes = BuildHelper(base, group, material);
  float low = std::numeric_limits<float>::max(), high = 0.0f;
  float left = low, right = std::numeric_limits<float>::lowest();
  for (const character::Vertex& vertex : lashes.vertices) {
    const float distance = glm::distance(vertex.position, eye);
    low = std::min(low, distance);
    high = std::max(high, distance);
    left = std::min(left, vertex.position.x);
    right = std::max(right, vertex.position.x);
  }
  constexpr float kAcross = 0.9f;  // keeps tips away from the row where the picture repeats
  for (character::Vertex& vertex : lashes.vertices) {
    const float out = (glm::distance(vertex.position, eye) - low) / std::max(high - low, 1e-6f);
    vertex.uv = {(vertex.position.x - left) / std::max(right - left, 1e-6f),
                 1.0f - kAcross * std::min(out / reach, 1.0f)};
  }
  character::paint::ComputeTangents(lashes.vertices, lashes.indices);
  return lashes;
}

character::Picture PaintMakeHumanHair(const SkinLook& look, int size) {
  constexpr glm::vec3 kDark{0.15f, 0.105f, 0.075f};
  constexpr glm::vec3 kLight{0.36f, 0.26f, 0.185f};
  const glm::vec3 dark = HairColour(kDark, look), bright = HairColour(kLight, look);
  character::Picture picture = BlankPicture("hair_colour", size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(size);
      const float root = static_cast<float>(y) / static_cast<float>(size);
      const float strand = ValueNoise({u * 180.0f, root * 2.0f, 0.5f});
      const float lock = ValueNoise({u * 14.0f, 0.5f, 3.5f});
      const float light = 0.55f * strand * (1.0f - 0.6f * root) + 0.35f * lock;
      SetTexel(&picture, x, y,
               glm::vec4(glm::mix(dark, bright, std::clamp(light, 0.0f, 1.0f)), 1.0f));
    }
  }
  return picture;
}

character::Picture PaintHairStrands(const SkinLook& look, int size) {
  constexpr float kStrands = 160.0f;
  const character::Picture colour = PaintMakeHumanHair(look, size);
  character::Picture picture = BlankPicture("hair_colour", size, size, 4);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(size);
      const float v = static_cast<float>(y) / static_cast<float>(size);
      const float gap = ValueNoise({u * kStrands, v * 4.0f, 11.5f});
      const std::uint8_t* from = &colour.pixels[static_cast<std::size_t>(y * size + x) * 3];
      std::uint8_t* out = TexelAt(&picture, x, y);
      std::copy_n(from, 3, out);
      out[3] = gap < 0.16f ? 0 : 255;
    }
  }
  return picture;
}

character::Picture PaintLashes(int size) {
  constexpr int kLashes = 34;
  character::Picture picture = BlankPicture("lash_colour", size, size, 4);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(size) * kLashes;
      const float out = 1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
      const int number = static_cast<int>(u);
      const float length = 0.55f + 0.45f * HashLattice(number, 1, 5);
      const float bend = 0.3f * (HashLattice(number, 2, 5) - 0.5f) * out;
      const float aside = std::abs(u - static_cast<float>(number) - 0.5f - bend);
      const float half = 0.42f * (1.0f - out / length);
      // The corners stay empty. Upper and lower lashes would form hooks there.
      const bool corner = u < 4.0f || u > kLashes - 6.0f;
      const bool on = !corner && (out < 0.05f || aside < half);
      SetTexel(&picture, x, y, glm::vec4(glm::vec3(0.06f, 0.045f, 0.04f), on ? 1.0f : 0.0f));
    }
  }
  return picture;
}

}  // namespace furrow::authoring
