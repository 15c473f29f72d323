// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/nnls.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

using Row = std::vector<double>;

// Columns a_k of a random problem, as rows; the Gram matrix with a ridge on its diagonal.
struct Problem {
  std::vector<Row> columns;
  Row gram;

  Problem(int n, int dimension, unsigned seed, double ridge = 0.0) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int k = 0; k < n; ++k) {
      Row column;
      for (int i = 0; i < dimension; ++i) column.push_back(normal(random));
      columns.push_back(column);
    }
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n; ++k)
        gram.push_back(Dot(columns[i], columns[k]) + (i == k ? ridge : 0.0));
    }
  }
  static double Dot(const Row& a, const Row& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }
  [[nodiscard]] Row Rhs(const Row& y) const {
    Row rhs;
    for (const Row& column : columns) rhs.push_back(Dot(column, y));
    return rhs;
  }
  [[nodiscard]] Row Mixture(const Row& x) const {
    Row y(columns[0].size(), 0.0);
    for (std::size_t k = 0; k < x.size(); ++k) {
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += x[k] * columns[k][i];
    }
    return y;
  }
  // x'Gx / 2 - b'x: what is minimised, up to a constant.
  [[nodiscard]] double Cost(const Row& x, const Row& rhs) const {
    double cost = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      cost -= rhs[i] * x[i];
      for (std::size_t k = 0; k < x.size(); ++k) cost += 0.5 * x[i] * gram[i * x.size() + k] * x[k];
    }
    return cost;
  }
};

// Gaussian elimination with pivoting on the chosen unknowns; empty when it does not work out.
Row SolveSubset(const Problem& problem, const Row& rhs, unsigned subset) {
  const std::size_t n = rhs.size();
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < n; ++i) {
    if ((subset >> i) & 1u) chosen.push_back(i);
  }
  std::vector<Row> a;
  for (const std::size_t i : chosen) {
    Row row;
    for (const std::size_t k : chosen) row.push_back(problem.gram[i * n + k]);
    row.push_back(rhs[i]);
    a.push_back(row);
  }
  const std::size_t m = chosen.size();
  for (std::size_t c = 0; c < m; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < m; ++r) {
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    }
    if (std::abs(a[pivot][c]) < 1e-12) return {};
    std::swap(a[c], a[pivot]);
    for (std::size_t r = 0; r < m; ++r) {
      if (r == c) continue;
      const double factor = a[r][c] / a[c][c];
      for (std::size_t k = c; k <= m; ++k) a[r][k] -= factor * a[c][k];
    }
  }
  Row x(n, 0.0);
  for (std::size_t c = 0; c < m; ++c) x[chosen[c]] = a[c][m] / a[c][c];
  return x;
}

// The best of all 2^n choices of which unknowns are positive.
Row BruteForce(const Problem& problem, const Row& rhs) {
  Row best(rhs.size(), 0.0);
  double best_cost = 0.0;
  for (unsigned subset = 1; subset < (1u << rhs.size()); ++subset) {
    const Row x = SolveSubset(problem, rhs, subset);
    if (x.empty() || *std::min_element(x.begin(), x.end()) < 0.0) continue;
    const double cost = problem.Cost(x, rhs);
    if (cost < best_cost) {
      best_cost = cost;
      best = x;
    }
  }
  return best;
}

TEST(Nnls, AgreesWithEveryActiveSetTried) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const int n = 1 + static_cast<int>(seed % 7);
    const Problem problem(n, 6, seed, n > 5 ? 1e-6 : 0.0);
    Row y;
    for (int i = 0; i < 6; ++i) y.push_back(normal(random));
    const Row rhs = problem.Rhs(y);
    Row x(rhs.size());
    SolveNnls(problem.gram, rhs, x);
    const Row expected = BruteForce(problem, rhs);
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_GE(x[k], 0.0);
      EXPECT_NEAR(x[k], expected[k], 1e-5) << "seed " << seed << ", unknown " << k;
    }
  }
}

