// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/bind_context.h"

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
    std::uint32_t first_gram = 0;          // into gram_: num_values^2, nnls alone
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
  void EvaluateEntry(int entry, std::span<const Transform> local, const JointChains& chains,
                     std::span<float> driver_values) const;

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
  // d / dot(d, d), value by value, one vector a point: its dot product with how far the points have
  // moved is the projection. Zero where the reference pose does not move them.
  [[nodiscard]] const glm::dvec3* projections(const Entry& entry) const {
    return projections_.data() + entry.first_displacement;
  }
  // Entries that solve nnls.
  [[nodiscard]] std::span<const int> nnls_entries() const { return nnls_entries_; }

 private:
  [[nodiscard]] Status BindPoints(const Driver& driver, BindContext* context, bool* usable);
  [[nodiscard]] Status BindValue(const Driver& driver, const PoseDriver::Value& value,
                                 const Entry& entry, BindContext* context);
  void BindGram(Entry* entry);
  void SolveProjection(const Entry& entry, std::span<const glm::vec3> moved,
                       std::span<Fit> fits) const;
  void SolveNonNegative(const Entry& entry, std::span<const glm::vec3> moved,
                        std::span<Fit> fits) const;
  [[nodiscard]] std::span<const glm::vec3> Displacement(const Entry& entry, int value) const;

  std::vector<Entry> entries_;
  std::vector<int> nnls_entries_;
  std::vector<Measured> points_;
  std::vector<glm::vec3> displacements_;      // d = B_k - B_0, anchor space
  std::vector<glm::dvec3> projections_;       // d / dot(d, d)
  std::vector<float> squared_displacements_;  // dot(d, d), or 0 below the epsilon
  std::vector<double> gram_;                  // of the displacements as unit vectors
};

}  // namespace furrow::wrinkle
