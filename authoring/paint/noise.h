// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace furrow::character {

// A fixed random number in [0, 1) for a lattice point: the same on every machine.
[[nodiscard]] inline float HashLattice(int x, int y, int z) {
  auto h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
           static_cast<std::uint32_t>(y) * 0xd8163841u ^
           static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return static_cast<float>((h ^ (h >> 15)) >> 8) / 16777216.0f;
}

// Value noise in [0, 1], smooth, with features of size 1.
[[nodiscard]] inline float ValueNoise(const glm::vec3& p) {
  const glm::vec3 cell = glm::floor(p);
  const glm::vec3 f = p - cell;
  const glm::vec3 s = f * f * (3.0f - 2.0f * f);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y),
            z = static_cast<int>(cell.z);
  const auto row = [&](int dy, int dz) {
    return glm::mix(HashLattice(x, y + dy, z + dz), HashLattice(x + 1, y + dy, z + dz), s.x);
  };
  return glm::mix(glm::mix(row(0, 0), row(1, 0), s.y), glm::mix(row(0, 1), row(1, 1), s.y), s.z);
}

}  // namespace furrow::character
