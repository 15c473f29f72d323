// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/cli/render/performance.h"

namespace furrow::cli {

struct CrowdOptions {
  int subjects = 0;        // 0: one a recording
  float spacing = 0.0f;    // metres from one to the next; 0: by what the camera shows
  int offset_frames = -1;  // each ahead of the one before; -1: evenly over the recording they share
};

// Where people stand who are pictured together: in rows, as on steps for a group photograph, those
// behind in the gaps of those before. Metres, model space, as a camera from the front sees them:
// x to the right, y up, z towards it. The first row's middle is the origin.
//
// `around`: metres that are to be seen of each. `aspect`: width / height of the picture; as many
// stand in a row as let all be the largest in it.
[[nodiscard]] std::vector<glm::vec3> GroupPhotograph(int people, float spacing, float around,
                                                     float aspect);

// `camera`, level, moved aside and back until it shows as much around every spot as it showed of
// its one subject. It stands still.
[[nodiscard]] render::Camera OverAll(const render::Camera& camera,
                                     const std::vector<glm::vec3>& spots, float aspect);

// One or more performances on one character, pictured together. A single one is pictured as ever:
// the camera follows it. Several stand on the spot, each as the camera would have followed it.
class Crowd {
 public:
  // `character` outlives it. Clips are handed out to the people in turn; a clip that is shorter
  // than the longest begins again.
  // Errors: of Performance::Create.
  [[nodiscard]] static Result<std::unique_ptr<Crowd>> Create(
      const character::Character& character,
      const std::vector<std::shared_ptr<const motion::Clip>>& clips,
      const std::vector<std::string>& files, const character::SkeletonMatcher& matcher,
      const CrowdOptions& options);

  // Of the longest performance.
  [[nodiscard]] int num_frames() const;
  // Stands everybody in front of a camera of one person.
  void FrameBy(const render::Camera& camera, float aspect);
  // As Performance::Advance(), from 0 on.
  [[nodiscard]] Status Advance(int frame);
  // Subjects and camera of the last frame solved. Spans point into this object.
  [[nodiscard]] render::FrameRequest Request();

 private:
  struct Person {
    std::unique_ptr<Performance> performance;
    int ahead = 0;  // frames
    std::string file;
  };
  [[nodiscard]] glm::mat4 PlacementOf(std::size_t person,
                                      const render::PosedSubject& subject) const;

  const character::Character* character_ = nullptr;
  float spacing_ = 0.0f;
  std::vector<Person> people_;
  std::vector<glm::vec3> spots_;
  render::Camera one_;  // as it pictures one
  render::Camera all_;
  std::vector<render::PosedSubject> others_;
};

}  // namespace furrow::cli
