// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x3.hpp>

#include "wrinkle/drivers/bind_context.h"
#include "wrinkle/drivers/strain/strain.h"

namespace furrow::wrinkle {

// All strain drivers of a binding. Private to wrinkle/; the formulas are in strain.h.
//
// A patch is skinned with what each joint does relative to the driver's base joint: four points of
// it that lie at the patch in the rest pose say where the joint takes any point of the patch. So a
// motion of the whole character changes nothing, and the differences that strain is made of are
// not lost in the distance to the joints.
class StrainDriverSet {
 public:
  struct Measured {
    PrincipalStretches stretches;
    CompressionShares shares;  // not yet divided by the full compression
  };

  [[nodiscard]] Status Bind(const Driver& driver, int first_value, BindContext* context);
  void Evaluate(std::span<const Transform> local, const JointChains& chains,
                std::span<float> driver_values) const;

  // For the batch: the same in two steps, with points that were evaluated elsewhere.
  static constexpr int kNumValues = 4;
  static constexpr std::size_t kFramePoints = 4;
  // Of the binding's JointChains, kFramePoints for each joint that moves the patch.
  [[nodiscard]] std::span<const int> points(int entry) const {
    const Entry& e = entries_[entry];
    return std::span(points_).subspan(e.first_point, e.num_joints * kFramePoints);
  }
  // Where a joint takes any point of the patch.
  using Frame = glm::mat4x3;
  [[nodiscard]] static Frame MakeFrame(std::span<const glm::vec3, kFramePoints> points);
  // `frames`: a joint each. `values`: kNumValues.
  void EvaluateFrames(int entry, std::span<const Frame> frames, std::span<float> values) const;

  // For `furrow rig explain`: the same numbers that Evaluate() goes through.
  [[nodiscard]] int num_entries() const { return static_cast<int>(entries_.size()); }
  [[nodiscard]] int first_value(int entry) const { return entries_[entry].first_value; }
  [[nodiscard]] Measured Measure(int entry, std::span<const Transform> local,
                                 const JointChains& chains) const;

 private:
  struct Entry {
    int first_value = 0;
    float inverse_full = 4.0f;
    std::uint32_t first_point = 0;  // into points_: four a joint
    std::uint32_t num_joints = 0;
    std::uint32_t first_vertex = 0;
    std::uint32_t num_vertices = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t num_triangles = 0;
    float inverse_area = 0.0f;  // of all triangles
  };
  struct Influence {
    std::uint8_t joint = 0;  // of the entry's
    float skin_weight = 0.0f;
  };
  struct Vertex {
    glm::vec3 place{0.0f};  // in frames whose origin is the patch's centre, whose unit its radius
    Influence influences[StrainDriver::kMaxInfluences];  // unused ones weigh nothing
  };
  struct Triangle {
    std::uint16_t corners[3] = {};  // of the entry's vertices
    RestTriangle rest;
  };

  [[nodiscard]] Status BindJoints(const Driver& driver, BindContext* context,
                                  std::vector<int>* joints, int* base);
  void BindVertices(const StrainDriver& strain, Entry* entry);
  void BindTriangles(const StrainDriver& strain, const Skeleton& skeleton, int base,
                     const JointChains& chains, Entry* entry);
  // As many as the entry has joints.
  void EvaluatePoints(const Entry& entry, std::span<const Transform> local,
                      const JointChains& chains, std::span<Frame> frames) const;
  // The patch's vertices in the base joint's space.
  void Skin(const Entry& entry, std::span<const Frame> frames,
            std::span<glm::vec3> positions) const;
  [[nodiscard]] Measured MeasureFrames(const Entry& entry, std::span<const Frame> frames) const;

  std::vector<Entry> entries_;
  std::vector<int> points_;  // into the binding's JointChains
  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
};

}  // namespace furrow::wrinkle
