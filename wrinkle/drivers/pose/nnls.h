// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace furrow::wrinkle {

inline constexpr int kMaxNnlsValues = 16;

// Non-negative least squares on normal equations: the x >= 0 that minimises |A x - y|, given the
// Gram matrix transpose(A) A and transpose(A) y.
//
// - `gram` n x n, symmetric positive definite. If columns of A may depend on each other, add a
//   small multiple of the identity. The solution is then unique, and continuous in y.
// - `rhs` and `x` have n entries; n is at most kMaxNnlsValues.
// - Deterministic, bounded in time, does not allocate.
// - Source: Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23.
void SolveNnls(std::span<const double> gram, std::span<const double> rhs, std::span<double> x);

// SolveNnls() for many right-hand sides of one Gram matrix. For up to four unknowns it keeps the
// inverse for every set of positive unknowns, so that solving needs no factorisation and no
// division.
class NnlsTable {
 public:
  explicit NnlsTable(std::span<const double> gram);
  void Solve(std::span<const double> rhs, std::span<double> x) const;

 private:
  static constexpr int kMaxTabled = 4;

  void Tabulate();
  void SolveByTable(std::span<const double> rhs, std::span<double> x) const;

  int n_ = 0;
  std::vector<double> gram_;
  // One n x n inverse per set of unknowns (the bits of its index), 0 outside the set. Empty if
  // there are too many unknowns, or if some set has no inverse.
  std::vector<double> inverses_;
};

}  // namespace furrow::wrinkle
