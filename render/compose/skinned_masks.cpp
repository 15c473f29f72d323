// SPDX-License-Identifier: Apache-2.0
#include "render/compose/skinned_masks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "render/mesh/uv_density.h"
#include "wrinkle/weights/vertex_influence.h"

namespace furrow::render {
namespace {

// Texels beyond the surface that filtering may sample.
constexpr float kReach = 1.5f;
// Largest difference of masks that counts as equal: two steps of a byte.
constexpr float kMaxDifference = 2.0f / 255.0f;
// Resolution, in texels per side, at which points are distinguished, and the number of texels that
// may be shared: specks, as where islands of an atlas touch.
constexpr int kUniqueSide = 1024;
constexpr int kMaxShared = 16;
// Barycentric distance. A texel nearer to an edge may belong to the neighbouring triangle.
constexpr float kEdge = 1e-3f;
// Limits that keep a character from delaying the picture. A face has a few dozen channels, and each
// of its vertices takes part in a few of them.
constexpr std::size_t kMaxChannels = 1024;
constexpr std::size_t kMaxPartsPerVertex = 64;
constexpr std::size_t kMaxParts = std::size_t{1} << 22;

// Returns true if the value is visible in 8 bits.
bool IsSeen(float value) { return value > 0.5f / 255.0f; }

}  // namespace

SkinnedMasks::SkinnedMasks(std::span<const character::Mesh> meshes,
                           std::span<const SkinnedShare> shares,
                           std::span<const glm::mat4> inverse_bind_matrices, int material)
    : first_parts_{0} {
  const bool is_small = AddParts(meshes, shares);
  if (is_small) FindChannels(shares);
  is_unique_ = is_small && channels_.size() <= kMaxChannels &&
               (channels_.empty() || (IsAtlas(triangles_) && FindUnique()));
  if (is_unique_) {
    FindRegions(meshes, inverse_bind_matrices, material);
  } else {
    channels_.clear();
    parts_ = {};
  }
}

// Joints and skin weights come from a file: a vertex may name joints that no share mentions, and a
// rig may put many shares on one joint. Both limits are checked per vertex, so memory stays bounded
// before the total is known.
bool SkinnedMasks::AddParts(std::span<const character::Mesh> meshes,
                            std::span<const SkinnedShare> shares) {
  std::vector<std::vector<std::uint32_t>> of_joint;  // indices of the shares of each joint
  for (std::uint32_t i = 0; i < shares.size(); ++i) {
    const auto joint = static_cast<std::size_t>(shares[i].joint);
    of_joint.resize(std::max(of_joint.size(), joint + 1));
    of_joint[joint].push_back(i);
  }
  for (const character::Mesh& mesh : meshes) {
    AddTriangles(mesh);
    for (const character::Vertex& vertex : mesh.vertices) {
      const std::size_t first = parts_.size();
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t joint = vertex.joints[i];
        if (joint >= of_joint.size() || !(vertex.skin_weights[i] > 0.0f)) continue;
        for (const std::uint32_t channel : of_joint[joint]) {
          const wrinkle::DynamicMask& mask = shares[channel].mask;
          const float lambda =
              wrinkle::Lambda(mask.lambda, vertex.skin_weights[i], mask.smooth_width);
          if (lambda > 0.0f) parts_.push_back({channel, lambda});
        }
        if (parts_.size() > std::min(first + kMaxPartsPerVertex, kMaxParts)) return false;
      }
      first_parts_.push_back(static_cast<std::uint32_t>(parts_.size()));
    }
  }
  return true;
}

// Corners are numbered over all meshes. The last entry of first_parts_ is the end of the parts so
// far, so its index is the number of vertices before this mesh.
void SkinnedMasks::AddTriangles(const character::Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(first_parts_.size() - 1);
  for (const std::uint32_t index : mesh.indices) corners_.push_back(first + index);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto uv = [&](std::size_t corner) { return mesh.vertices[mesh.indices[i + corner]].uv; };
    triangles_.push_back({uv(0), uv(1), uv(2)});
  }
}

