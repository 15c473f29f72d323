// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/drivers/bind_context.h"
#include "wrinkle/drivers/pose/nnls.h"

namespace furrow::wrinkle {

inline constexpr int kMaxControlPoints = 256;  // of one driver
inline constexpr int kMaxPoseValues = 64;      // of one driver; kMaxNnlsValues where it solves nnls

// All pose drivers of a binding: entries that index flat pools. Private to wrinkle/.
class PoseDriverSet {
 public:
  // How one value came about.
  struct Fit {
    float along = 0.0f;                  // projection, or nnls weight, not clamped
    float squared_perpendicular = 0.0f;  // what the fit leaves over
  };

  struct Entry {
    int first_value = 0;
    int num_values = 0;
    std::uint32_t first_point = 0;  // into points_
    std::uint32_t num_points = 0;
    std::uint32_t first_displacement = 0;  // into displacements_: num_values x num_points
    std::uint32_t first_square = 0;        // into squared_displacements_: num_values
    std::uint32_t nnls = 0;                // into nnls_, where it solves that
    PoseSolve solve = PoseSolve::kProjection;
    float falloff = 0.0f;
  };

  struct Measured {
    int point = 0;         // into the binding's JointChains
    glm::vec3 rest{0.0f};  // B_0, anchor space
  };

  // Adds `driver`, whose values begin at `first_value` of the binding's.
  [[nodiscard]] Status Bind(const Driver& driver, int first_value, BindContext* context);
  // Entries whose values lie beyond the end of `driver_values` are left out.
  void Evaluate(std::span<const Transform> local, const JointChains& chains,
                std::span<float> driver_values) const;
  // One entry's values, from its control points' departure from rest (Measure()).
  void EvaluateMoved(int entry, std::span<const glm::vec3> moved, std::span<float> values) const;

  // For `furrow rig explain`: entry by entry, the same numbers that Evaluate() goes through.
  [[nodiscard]] int num_entries() const { return static_cast<int>(entries_.size()); }
  [[nodiscard]] int first_value(int entry) const { return entries_[entry].first_value; }
  [[nodiscard]] int num_values(int entry) const { return entries_[entry].num_values; }
  [[nodiscard]] float falloff(int entry) const { return entries_[entry].falloff; }
  // |d|^2 of a value, 0 where its reference pose does not move the points.
  [[nodiscard]] float SquaredDisplacement(int entry, int value) const;
  // `moved` receives each control point's departure from rest, anchor space. Returns how many.
  int Measure(int entry, std::span<const Transform> local, const JointChains& chains,
              std::span<glm::vec3> moved) const;
  void Solve(int entry, std::span<const glm::vec3> moved, std::span<Fit> fits) const;
  [[nodiscard]] float Value(int entry, int value, const Fit& fit) const;
  [[nodiscard]] std::span<const glm::vec3> Displacement(int entry, int value) const;

  // For the batch.
  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] std::span<const Measured> points(const Entry& entry) const {
    return std::span(points_).subspan(entry.first_point, entry.num_points);
  }
  // Projection() of a value's displacement, one vector a point.
  [[nodiscard]] std::span<const glm::vec3> projections(const Entry& entry, int value) const {
    return std::span(projections_)
        .subspan(entry.first_displacement + entry.num_points * static_cast<std::uint32_t>(value),
                 entry.num_points);
  }
  // Entries that solve nnls.
  [[nodiscard]] std::span<const int> nnls_entries() const { return nnls_entries_; }

 private:
  [[nodiscard]] Status BindPoints(const Driver& driver, BindContext* context, bool* usable);
  [[nodiscard]] Status BindValue(const Driver& driver, const PoseDriver::Value& value,
                                 const Entry& entry, BindContext* context);
  void BindGram(Entry* entry);
  // `along` of each fit.
  void SolveAlong(const Entry& entry, std::span<const glm::vec3> moved, std::span<Fit> fits) const;
  void SolveNonNegative(const Entry& entry, std::span<const glm::vec3> moved,
                        std::span<Fit> fits) const;
  // What they leave over, which only a falloff asks for.
  void SolvePerpendicular(const Entry& entry, std::span<const glm::vec3> moved,
                          std::span<Fit> fits) const;
  [[nodiscard]] std::span<const glm::vec3> Displacement(const Entry& entry, int value) const;

  std::vector<Entry> entries_;
  std::vector<int> nnls_entries_;
  std::vector<Measured> points_;
  std::vector<glm::vec3> displacements_;      // d = B_k - B_0, anchor space
  std::vector<glm::vec3> projections_;        // d / dot(d, d)
  std::vector<float> squared_displacements_;  // dot(d, d), or 0 below the epsilon
  std::vector<double> inverse_lengths_;       // 1 / |d|, or 0
  std::vector<NnlsTable> nnls_;               // of the displacements as unit vectors
};

}  // namespace furrow::wrinkle
