// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/face/face_landmarks.h"

#include <string>
#include <string_view>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

// Metres; an adult's.
constexpr float kUsualPupilDistance = 0.062f;

// Looks up joints and remembers the first missing name, so that one check at the end covers all of
// them.
class JointPoints {
 public:
  explicit JointPoints(const wrinkle::Skeleton& skeleton) : skeleton_(skeleton) {}

  glm::vec3 Head(std::string_view name, std::string_view side = {}) {
    return Point(name, side, false);
  }
  glm::vec3 Tail(std::string_view name, std::string_view side = {}) {
    return Point(name, side, true);
  }
  [[nodiscard]] const std::string& missing() const { return missing_; }

 private:
  glm::vec3 Point(std::string_view name, std::string_view side, bool tail) {
    const std::string full = std::string(name) + std::string(side);
    const int joint = skeleton_.Find(full);
    if (joint == wrinkle::kNoJoint) {
      if (missing_.empty()) missing_ = full;
      return glm::vec3(0.0f);
    }
    const auto index = static_cast<std::size_t>(joint);
    const glm::vec3 local = tail ? skeleton_.tails()[index] : glm::vec3(0.0f);
    return glm::vec3(skeleton_.rest_model()[index] * glm::vec4(local, 1.0f));
  }

  const wrinkle::Skeleton& skeleton_;
  std::string missing_;
};

FaceLandmarks::Side FindSide(JointPoints* points, std::string_view side) {
  FaceLandmarks::Side s;
  s.brow_inner = points->Tail("oculi01", side);
  s.brow_middle = points->Head("oculi01", side);
  s.brow_outer = points->Head("oculi02", side);
  s.temple = points->Head("temporalis01", side);
  s.eye = points->Head("eye", side);
  s.pupil = points->Tail("eye", side);
  s.lower_lid = points->Tail("orbicularis04", side);
  s.fold_top = points->Head("levator03", side);
  s.fold_middle = points->Head("levator04", side);
  s.fold_bottom = points->Head("levator05", side);
  s.mouth_corner = points->Tail("levator05", side);
  s.chin_side = points->Tail("oris06", side);
  s.cheek = points->Tail("risorius02", side);
  return s;
}

}  // namespace

Result<FaceLandmarks> FindFaceLandmarks(const wrinkle::Skeleton& skeleton) {
  JointPoints points(skeleton);
  FaceLandmarks face;
  face.sides[0] = FindSide(&points, ".L");
  face.sides[1] = FindSide(&points, ".R");
  face.nose_bridge = points.Head("levator02", ".L");
  face.nose_bridge.x = 0.5f * (face.nose_bridge.x + points.Head("levator02", ".R").x);
  face.nose_tip = points.Tail("special03");
  face.upper_lip = points.Tail("oris05");
  face.lower_lip = points.Tail("oris01");
  face.lower_lip_bottom = points.Head("oris01");
  face.chin = points.Tail("special04");
  face.head = points.Head("head");
  face.crown = points.Tail("head");
  if (!points.missing().empty())
    return Status(StatusCode::kNotFound, "the skeleton has no joint '" + points.missing() + "'", {},
                  "use MakeHuman's default rig, which has the joints of the face");
  const float pupils = glm::distance(face.sides[0].eye, face.sides[1].eye);
  if (!(pupils > 1e-4f))
    return Status(StatusCode::kInvalidArgument, "both eyes are at the same position",
                  "eye.L, eye.R");
  face.scale = pupils / kUsualPupilDistance;
  return face;
}

}  // namespace furrow::authoring
