// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace furrow::wrinkle {

inline constexpr int kMaxNnlsValues = 16;

// Non-negative least squares on normal equations: the x >= 0 that minimises |A x - y|, given the
// Gram matrix transpose(A) A and transpose(A) y.
//
// - `gram` n x n, symmetric positive definite. Where columns of A may depend on each other, add a
//   small multiple of the identity: the solution is then unique, and continuous in y.
// - `rhs`, `x` n long; n at most kMaxNnlsValues.
// - Deterministic, bounded in time, does not allocate.
// - Source: Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23.
void SolveNnls(std::span<const double> gram, std::span<const double> rhs, std::span<double> x);

}  // namespace furrow::wrinkle
