// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

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

// SolveNnls() for many right-hand sides of one Gram matrix. Of up to four unknowns the inverses for
// every choice of which are positive are kept, so that nothing is left to factor or to divide.
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
  // n x n for each set of unknowns (a bit each), 0 for those that are not in it; empty: too many,
  // or a set whose inverse is not to be had.
  std::vector<double> inverses_;
};

}  // namespace furrow::wrinkle
