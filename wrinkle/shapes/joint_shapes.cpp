// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/joint_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {
namespace {

// Of each shape's own motion, and of the mean over the shapes: the second keeps shapes that hardly
// move a landmark from explaining noise.
constexpr float kOwnRidge = 0.01f;
constexpr float kMeanRidge = 0.001f;
constexpr int kMaxRounds = 12;
constexpr int kSweepsPerRound = 6;
constexpr float kSettled = 1e-5f;  // change of a weight in one sweep

const MovedSurface::Point* NearestPoint(const MovedSurface& surface, const glm::vec3& place,
                                        float reach) {
  const MovedSurface::Point* nearest = nullptr;
  float least = reach * reach;
  for (const MovedSurface::Point& point : surface.points) {
    const glm::vec3 apart = point.position - place;
    const float squared = glm::dot(apart, apart);
    if (squared > least) continue;
    least = squared;
    nearest = &point;
  }
  return nearest;
}

}  // namespace

JointShapes JointShapes::Create(const Skeleton& source, const std::vector<bool>& moved,
                                std::span<const FaceLandmark> landmarks, const Scaling& scaling,
                                const MovedSurface& surface, const FaceShapes& shapes) {
  JointShapes result;
  result.num_joints_ = static_cast<std::size_t>(source.num_joints());
  result.num_shapes_ = shapes.count;
  result.scale_ = scaling.scale;
  if (moved.size() < result.num_joints_) return {};
  result.FindMoved(source, moved);
  std::vector<const MovedSurface::Point*> points;
  for (const FaceLandmark& landmark : landmarks) {
    const auto found = std::ranges::find(result.moved_, landmark.joint, &Moved::joint);
    const auto* point = NearestPoint(surface, landmark.on_target, scaling.reach);
    if (found == result.moved_.end() || point == nullptr || points.size() == kMaxLandmarks) {
      continue;
    }
    int frame = landmark.joint;
    glm::vec3 rest = landmark.point;
    while (frame != kNoJoint && moved[static_cast<std::size_t>(frame)]) {
      rest = glm::vec3(ToMatrix(source.rest_pose()[frame]) * glm::vec4(rest, 1.0f));
      frame = source.joint_parents()[frame];
    }
    result.landmarks_.push_back({static_cast<std::size_t>(found - result.moved_.begin()),
                                 landmark.point, rest, scaling.turn * RestRotation(source, frame)});
    points.push_back(point);
  }
  result.ChooseShapes(points, 0.05f * scaling.reach, shapes);
  result.ReadDeltas(points, shapes.close_contains_jaw);
  result.BuildEquations();
  return result;
}

std::string JointShapes::Description() const {
  return std::to_string(num_landmarks()) + " points of the stream's face move " +
         std::to_string(num_solved()) + " shapes";
}

bool JointShapes::Moves(int joint) const {
  return !empty() && std::ranges::find(moved_, joint, &Moved::joint) != moved_.end();
}

void JointShapes::FindMoved(const Skeleton& source, const std::vector<bool>& moved) {
  for (int joint = 0; joint < source.num_joints(); ++joint) {
    if (!moved[static_cast<std::size_t>(joint)] || moved_.size() == kMaxMovedJoints) continue;
    const auto above = std::ranges::find(moved_, source.joint_parents()[joint], &Moved::joint);
    moved_.push_back(
        {joint, above == moved_.end() ? kNoJoint : static_cast<int>(above - moved_.begin())});
  }
}

void JointShapes::ChooseShapes(std::span<const MovedSurface::Point* const> points, float least,
                               const FaceShapes& shapes) {
  std::vector<float> most(shapes.count, 0.0f);
  for (const MovedSurface::Point* point : points) {
    for (const auto& [shape, delta] : point->deltas) {
      if (shape < shapes.count) most[shape] = std::max(most[shape], glm::length(delta));
    }
  }
  for (std::uint32_t shape = 0; shape < shapes.count; ++shape) {
    if (most[shape] > least) solved_.push_back(shape);
  }
  std::ranges::stable_sort(solved_, std::greater(), [&](std::uint32_t i) { return most[i]; });
  if (solved_.size() > kMaxSolved) solved_.resize(kMaxSolved);
  std::ranges::sort(solved_);
  for (std::size_t i = 0; i < solved_.size(); ++i) {
    if (solved_[i] == shapes.jaw_open) jaw_open_ = static_cast<int>(i);
    if (solved_[i] == shapes.mouth_close) mouth_close_ = static_cast<int>(i);
  }
}

void JointShapes::ReadDeltas(std::span<const MovedSurface::Point* const> points,
                             bool close_contains_jaw) {
  const std::size_t n = solved_.size();
  deltas_.assign(points.size() * n, glm::vec3(0.0f));
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (const auto& [shape, delta] : points[row]->deltas) {
      const auto place = std::ranges::lower_bound(solved_, shape);
      if (place == solved_.end() || *place != shape) continue;
      deltas_[row * n + static_cast<std::size_t>(place - solved_.begin())] = delta;
    }
  }
  if (!close_contains_jaw || jaw_open_ < 0 || mouth_close_ < 0) return;
  for (std::size_t row = 0; row < points.size(); ++row) {
    deltas_[row * n + static_cast<std::size_t>(mouth_close_)] -=
        deltas_[row * n + static_cast<std::size_t>(jaw_open_)];
  }
}

