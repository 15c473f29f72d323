// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/cli/render/animated_subject.h"

namespace furrow::cli {

// The options of a picture with several subjects.
struct GroupOptions {
  int subjects = 0;        // 0: one per recording
  float spacing = 0.0f;    // metres between neighbours; 0: chosen from the camera's field of view
  int offset_frames = -1;  // lead of each subject over the previous one; -1: spread evenly
};

// Returns the positions of subjects in a group picture: rows on rising steps, each row in the gaps
// of the row in front. Metres, as a camera in front sees them: x to the right, y up, z towards the
// camera. The middle of the first row is the origin.
//
// `spacing`: metres between neighbours. `around`: how many metres around each subject are visible,
// in width and in height. `aspect`: width / height of the picture. The number of subjects per row
// is the one that makes the subjects as large as possible in the picture.
[[nodiscard]] std::vector<glm::vec3> ArrangeGroup(int subjects, float spacing, float around,
                                                  float aspect);

// Returns a camera for a group: `camera` turned horizontal, and moved sideways and back until it
// shows as much around every position in `spots` as `camera` shows of its single subject. The
// result does not follow a joint.
[[nodiscard]] render::Camera FrameGroup(const render::Camera& camera,
                                        const std::vector<glm::vec3>& spots, float aspect);

// One or more animated subjects in one picture, all with one character. The camera follows a single
// subject. With several subjects, the camera stands still, and every subject stays at its position
// in the group.
class SubjectGroup {
 public:
  // `character` must outlive this object. Subjects take the clips in turn; a clip that is shorter
  // than the longest repeats. Errors: those of AnimatedSubject::Create().
  [[nodiscard]] static Result<std::unique_ptr<SubjectGroup>> Create(
      const character::Character& character,
      const std::vector<std::shared_ptr<const motion::Clip>>& clips,
      const std::vector<std::string>& files, const rig::SkeletonMatcher& matcher,
      const rig::ShapeMatcher& shapes, const GroupOptions& options);

  // Number of frames of the longest clip.
  [[nodiscard]] int num_frames() const;
  // Arranges the subjects for a camera that frames a single subject.
  void FrameBy(const render::Camera& camera, float aspect);
  // Solves frame `frame` of all subjects. Call it for consecutive frames, starting with 0. Errors:
  // kInternal.
  [[nodiscard]] Status Advance(int frame);
  // The subjects and the camera of the last solved frame. Spans point into this object.
  [[nodiscard]] render::FrameRequest Request();

 private:
  struct Member {
    std::unique_ptr<AnimatedSubject> subject;
    int ahead = 0;  // frames
    std::string file;
  };
  [[nodiscard]] glm::mat4 PlacementOf(std::size_t member,
                                      const render::PosedSubject& subject) const;

  const character::Character* character_ = nullptr;
  float spacing_ = 0.0f;
  std::vector<Member> members_;
  std::vector<glm::vec3> spots_;
  render::Camera one_;  // for a single subject
  render::Camera all_;
  std::vector<render::PosedSubject> others_;
};

}  // namespace furrow::cli