void SkinnedMasks::FindChannels(std::span<const SkinnedShare> shares) {
  std::vector<bool> is_taken(shares.size(), false);
  for (const Part& part : parts_) is_taken[part.channel] = true;
  std::vector<std::uint32_t> numbers(shares.size(), 0);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    numbers[i] = static_cast<std::uint32_t>(channels_.size());
    if (is_taken[i]) channels_.push_back(shares[i]);
  }
  for (Part& part : parts_) part.channel = numbers[part.channel];
}

// A channel's region consists of all triangles with at least one affected corner. Corners of a
// triangle are visited in a row, so comparing with the last entry is enough to list it once.
void SkinnedMasks::FindRegions(std::span<const character::Mesh> meshes,
                               std::span<const glm::mat4> inverse_bind_matrices, int material) {
  std::vector<const character::Vertex*> vertices;
  for (const character::Mesh& mesh : meshes) {
    for (const character::Vertex& vertex : mesh.vertices) vertices.push_back(&vertex);
  }
  std::vector<std::vector<std::uint32_t>> reached(channels_.size());  // triangles of each channel
  for (std::uint32_t i = 0; i < corners_.size(); ++i) {
    for (const Part& part : PartsOf(corners_[i])) {
      std::vector<std::uint32_t>& list = reached[part.channel];
      if (list.empty() || list.back() != i / 3) list.push_back(i / 3);
    }
  }
  for (std::size_t channel = 0; channel < reached.size(); ++channel) {
    character::Mesh surface;
    for (const std::uint32_t triangle : reached[channel]) {
      for (std::size_t i = 0; i < 3; ++i) {
        surface.indices.push_back(static_cast<std::uint32_t>(surface.vertices.size()));
        surface.vertices.push_back(*vertices[corners_[3 * std::size_t{triangle} + i]]);
      }
    }
    regions_.push_back({static_cast<int>(channel), material,
                        JointBounds(surface, inverse_bind_matrices), MinUvPerMetre(surface)});
  }
}

std::span<const SkinnedMasks::Part> SkinnedMasks::PartsOf(std::uint32_t vertex) const {
  return std::span(parts_).subspan(first_parts_[vertex],
                                   first_parts_[vertex + 1] - first_parts_[vertex]);
}

bool SkinnedMasks::IsMasked(std::size_t triangle) const {
  return std::ranges::any_of(std::span(corners_).subspan(3 * triangle, 3),
                             [&](std::uint32_t vertex) { return !PartsOf(vertex).empty(); });
}

void SkinnedMasks::AddValues(const Place& place, float factor, std::vector<float>* values) const {
  for (int i = 0; i < 3; ++i) {
    const auto corner = static_cast<std::size_t>(3 * place.triangle + i);
    for (const Part& part : PartsOf(corners_[corner])) {
      (*values)[part.channel] += factor * place.shares[i] * part.lambda;
    }
  }
}

bool SkinnedMasks::IsAlike(const Place& a, const Place& b, std::vector<float>* difference) const {
  AddValues(a, 1.0f, difference);
  AddValues(b, -1.0f, difference);
  // The exchange counts a channel once even if both points use it, and returns the scratch memory
  // to zeros.
  float sum = 0.0f;
  for (const Place* place : {&a, &b}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Part& part :
           PartsOf(corners_[3 * static_cast<std::size_t>(place->triangle) + i])) {
        sum += std::abs(std::exchange((*difference)[part.channel], 0.0f));
      }
    }
  }
  return sum <= kMaxDifference;
}

// Returns true if the triangle is a line in the texture along which its masks differ.
bool SkinnedMasks::IsFlat(std::size_t triangle, std::vector<float>* difference) const {
  const auto& [a, b, c] = triangles_[triangle];
  if ((b.x - a.x) * (c.y - a.y) != (b.y - a.y) * (c.x - a.x)) return false;
  const auto number = static_cast<std::int32_t>(triangle);
  const Place corner{number, 0.0f, {1.0f, 0.0f, 0.0f}};
  return !IsAlike(corner, {number, 0.0f, {0.0f, 1.0f, 0.0f}}, difference) ||
         !IsAlike(corner, {number, 0.0f, {0.0f, 0.0f, 1.0f}}, difference);
}

