// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// The reference poses of one nnls driver, prepared for SolveNnls(). Private to wrinkle/.

// Reference poses that depend on one another: one of them is almost a mix of the others.
struct PoseDependence {
  std::vector<int> poses;  // two or more
  // Between the two poses, or between one pose and the best mix of the others; [-1, 1].
  double cosine = 0.0;
};

struct PoseGram {
  std::vector<glm::dvec3> directions;  // K x P: unit displacements; 0 for poses that move nothing
  std::vector<double> gram;            // K x K: of the directions, with the ridge on its diagonal
  std::vector<PoseDependence> dependences;
};

// `displacements`: K x P, value by value; all zero for a pose that moves nothing. K is at most
// kMaxNnlsValues.
//
// - The ridge is 1e-6 of the mean diagonal. It makes the fit unique and continuous: poses that
//   coincide share their weight, and noise of the size e in a pose changes a weight by at most
//   500 e.
// - Poses that depend on one another up to rounding are made to depend exactly: directions with a
//   singular value below 3e-5 are removed. Otherwise a fit would use differences of rounding.
[[nodiscard]] PoseGram MakePoseGram(std::span<const glm::dvec3> displacements,
                                    std::size_t num_values);

}  // namespace furrow::wrinkle
