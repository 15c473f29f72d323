// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/pose_gram.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::wrinkle {
namespace {

constexpr double kRidge = 1e-6;
// Eigenvalues of the Gram matrix of unit vectors, hence squares of singular values.
constexpr double kRounding = 1e-9;
constexpr double kDependent = 5e-3;  // two poses with this eigenvalue have a cosine of 0.995
// Poses with a smaller share of the largest component are not named in a dependence.
constexpr double kLeastPart = 0.25;
// Smaller shares are rounding. They would carry a pose into a dependence of the others.
constexpr double kLeastComponent = 1e-4;

// A square matrix, row by row.
struct Matrix {
  explicit Matrix(std::size_t n) : size(n), at(n * n, 0.0) {}
  double& operator()(std::size_t row, std::size_t column) { return at[row * size + column]; }
  double operator()(std::size_t row, std::size_t column) const { return at[row * size + column]; }
  std::size_t size;
  std::vector<double> at;
};

// Rows of P vectors.
struct Rows {
  std::span<const glm::dvec3> vectors;
  std::size_t num_points;
  [[nodiscard]] std::span<const glm::dvec3> operator[](std::size_t row) const {
    return vectors.subspan(row * num_points, num_points);
  }
};

double Dot(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i], b[i]);
  return sum;
}

Matrix GramOf(const Rows& rows, std::size_t n) {
  Matrix gram(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k <= i; ++k) gram(i, k) = gram(k, i) = Dot(rows[i], rows[k]);
  }
  return gram;
}

// Jacobi's method for a symmetric matrix. The columns of `vectors` are the eigenvectors. Small and
// slow, but accurate for small eigenvalues. Source: Golub and Van Loan, Matrix Computations, 8.5.
void Diagonalise(Matrix* matrix, Matrix* vectors) {
  const std::size_t n = matrix->size;
  for (std::size_t i = 0; i < n; ++i) (*vectors)(i, i) = 1.0;
  // Converges quadratically: about six sweeps.
  for (int sweep = 0; sweep < 30; ++sweep) {
    for (std::size_t p = 0; p + 1 < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        const double off = (*matrix)(p, q);
        if (std::abs(off) < 1e-18) continue;
        const double theta = ((*matrix)(q, q) - (*matrix)(p, p)) / (2.0 * off);
        const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0);
        const double s = t * c;
        const auto rotate = [c, s](double* a, double* b) {
          const double first = c * *a - s * *b;
          *b = s * *a + c * *b;
          *a = first;
        };
        for (std::size_t k = 0; k < n; ++k) rotate(&(*matrix)(k, p), &(*matrix)(k, q));
        for (std::size_t k = 0; k < n; ++k) rotate(&(*matrix)(p, k), &(*matrix)(q, k));
        for (std::size_t k = 0; k < n; ++k) rotate(&(*vectors)(k, p), &(*vectors)(k, q));
      }
    }
  }
}

// Clears the components of an eigenvector that are only rounding.
void Clean(std::size_t column, Matrix* vectors) {
  double largest = 0.0;
  for (std::size_t k = 0; k < vectors->size; ++k) {
    largest = std::max(largest, std::abs((*vectors)(k, column)));
  }
  double square = 0.0;
  for (std::size_t k = 0; k < vectors->size; ++k) {
    double& component = (*vectors)(k, column);
    if (std::abs(component) < kLeastComponent * largest) component = 0.0;
    square += component * component;
  }
  for (std::size_t k = 0; k < vectors->size; ++k) (*vectors)(k, column) /= std::sqrt(square);
}

// Pairs of poses with nearly the same or opposite directions. Each pose is named once, with the
// earliest pose like it.
std::vector<PoseDependence> DependentPairs(const Matrix& gram) {
  std::vector<PoseDependence> pairs;
  for (std::size_t k = 0; k < gram.size; ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      if (std::abs(gram(i, k)) < 1.0 - kDependent) continue;
      pairs.push_back(
          {{static_cast<int>(i), static_cast<int>(k)}, std::clamp(gram(i, k), -1.0, 1.0)});
      break;
    }
  }
  return pairs;
}