// The table gives the same solutions as the matrix, at and around ties too.
TEST(NnlsTable, AgreesWithTheSolver) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const int n = 1 + static_cast<int>(seed % 6);  // tabled up to four
    const Problem problem(n, 1 + static_cast<int>(seed % 5), seed, 1e-6);
    const NnlsTable table(problem.gram);
    for (int target = 0; target < 10; ++target) {
      Row y(problem.columns[0].size());
      for (double& value : y) value = target % 3 == 0 ? std::round(normal(random)) : normal(random);
      const Row rhs = problem.Rhs(y);
      Row expected(rhs.size());
      Row x(rhs.size(), -1.0);
      SolveNnls(problem.gram, rhs, expected);
      table.Solve(rhs, x);
      for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], expected[k], 1e-7);
    }
  }
}

TEST(NnlsTable, SolvesWhatHasNoInverse) {
  const NnlsTable table(Row{1.0, 1.0, 1.0, 1.0});
  Row x(2, -1.0);
  table.Solve(Row{1.0, 1.0}, x);
  EXPECT_NEAR(x[0] + x[1], 1.0, 1e-9);
}

TEST(Nnls, RecoversMixturesInsideTheCone) {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Problem problem(kMaxNnlsValues, 24, seed);
    Row wanted;
    for (int k = 0; k < kMaxNnlsValues; ++k) wanted.push_back(k % 3 == 0 ? 0.0 : uniform(random));
    Row x(wanted.size());
    SolveNnls(problem.gram, problem.Rhs(problem.Mixture(wanted)), x);
    for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], wanted[k], 1e-8);
  }
}

TEST(Nnls, GivesUnitVectorsAtThePosesAndZeroAtNeutral) {
  const Problem problem(5, 9, 1);
  Row x(5);
  SolveNnls(problem.gram, Row(5, 0.0), x);
  EXPECT_EQ(x, Row(5, 0.0));
  for (std::size_t k = 0; k < 5; ++k) {
    SolveNnls(problem.gram, problem.Rhs(problem.columns[k]), x);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(x[i], i == k ? 1.0 : 0.0, 1e-10);
  }
}

TEST(Nnls, ANegativeTargetGivesZero) {
  const Problem problem(1, 3, 2);
  Row x(1, 5.0);
  SolveNnls(problem.gram, problem.Rhs(problem.Mixture({-1.0})), x);
  EXPECT_EQ(x[0], 0.0);
}

// Two equal poses: with a ridge they share, instead of one taking all by the order of rounding.
TEST(Nnls, EqualColumnsShareUnderARidge) {
  const Row gram = {1.0 + 1e-6, 1.0, 1.0, 1.0 + 1e-6};
  Row x(2);
  SolveNnls(gram, Row{1.0, 1.0}, x);
  EXPECT_NEAR(x[0], 0.5, 1e-5);
  EXPECT_NEAR(x[1], 0.5, 1e-5);
}

TEST(Nnls, EndsOnASingularMatrix) {
  Row x(2, -1.0);
  SolveNnls(Row{1.0, 1.0, 1.0, 1.0}, Row{1.0, 1.0}, x);
  EXPECT_NEAR(x[0] + x[1], 1.0, 1e-9);
  SolveNnls(Row{0.0, 0.0, 0.0, 0.0}, Row{1.0, 1.0}, x);
  EXPECT_EQ(x, (Row{0.0, 0.0}));
}

TEST(Nnls, IsContinuousInItsTarget) {
  const Problem problem(6, 5, 3, 1e-3);  // more unknowns than dimensions
  double worst = 0.0;
  Row before;
  for (int step = 0; step <= 6283; ++step) {
    const double t = step * 1e-3;
    const Row y = {std::cos(t), std::sin(t), std::sin(2.0 * t), std::cos(3.0 * t), 0.5};
    Row x(6);
    SolveNnls(problem.gram, problem.Rhs(y), x);
    for (std::size_t k = 0; k < before.size(); ++k)
      worst = std::max(worst, std::abs(x[k] - before[k]));
    before = x;
  }
  // A jump between active sets would be of the size of the weights, about 1.
  EXPECT_LT(worst, 0.02);
}

}  // namespace
}  // namespace furrow::wrinkle
