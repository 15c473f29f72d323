// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

// Repeatable noise: every function returns the same value on every machine.
//
// There are two independent sequences, HashLattice() with ValueNoise() and RandomAt() with
// SignedNoise(). They are kept apart because the bytes of shipped characters depend on them.
namespace furrow::authoring {

// A random number in [0, 1) for a lattice point.
[[nodiscard]] float HashLattice(int x, int y, int z);

// Smooth value noise over HashLattice(), in [0, 1], with features of size 1.
[[nodiscard]] float ValueNoise(const glm::vec3& p);

// A random number in [0, 1) for three integers, with better mixed bits than HashLattice().
[[nodiscard]] float RandomAt(int x, int y, int z);

// Smooth value noise over RandomAt(), in [-1, 1], with features of size 1.
[[nodiscard]] float SignedNoise(const glm::vec3& p);

// Three octaves of SignedNoise(), in [-1, 1].
[[nodiscard]] float FractalNoise(const glm::vec3& p);

// A random number in [0, 1) for the bits of `seed`, which need not be mixed.
[[nodiscard]] float RandomFromBits(std::uint32_t seed);

}  // namespace furrow::authoring
