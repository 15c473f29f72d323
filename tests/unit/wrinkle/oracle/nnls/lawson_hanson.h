// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace furrow::wrinkle {

// The x >= 0 that minimises |A x - y|^2 + ridge |x|^2, for comparison with the solver.
//
// - `columns`: the columns of A, each as long as `y`.
// - Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23, on the columns themselves
//   (the solver uses their Gram matrix), in double precision. The ridge enters as rows below A:
//   sqrt(ridge) times the identity.
[[nodiscard]] std::vector<double> LawsonHanson(const std::vector<std::vector<double>>& columns,
                                               const std::vector<double>& y, double ridge);

}  // namespace furrow::wrinkle