void JointShapes::BuildEquations() {
  const std::size_t n = solved_.size();
  const std::size_t rows = landmarks_.size();
  gram_.assign(n * n, 0.0f);
  float trace = 0.0f;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t row = 0; row < rows; ++row) {
        gram_[i * n + j] += glm::dot(deltas_[row * n + i], deltas_[row * n + j]);
      }
    }
    trace += gram_[i * n + i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    gram_[i * n + i] += kOwnRidge * gram_[i * n + i] + kMeanRidge * trace / static_cast<float>(n);
  }
}

JobStatus JointShapes::Run(std::span<const Transform> joints, std::span<float> weights) const {
  if (joints.size() < num_joints_ || weights.size() < num_shapes_) return JobStatus::kSizeMismatch;
  std::array<glm::mat4, kMaxMovedJoints> frames;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const glm::mat4 local = ToMatrix(joints[static_cast<std::size_t>(moved_[i].joint)]);
    const int parent = moved_[i].parent;
    frames[i] = parent == kNoJoint ? local : frames[static_cast<std::size_t>(parent)] * local;
  }
  const std::size_t n = solved_.size();
  std::array<float, kMaxSolved> rhs{};
  for (std::size_t row = 0; row < landmarks_.size(); ++row) {
    const Landmark& landmark = landmarks_[row];
    const glm::vec3 now(frames[landmark.moved] * glm::vec4(landmark.point, 1.0f));
    const glm::vec3 apart = landmark.to_target * (scale_ * (now - landmark.rest));
    for (std::size_t i = 0; i < n; ++i) rhs[i] += glm::dot(deltas_[row * n + i], apart);
  }
  if (!AllFinite(std::span<const float>(rhs))) return JobStatus::kNonFinite;
  std::array<float, kMaxSolved> solution{};
  Solve(rhs, solution);
  std::ranges::fill(weights.first(num_shapes_), 0.0f);
  for (std::size_t i = 0; i < n; ++i) weights[solved_[i]] = solution[i];
  return JobStatus::kOk;
}

// `residual` is what the weights do not explain yet: B'd - (B'B + r) w. Sweeps over the weights,
// one by one, find which of them lie between their limits. Shapes are nearly dependent, so sweeps
// alone would take hundreds to settle those; they are solved together instead.
void JointShapes::Solve(std::span<float> residual, std::span<float> solution) const {
  for (int round = 0; round < kMaxRounds; ++round) {
    for (int sweep = 0; sweep < kSweepsPerRound; ++sweep) {
      if (Sweep(residual, solution) < kSettled) return;
    }
    SolveBetweenLimits(residual, solution);
  }
}

float JointShapes::Most(std::size_t i, std::span<const float> solution) const {
  return static_cast<int>(i) == mouth_close_ && jaw_open_ >= 0
             ? solution[static_cast<std::size_t>(jaw_open_)]
             : 1.0f;
}

void JointShapes::SetWeight(std::size_t i, float weight, std::span<float> residual,
                            std::span<float> solution) const {
  const float step = weight - solution[i];
  if (step == 0.0f) return;
  solution[i] = weight;
  const std::size_t n = solved_.size();
  const float* row = &gram_[i * n];
  for (std::size_t j = 0; j < n; ++j) residual[j] -= step * row[j];
}

// Returns the largest change of a weight.
float JointShapes::Sweep(std::span<float> residual, std::span<float> solution) const {
  float change = 0.0f;
  for (std::size_t i = 0; i < solved_.size(); ++i) {
    const float former = solution[i];
    const float best = former + residual[i] / gram_[i * solved_.size() + i];
    SetWeight(i, std::clamp(best, 0.0f, Most(i, solution)), residual, solution);
    change = std::max(change, std::abs(solution[i] - former));
  }
  return change;
}

// By a Cholesky factor of the equations of those weights.
void JointShapes::SolveBetweenLimits(std::span<float> residual, std::span<float> solution) const {
  std::array<std::size_t, kMaxSolved> free;
  std::size_t count = 0;
  for (std::size_t i = 0; i < solved_.size(); ++i) {
    if (solution[i] > 0.0f && solution[i] < Most(i, solution)) free[count++] = i;
  }
  std::array<float, kMaxSolved * kMaxSolved> factor;
  std::array<float, kMaxSolved> step;
  for (std::size_t i = 0; i < count; ++i) {
    float* const row = &factor[i * kMaxSolved];
    step[i] = residual[free[i]];
    for (std::size_t j = 0; j <= i; ++j) {
      const float* const other = &factor[j * kMaxSolved];
      float sum = gram_[free[i] * solved_.size() + free[j]];
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (j < i) {
        row[j] = sum / other[j];
        step[i] -= row[j] * step[j];
      } else if (sum > 0.0f) {
        row[i] = std::sqrt(sum);
        step[i] /= row[i];
      } else {
        return;  // dependent to the last digit: the sweeps go on alone
      }
    }
  }
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = i + 1; k < count; ++k) step[i] -= factor[k * kMaxSolved + i] * step[k];
    step[i] /= factor[i * kMaxSolved + i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float best = solution[free[i]] + step[i];
    SetWeight(free[i], std::clamp(best, 0.0f, Most(free[i], solution)), residual, solution);
  }
}

}  // namespace furrow::wrinkle