// A null vector v of E says that sum v_k e_k is about 0, so each pose with a part in it is a mix of
// the others.
PoseDependence DependenceOf(const Matrix& vectors, std::size_t column, double eigenvalue) {
  double largest = 0.0;
  for (std::size_t k = 0; k < vectors.size; ++k) {
    largest = std::max(largest, std::abs(vectors(k, column)));
  }
  PoseDependence dependence;
  for (std::size_t k = 0; k < vectors.size; ++k) {
    if (std::abs(vectors(k, column)) < kLeastPart * largest) continue;
    dependence.poses.push_back(static_cast<int>(k));
  }
  // |sum v e|^2 is the eigenvalue: the distance of the largest part from the mix of the others.
  dependence.cosine = std::sqrt(std::max(0.0, 1.0 - eigenvalue / (largest * largest)));
  return dependence;
}

bool NamesAPairOf(const PoseDependence& wide, const std::vector<PoseDependence>& pairs) {
  const auto has = [&](int pose) { return std::ranges::count(wide.poses, pose) > 0; };
  return std::ranges::any_of(
      pairs, [&](const PoseDependence& pair) { return has(pair.poses[0]) && has(pair.poses[1]); });
}

}  // namespace

PoseGram MakePoseGram(std::span<const glm::dvec3> displacements, std::size_t num_values) {
  PoseGram result;
  result.directions.assign(displacements.begin(), displacements.end());
  const std::size_t num_points = displacements.size() / num_values;
  const Rows rows{result.directions, num_points};
  std::size_t num_moving = 0;
  for (std::size_t k = 0; k < num_values; ++k) {
    const double length = std::sqrt(Dot(rows[k], rows[k]));
    if (length == 0.0) continue;
    ++num_moving;
    for (std::size_t i = 0; i < num_points; ++i) result.directions[k * num_points + i] /= length;
  }

  const Matrix gram = GramOf(rows, num_values);
  Matrix values = gram;
  Matrix vectors(num_values);
  Diagonalise(&values, &vectors);
  result.dependences = DependentPairs(gram);
  const std::vector<PoseDependence> pairs = result.dependences;
  const std::vector<glm::dvec3> units = result.directions;
  for (std::size_t column = 0; column < num_values; ++column) {
    const double eigenvalue = std::max(values(column, column), 0.0);
    if (eigenvalue > kDependent) continue;
    PoseDependence dependence = DependenceOf(vectors, column, eigenvalue);
    // A pose that moves nothing has an eigenvalue of 0 of its own.
    if (dependence.poses.size() < 2) continue;
    if (!NamesAPairOf(dependence, pairs)) result.dependences.push_back(std::move(dependence));
    if (eigenvalue > kRounding) continue;
    Clean(column, &vectors);
    // E (1 - v v'): the directions without their part along the sum that is only rounding.
    for (std::size_t i = 0; i < num_points; ++i) {
      glm::dvec3 sum(0.0);
      for (std::size_t k = 0; k < num_values; ++k) {
        sum += vectors(k, column) * units[k * num_points + i];
      }
      for (std::size_t k = 0; k < num_values; ++k) {
        result.directions[k * num_points + i] -= vectors(k, column) * sum;
      }
    }
  }

  Matrix ridged = GramOf(rows, num_values);
  double trace = 0.0;
  for (std::size_t k = 0; k < num_values; ++k) trace += ridged(k, k);
  // A rig may have a driver without any movement. The matrix must be positive definite there, too.
  const double ridge = num_moving > 0 ? kRidge * trace / static_cast<double>(num_moving) : kRidge;
  for (std::size_t k = 0; k < num_values; ++k) ridged(k, k) += ridge;
  result.gram = std::move(ridged.at);
  return result;
}

}  // namespace furrow::wrinkle
