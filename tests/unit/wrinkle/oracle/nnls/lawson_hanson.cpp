// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/nnls/lawson_hanson.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace furrow::wrinkle {
namespace {

using Column = std::vector<double>;

double Dot(const Column& a, const Column& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void Subtract(double factor, const Column& from, Column* to) {
  for (std::size_t i = 0; i < from.size(); ++i) (*to)[i] -= factor * from[i];
}

// Least squares over the chosen columns by Gram-Schmidt, applied twice, so that the factor is
// orthogonal to rounding.
Column LeastSquares(const std::vector<Column>& columns, const std::vector<std::size_t>& chosen,
                    const Column& y) {
  const std::size_t n = chosen.size();
  std::vector<Column> q;
  std::vector<Column> r(n, Column(n, 0.0));
  Column x(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    Column column = columns[chosen[k]];
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < k; ++i) {
        const double along = Dot(q[i], column);
        r[i][k] += along;
        Subtract(along, q[i], &column);
      }
    }
    r[k][k] = std::sqrt(Dot(column, column));
    for (double& value : column) value /= r[k][k];
    q.push_back(column);
    x[k] = Dot(column, y);
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t i = k + 1; i < n; ++i) x[k] -= r[k][i] * x[i];
    x[k] /= r[k][k];
  }
  return x;
}

}  // namespace

std::vector<double> LawsonHanson(const std::vector<Column>& columns, const std::vector<double>& y,
                                 double ridge) {
  const std::size_t n = columns.size();
  std::vector<Column> a = columns;
  Column b = y;
  b.resize(y.size() + n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    a[k].resize(b.size(), 0.0);
    a[k][y.size() + k] = std::sqrt(ridge);
  }
  Column x(n, 0.0);
  std::vector<std::size_t> positive;
  for (std::size_t round = 0; round < 100 * n; ++round) {
    Column residual = b;
    for (std::size_t k = 0; k < n; ++k) Subtract(x[k], a[k], &residual);
    std::size_t entering = n;
    double steepest = 1e-14 * std::sqrt(Dot(b, b));
    for (std::size_t k = 0; k < n; ++k) {
      if (std::find(positive.begin(), positive.end(), k) != positive.end()) continue;
      const double slope = Dot(a[k], residual);
      if (slope > steepest) {
        steepest = slope;
        entering = k;
      }
    }
    if (entering == n) break;
    positive.push_back(entering);
    while (!positive.empty()) {
      const Column solution = LeastSquares(a, positive, b);
      double step = 1.0;
      for (std::size_t i = 0; i < positive.size(); ++i) {
        const double now = x[positive[i]];
        if (solution[i] <= 0.0) step = std::min(step, now / (now - solution[i]));
      }
      for (std::size_t i = 0; i < positive.size(); ++i) {
        double& value = x[positive[i]];
        value += step * (solution[i] - value);
        if (step < 1.0 && value < 1e-15) value = 0.0;
      }
      if (step == 1.0) break;
      std::erase_if(positive, [&](std::size_t k) { return x[k] <= 0.0; });
    }
  }
  return x;
}

}  // namespace furrow::wrinkle
