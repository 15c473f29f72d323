// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "character/character.h"

namespace furrow::character::generator {

// Appends the two triangles of a quad given counter-clockwise from outside. Corners that fall on
// the same place (a pole, a canthus) leave one triangle or none.
void AddQuad(Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

// Smooth normals from the triangles' areas, shared by vertices at the same place, so that UV seams
// do not show. Then tangents from the UVs.
void FinishSurface(Mesh* mesh);

// One entry of a piecewise linear function: (x, y), x increasing.
using Knot = std::pair<float, float>;
// Constant beyond both ends.
[[nodiscard]] float Interpolate(std::span<const Knot> knots, float x);

[[nodiscard]] float SmoothStep(float low, float high, float x);
[[nodiscard]] float Bump(float x, float width);  // exp(-(x / width)^2)

// A repeatable random number in [0, 1) from three integers: the same on every machine.
[[nodiscard]] float Hash(int x, int y, int z);
// Smooth noise in [-1, 1] with features of unit size, and three octaves of it.
[[nodiscard]] float Noise(const glm::vec3& p);
[[nodiscard]] float FractalNoise(const glm::vec3& p);

}  // namespace furrow::character::generator