// Rasterizes the atlas at a fixed size and compares every texel's second visitor with the first.
// Stops as soon as the limit is exceeded, so broken atlases are rejected quickly. IsAtlas() has
// bounded the number of texels before.
bool SkinnedMasks::FindUnique() const {
  const glm::ivec2 size(kUniqueSide);
  std::vector<Place> places(std::size_t{kUniqueSide} * kUniqueSide);
  std::vector<float> difference(channels_.size(), 0.0f);
  int shared = 0;
  for (std::size_t i = 0; i < triangles_.size() && shared <= kMaxShared; ++i) {
    if (IsFlat(i, &difference)) ++shared;
    ForTexels(triangles_[i], size, 0.0f, [&](const UvTexel& texel) {
      if (std::min({texel.shares.x, texel.shares.y, texel.shares.z}) < kEdge) return;
      const Place place{static_cast<std::int32_t>(i), 0.0f, texel.shares};
      Place& other = places[texel.index];
      if (other.triangle < 0) {
        other = place;
      } else if (shared <= kMaxShared && !IsAlike(other, place, &difference)) {
        ++shared;
      }
    });
  }
  return shared <= kMaxShared;
}

// Finds the nearest point for each texel. A texel inside a triangle belongs to it.
std::vector<SkinnedMasks::Place> SkinnedMasks::Places(glm::ivec2 size) const {
  std::vector<Place> places(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    ForTexels(triangles_[i], size, kReach, [&](const UvTexel& texel) {
      Place& place = places[texel.index];
      if (place.triangle >= 0 && place.distance_squared <= texel.distance_squared) return;
      place = {static_cast<std::int32_t>(i), texel.distance_squared, texel.shares};
    });
  }
  for (Place& place : places) {
    if (place.triangle >= 0 && !IsMasked(static_cast<std::size_t>(place.triangle))) {
      place.triangle = -1;
    }
  }
  return places;
}

void SkinnedMasks::AddTo(glm::ivec2 size, std::size_t first_channel,
                         std::vector<ComposeTile>* tiles) const {
  if (channels_.empty()) return;
  const std::vector<Place> places = Places(size);
  for (ComposeTile& tile : *tiles) FillTile(places, size, first_channel, &tile);
}

void SkinnedMasks::FillTile(const std::vector<Place>& places, glm::ivec2 size,
                            std::size_t first_channel, ComposeTile* tile) const {
  const glm::ivec2 first = tile->place * ComposeTile::kSide;
  const glm::ivec2 part = glm::min(size - first, glm::ivec2(ComposeTile::kSide));
  std::vector<std::vector<std::uint8_t>> planes(channels_.size());
  std::vector<float> values(channels_.size(), 0.0f);
  // Moves the sums of one texel to the planes of their channels and clears them for the next texel.
  // Planes are allocated on first use, because most tiles have few channels.
  const auto store = [&](std::size_t texel, std::uint32_t vertex) {
    for (const Part& taken : PartsOf(vertex)) {
      const float value = std::exchange(values[taken.channel], 0.0f);
      if (!IsSeen(value)) continue;
      planes[taken.channel].resize(ComposeTile::kTexels);
      planes[taken.channel][texel] =
          static_cast<std::uint8_t>(std::min(value, 1.0f) * 255.0f + 0.5f);
    }
  };
  for (int y = 0; y < part.y; ++y) {
    for (int x = 0; x < part.x; ++x) {
      const Place& place = places[static_cast<std::size_t>((first.y + y) * size.x + first.x + x)];
      if (place.triangle < 0) continue;
      AddValues(place, 1.0f, &values);
      for (const std::uint32_t vertex :
           std::span(corners_).subspan(3 * static_cast<std::size_t>(place.triangle), 3)) {
        store(static_cast<std::size_t>(y * ComposeTile::kSide + x), vertex);
      }
    }
  }
  for (std::size_t channel = 0; channel < planes.size(); ++channel) {
    if (planes[channel].empty()) continue;
    tile->skinned.push_back({first_channel + channel, std::move(planes[channel])});
  }
}

}  // namespace furrow::render
