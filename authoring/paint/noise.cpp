// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/noise.h"

#include <glm/common.hpp>

namespace furrow::authoring {
namespace {

// The top 24 bits fill a float's mantissa exactly.
float UnitFromBits(std::uint32_t bits) { return static_cast<float>(bits >> 8) / 16777216.0f; }

std::uint32_t LatticeBits(int x, int y, int z) {
  return static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u ^
         static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
}

// Interpolates `corner(x, y, z)`, a value per lattice point, smoothly along all axes.
template <class Corner, class Mix>
float InterpolateLattice(const glm::vec3& p, const Corner& corner, const Mix& mix) {
  const glm::vec3 cell = glm::floor(p);
  const glm::vec3 f = p - cell;
  const glm::vec3 s = f * f * (3.0f - 2.0f * f);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y),
            z = static_cast<int>(cell.z);
  const auto row = [&](int dy, int dz) {
    return mix(corner(x, y + dy, z + dz), corner(x + 1, y + dy, z + dz), s.x);
  };
  return mix(mix(row(0, 0), row(1, 0), s.y), mix(row(0, 1), row(1, 1), s.y), s.z);
}

}  // namespace

// A 32-bit integer hash by multiplications and shifted xors (Wellons' lowbias32).
float RandomFromBits(std::uint32_t seed) {
  std::uint32_t h = seed;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return UnitFromBits(h ^ (h >> 16));
}

float HashLattice(int x, int y, int z) {
  std::uint32_t h = LatticeBits(x, y, z);
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return UnitFromBits(h ^ (h >> 15));
}

float ValueNoise(const glm::vec3& p) {
  return InterpolateLattice(p, HashLattice,
                            [](float a, float b, float t) { return glm::mix(a, b, t); });
}

float RandomAt(int x, int y, int z) { return RandomFromBits(LatticeBits(x, y, z)); }

float SignedNoise(const glm::vec3& p) {
  // This form of linear interpolation rounds differently from glm::mix().
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  return InterpolateLattice(p, RandomAt, mix) * 2.0f - 1.0f;
}

// Three octaves. The factors are not exactly 2 and 4, and the offsets differ, so that lattice
// points do not coincide. The weights sum to 1.
float FractalNoise(const glm::vec3& p) {
  return 0.57f * SignedNoise(p) + 0.29f * SignedNoise(p * 2.03f + 17.0f) +
         0.14f * SignedNoise(p * 4.11f + 31.0f);
}

}  // namespace furrow::authoring
