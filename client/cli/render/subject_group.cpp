// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/subject_group.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "base/status.h"
#include "render/scene/camera_frame.h"

namespace furrow::cli {
namespace {

constexpr float kStep = 0.55f;  // rise of a row / spacing: heads appear above shoulders in front
constexpr float kDepth = 0.7f;  // distance of a row behind the previous one / spacing

constexpr float kMinSpacing = 0.45f;  // metres between neighbours in a close-up
constexpr float kMaxSpacing = 0.9f;   // metres between neighbours with whole bodies in view

// Height in metres that a camera shows at its target.
float ShownBy(const render::Camera& camera) {
  return 2.0f * glm::distance(camera.position, camera.target) *
         std::tan(glm::radians(0.5f * camera.fov_y_degrees));
}

// The horizontal unit vector from the target towards the camera.
glm::vec3 Backwards(const render::Camera& camera) {
  const glm::vec3 level = (camera.position - camera.target) * glm::vec3(1.0f, 0.0f, 1.0f);
  return glm::length(level) > 1e-4f ? glm::normalize(level) : glm::vec3(0.0f, 0.0f, 1.0f);
}

// The horizontal unit vector to the right in the picture.
glm::vec3 RightOf(const glm::vec3& back) { return {back.z, 0.0f, -back.x}; }

int RowsOf(int subjects, int columns) { return (subjects + columns - 1) / columns; }

// The number of columns that makes the subjects largest in the picture.
int ColumnsOf(int subjects, float spacing, float around, float aspect) {
  const auto size = [&](int columns) {
    const float width = (static_cast<float>(columns) - 0.5f) * spacing + around;
    const float height =
        static_cast<float>(RowsOf(subjects, columns) - 1) * kStep * spacing + around;
    return std::max(height, width / aspect);
  };
  int best = 1;
  for (int columns = 2; columns <= subjects; ++columns) {
    if (size(columns) < size(best)) best = columns;
  }
  return best;
}

}  // namespace

std::vector<glm::vec3> ArrangeGroup(int subjects, float spacing, float around, float aspect) {
  const int columns = ColumnsOf(subjects, spacing, around, aspect);
  std::vector<glm::vec3> spots;
  float left = -0.5f * static_cast<float>(columns - 1);  // of the row, in spacings
  for (int row = 0; row < RowsOf(subjects, columns); ++row) {
    const int in_row = std::min(columns, subjects - row * columns);
    const float before = left;
    left = -0.5f * static_cast<float>(in_row - 1);
    // Shift by half a place, so that the row fills the gaps of the previous row.
    const float shift = left - before - std::floor(left - before);
    if (row > 0 && std::abs(shift - 0.5f) > 0.25f) left += row % 2 == 1 ? 0.5f : -0.5f;
    for (int i = 0; i < in_row; ++i) {
      spots.push_back(spacing * glm::vec3(left + static_cast<float>(i),
                                          kStep * static_cast<float>(row),
                                          -kDepth * static_cast<float>(row)));
    }
  }
  return spots;
}

render::Camera FrameGroup(const render::Camera& camera, const std::vector<glm::vec3>& spots,
                          float aspect) {
  const float half = 0.5f * ShownBy(camera);
  const float tangent = std::tan(glm::radians(0.5f * camera.fov_y_degrees));
  const glm::vec2 slopes(aspect * tangent, tangent);
  // A camera at distance D from the plane z = 0 sees, at depth z, an extent of (D - z) * slope to
  // each side of its axis. Solve for the D that fits all positions.
  glm::vec2 high(std::numeric_limits<float>::lowest());
  glm::vec2 low(std::numeric_limits<float>::max());
  for (const glm::vec3& spot : spots) {
    high = glm::max(high, glm::vec2(spot) + half + spot.z * slopes);
    low = glm::min(low, glm::vec2(spot) - half - spot.z * slopes);
  }
  const glm::vec2 distances = 0.5f * (high - low) / slopes;
  const glm::vec2 middle = 0.5f * (high + low);
  const glm::vec3 back = Backwards(camera);
  render::Camera all = camera;
  all.follow_joint = -1;
  all.turn_joint = -1;
  all.fit_shorter_side = false;
  all.target = camera.target + middle.x * RightOf(back) + glm::vec3(0.0f, middle.y, 0.0f);
  all.position = all.target + std::max(distances.x, distances.y) * back;
  return all;
}

Result<std::unique_ptr<SubjectGroup>> SubjectGroup::Create(
    const character::Character& character,
    const std::vector<std::shared_ptr<const motion::Clip>>& clips,
    const std::vector<std::string>& files, const rig::SkeletonMatcher& matcher,
    const rig::ShapeMatcher& shapes, const GroupOptions& options) {
  auto self = std::make_unique<SubjectGroup>();
  self->character_ = &character;
  self->spacing_ = options.spacing;
  const int num_clips = static_cast<int>(clips.size());
  const int subjects = options.subjects > 0 ? options.subjects : num_clips;
  for (int i = 0; i < subjects; ++i) {
    const auto clip = static_cast<std::size_t>(i % num_clips);
    auto subject = AnimatedSubject::Create(character, clips[clip], matcher, shapes, files[clip],
                                           /*reports=*/i < num_clips);
    FURROW_RETURN_IF_ERROR(subject);
    const int frames = std::max(1, (*subject)->num_frames());
    const int sharing = (subjects - static_cast<int>(clip) + num_clips - 1) / num_clips;
    const int ahead =
        options.offset_frames >= 0 ? i * options.offset_frames : i / num_clips * frames / sharing;
    self->members_.push_back({std::move(*subject), ahead % frames, files[clip]});
  }
  return self;
}

int SubjectGroup::num_frames() const {
  int most = 0;
  for (const Member& member : members_) most = std::max(most, member.subject->num_frames());
  return most;
}

void SubjectGroup::FrameBy(const render::Camera& camera, float aspect) {
  one_ = all_ = camera;
  spots_.assign(1, glm::vec3(0.0f));
  if (members_.size() == 1) return;
  const float around = ShownBy(camera);
  const float spacing = spacing_ > 0.0f ? spacing_ : std::clamp(around, kMinSpacing, kMaxSpacing);
  spots_ = ArrangeGroup(static_cast<int>(members_.size()), spacing, around, aspect);
  all_ = FrameGroup(camera, spots_, aspect);
}

Status SubjectGroup::Advance(int frame) {
  for (Member& member : members_) {
    const int of_take = (frame + member.ahead) % std::max(1, member.subject->num_frames());
    if (Status status = member.subject->Advance(of_take); !status.ok()) {
      return status.At(member.file);
    }
  }
  return {};
}

// Undoes the motion that the camera would follow, then moves the subject to its position.
glm::mat4 SubjectGroup::PlacementOf(std::size_t member, const render::PosedSubject& subject) const {
  if (members_.size() == 1) return glm::mat4(1.0f);
  const glm::vec3 back = Backwards(one_);
  const glm::vec3 right = RightOf(back);
  const glm::vec3& spot = spots_[member];
  const glm::mat4 follow = render::FollowTransform(one_, character_->skeleton, subject.model);
  return glm::translate(glm::mat4(1.0f),
                        spot.x * right + glm::vec3(0.0f, spot.y, 0.0f) + spot.z * back) *
         glm::inverse(follow);
}

render::FrameRequest SubjectGroup::Request() {
  render::FrameRequest request;
  others_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    render::PosedSubject subject = members_[i].subject->subject();
    subject.placement = PlacementOf(i, subject);
    if (i == 0) {
      static_cast<render::PosedSubject&>(request) = subject;
    } else {
      others_.push_back(subject);
    }
  }
  request.others = others_;
  request.camera = all_;
  return request;
}

}  // namespace furrow::cli
