// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/nnls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace furrow::wrinkle {
namespace {

using Vector = std::array<double, kMaxNnlsValues>;

// The unknowns that may be positive, in the order of their entry.
struct PassiveSet {
  std::array<int, kMaxNnlsValues> members{};
  int size = 0;
  unsigned bits = 0;  // the same set

  [[nodiscard]] bool Has(int value) const { return (bits >> value & 1u) != 0; }
  void Add(int value) {
    members[size++] = value;
    bits |= 1u << value;
  }
  template <class Predicate>
  void RemoveIf(Predicate predicate) {
    size = static_cast<int>(std::remove_if(members.begin(), members.begin() + size, predicate) -
                            members.begin());
    bits = 0;
    for (int i = 0; i < size; ++i) bits |= 1u << members[i];
  }
};

// Solves least squares over the passive unknowns alone, by Cholesky. False if rounding makes a
// pivot non-positive.
bool SolvePassive(std::span<const double> gram, std::span<const double> rhs, int n,
                  const PassiveSet& set, Vector* solution) {
  std::array<Vector, kMaxNnlsValues> lower;
  Vector z{};
  for (int i = 0; i < set.size; ++i) {
    const int row = set.members[i];
    for (int j = 0; j <= i; ++j) {
      double sum = gram[row * n + set.members[j]];
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      if (i != j) {
        lower[i][j] = sum / lower[j][j];
      } else if (sum > 0.0) {
        lower[i][i] = std::sqrt(sum);
      } else {
        // The columns of the set depend on one another within rounding.
        return false;
      }
    }
    double sum = rhs[row];
    for (int k = 0; k < i; ++k) sum -= lower[i][k] * z[k];
    z[i] = sum / lower[i][i];
  }
  // Back substitution with the transposed factor.
  for (int i = set.size - 1; i >= 0; --i) {
    for (int k = i + 1; k < set.size; ++k) z[i] -= lower[k][i] * z[k];
    z[i] /= lower[i][i];
    (*solution)[set.members[i]] = z[i];
  }
  return true;
}

// The unknown outside the set that lowers the error most when it grows; -1 if none lowers it.
int SteepestOutside(std::span<const double> gram, std::span<const double> rhs,
                    std::span<const double> x, const PassiveSet& set, double tolerance) {
  const int n = static_cast<int>(rhs.size());
  int best = -1;
  double best_slope = tolerance;
  for (int i = 0; i < n; ++i) {
    if (set.Has(i)) continue;
    double slope = rhs[i];
    for (int k = 0; k < n; ++k) {
      // Unknowns outside the set are 0.
      if (set.Has(k)) slope -= gram[i * n + k] * x[k];
    }
    if (slope > best_slope) {
      best_slope = slope;
      best = i;
    }
  }
  return best;
}

// Moves x towards the unconstrained solution until an unknown reaches 0, and drops that unknown
// from the set. True if x reached the solution.
bool StepTowards(const Vector& solution, PassiveSet* set, std::span<double> x) {
  double step = 1.0;
  int blocking = -1;
  for (int i = 0; i < set->size; ++i) {
    const int value = set->members[i];
    if (solution[value] > 0.0) continue;
    // The share of the step at which this unknown becomes 0.
    const double reach = x[value] / (x[value] - solution[value]);
    if (blocking < 0 || reach < step) {
      step = std::isfinite(reach) ? reach : 0.0;
      blocking = value;
    }
  }
  for (int i = 0; i < set->size; ++i) {
    // max() removes the rounding of unknowns that stop at 0.
    const int value = set->members[i];
    x[value] = std::max(0.0, x[value] + step * (solution[value] - x[value]));
  }
  if (blocking < 0) return true;
  x[blocking] = 0.0;
  set->RemoveIf([&](int value) { return x[value] <= 0.0; });
  return false;
}

// solution = inverse * rhs, for a row-major matrix.
void Multiply(const double* inverse, std::span<const double> rhs, Vector* solution) {
  for (std::size_t i = 0; i < rhs.size(); ++i, inverse += rhs.size()) {
    double sum = 0.0;
    for (std::size_t k = 0; k < rhs.size(); ++k) sum += inverse[k] * rhs[k];
    (*solution)[i] = sum;
  }
}

// Slopes below this share of the largest number are rounding errors. They would let unknowns enter
// and leave the set forever.
double Tolerance(std::span<const double> rhs) {
  double largest = 0.0;
  for (const double value : rhs) largest = std::max(largest, std::abs(value));
  return 1e-12 * largest;
}

}  // namespace

void SolveNnls(std::span<const double> gram, std::span<const double> rhs, std::span<double> x) {
  const int n = static_cast<int>(rhs.size());
  std::fill(x.begin(), x.end(), 0.0);
  const double tolerance = Tolerance(rhs);
  PassiveSet set;
  // The algorithm ends by itself in exact arithmetic. The limit of 3 n rounds, as in Lawson and
  // Hanson's program, ends cycles that rounding causes.
  for (int round = 0; round < 3 * n; ++round) {
    const int entering = SteepestOutside(gram, rhs, x, set, tolerance);
    if (entering < 0) return;
    set.Add(entering);
    Vector solution{};
    while (set.size > 0) {
      if (!SolvePassive(gram, rhs, n, set, &solution)) return;  // x is already feasible
      if (StepTowards(solution, &set, x)) break;
    }
  }
}

NnlsTable::NnlsTable(std::span<const double> gram)
    : n_(static_cast<int>(std::lround(std::sqrt(static_cast<double>(gram.size()))))),
      gram_(gram.begin(), gram.end()) {
  if (n_ <= kMaxTabled) Tabulate();
}

// A column of an inverse is the solution for a unit vector.
void NnlsTable::Tabulate() {
  const auto n = static_cast<std::size_t>(n_);
  inverses_.assign((std::size_t{1} << n) * n * n, 0.0);
  for (unsigned bits = 1; bits < (1u << n_); ++bits) {
    PassiveSet set;
    for (int i = 0; i < n_; ++i) {
      if ((bits >> i & 1u) != 0) set.Add(i);
    }
    for (int column = 0; column < n_; ++column) {
      if ((bits >> column & 1u) == 0) continue;
      Vector unit{};
      Vector solution{};
      unit[static_cast<std::size_t>(column)] = 1.0;
      // One set without an inverse disables the table: Solve() then factorises for every pose.
      if (!SolvePassive(gram_, std::span(unit).first(n), n_, set, &solution)) {
        inverses_.clear();
        return;
      }
      double* const inverse = inverses_.data() + bits * n * n;
      for (std::size_t row = 0; row < n; ++row) {
        inverse[row * n + static_cast<std::size_t>(column)] = solution[row];
      }
    }
  }
}

void NnlsTable::Solve(std::span<const double> rhs, std::span<double> x) const {
  if (inverses_.empty()) return SolveNnls(gram_, rhs, x);
  SolveByTable(rhs, x);
}

void NnlsTable::SolveByTable(std::span<const double> rhs, std::span<double> x) const {
  std::fill(x.begin(), x.end(), 0.0);
  const double tolerance = Tolerance(rhs);
  PassiveSet set;
  Vector solution;
  // The same steps as SolveNnls(), with a table look-up in place of the factorisation.
  for (int round = 0; round < 3 * n_; ++round) {
    const int entering = SteepestOutside(gram_, rhs, x, set, tolerance);
    if (entering < 0) return;
    set.Add(entering);
    while (set.size > 0) {
      Multiply(inverses_.data() + set.bits * gram_.size(), rhs, &solution);
      if (StepTowards(solution, &set, x)) break;
    }
  }
}

}  // namespace furrow::wrinkle
