// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// The points of a character's surface that its shapes move, in model space in the rest pose.
struct MovedSurface {
  struct Delta {
    std::uint32_t shape = 0;
    glm::vec3 delta{0.0f};  // at weight 1
  };
  struct Point {
    glm::vec3 position{0.0f};
    std::vector<Delta> deltas;  // at most one per shape
  };
  std::vector<Point> points;
};

// A point that moves with a stream's joint, and its place on the character.
struct FaceLandmark {
  int joint = kNoJoint;       // of the stream's skeleton
  glm::vec3 point{0.0f};      // in the joint's space
  glm::vec3 on_target{0.0f};  // in the character's model space, in the rest pose
};

// Finds the weights of a character's shapes that move its face as a stream's joints move theirs.
// Created once per stream, then run once per pose.
//
// Each landmark takes the deltas B of the nearest point of the surface. With d, the landmarks'
// departure from rest in the frame of the head, the weights w minimise
//   |B w - d|^2 + sum of r_i w_i^2, 0 <= w_i <= 1,
// by coordinate descent on the normal equations, with Newton steps of the weights between their
// limits. The ridge r is needed, because the shapes of a
// face are nearly dependent (pucker and funnel). A pose always gives the same weights, whichever
// pose came before. Source: Lewis and Anjyo, Direct Manipulation Blendshapes (2010).
class JointShapes {
 public:
  // The shapes of a character. A mouthClose is at most the jawOpen. If it opens the jaw itself, it
  // is solved without that: its weight means what ARKit's mouthClose means.
  struct FaceShapes {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::size_t count = 0;
    std::uint32_t jaw_open = kNone;     // the shape that means ARKit's jawOpen
    std::uint32_t mouth_close = kNone;  // likewise
    bool close_contains_jaw = false;
  };

  static constexpr std::size_t kMaxMovedJoints = 256;
  static constexpr std::size_t kMaxLandmarks = 256;
  static constexpr std::size_t kMaxSolved = 128;  // shapes that move most are solved, others rest

  // How landmarks are carried from the stream's skeleton to the character.
  struct Scaling {
    glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};  // between the model spaces
    float scale = 1.0f;                      // from the stream's unit to the character's
    float reach = 0.02f;  // landmarks with no surface within this distance are ignored
  };

  JointShapes() = default;  // moves nothing

  // `moved`: one entry per joint of `source`: true if the joint moves the face and the character
  // has no such joint. Motion is measured in the frame of the nearest joint above that is not
  // moved. More moved joints or landmarks than the limits are ignored. Empty if `moved` is too
  // short.
  [[nodiscard]] static JointShapes Create(const Skeleton& source, const std::vector<bool>& moved,
                                          std::span<const FaceLandmark> landmarks,
                                          const Scaling& scaling, const MovedSurface& surface,
                                          const FaceShapes& shapes);

  [[nodiscard]] bool empty() const { return solved_.empty(); }
  [[nodiscard]] std::size_t num_landmarks() const { return landmarks_.size(); }
  // One line for a log: "67 points of the stream's face move 46 shapes".
  [[nodiscard]] std::string Description() const;
  // True if the joint of the stream's skeleton can move the face.
  [[nodiscard]] bool Moves(int joint) const;
  [[nodiscard]] std::size_t num_solved() const { return solved_.size(); }

  // Writes the weights of all shapes. `joints`: local pose of the stream's skeleton. Does not
  // allocate, and changes nothing on failure. Errors: kSizeMismatch, kNonFinite.
  [[nodiscard]] JobStatus Run(std::span<const Transform> joints, std::span<float> weights) const;

 private:
  struct Moved {
    int joint;
    int parent;  // index into moved_; kNoJoint: the frame
  };
  struct Landmark {
    std::size_t moved;  // index into moved_
    glm::vec3 point;    // in the joint's space
    glm::vec3 rest;     // in the frame's space
    glm::quat to_target;
  };

  void Solve(std::span<float> residual, std::span<float> solution) const;
  float Sweep(std::span<float> residual, std::span<float> solution) const;
  void SolveBetweenLimits(std::span<float> residual, std::span<float> solution) const;
  void SetWeight(std::size_t i, float weight, std::span<float> residual,
                 std::span<float> solution) const;
  [[nodiscard]] float Most(std::size_t i, std::span<const float> solution) const;
  void FindMoved(const Skeleton& source, const std::vector<bool>& moved);
  void ChooseShapes(std::span<const MovedSurface::Point* const> points, float least,
                    const FaceShapes& shapes);
  void ReadDeltas(std::span<const MovedSurface::Point* const> points, bool close_contains_jaw);
  void BuildEquations();

  std::vector<Moved> moved_;  // parents first
  std::vector<Landmark> landmarks_;
  std::vector<std::uint32_t> solved_;  // shapes, ascending
  std::vector<glm::vec3> deltas_;      // [landmark][solved]
  std::vector<float> gram_;            // [solved][solved], with the ridge
  float scale_ = 1.0f;
  int jaw_open_ = -1;     // in solved_
  int mouth_close_ = -1;  // in solved_
  std::size_t num_joints_ = 0;
  std::size_t num_shapes_ = 0;
};

}  // namespace furrow::wrinkle
