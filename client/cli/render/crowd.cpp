// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/crowd.h"

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

constexpr float kStep = 0.55f;  // height of a step as a share of the spacing: heads clear shoulders
constexpr float kDepth = 0.7f;  // ... and how far it lies behind the one before

constexpr float kShoulders = 0.45f;  // metres that people are apart who are seen from near ...
constexpr float kArms = 0.9f;        // ... and as a whole

// Metres that a camera shows of its one subject, at its target.
float ShownBy(const render::Camera& camera) {
  return 2.0f * glm::distance(camera.position, camera.target) *
         std::tan(glm::radians(0.5f * camera.fov_y_degrees));
}

// Unit, level, from the target towards the camera.
glm::vec3 Backwards(const render::Camera& camera) {
  const glm::vec3 level = (camera.position - camera.target) * glm::vec3(1.0f, 0.0f, 1.0f);
  return glm::length(level) > 1e-4f ? glm::normalize(level) : glm::vec3(0.0f, 0.0f, 1.0f);
}

// To the right of who looks that way.
glm::vec3 RightOf(const glm::vec3& back) { return {back.z, 0.0f, -back.x}; }

int RowsOf(int people, int columns) { return (people + columns - 1) / columns; }

// How many in a row make the picture's people the largest.
int ColumnsOf(int people, float spacing, float around, float aspect) {
  const auto size = [&](int columns) {
    const float width = (static_cast<float>(columns) - 0.5f) * spacing + around;
    const float height = static_cast<float>(RowsOf(people, columns) - 1) * kStep * spacing + around;
    return std::max(height, width / aspect);
  };
  int best = 1;
  for (int columns = 2; columns <= people; ++columns) {
    if (size(columns) < size(best)) best = columns;
  }
  return best;
}

}  // namespace

std::vector<glm::vec3> GroupPhotograph(int people, float spacing, float around, float aspect) {
  const int columns = ColumnsOf(people, spacing, around, aspect);
  std::vector<glm::vec3> spots;
  float left = -0.5f * static_cast<float>(columns - 1);  // of the row, in spacings
  for (int row = 0; row < RowsOf(people, columns); ++row) {
    const int in_row = std::min(columns, people - row * columns);
    const float before = left;
    left = -0.5f * static_cast<float>(in_row - 1);
    // In the gaps of the row before: half a place aside.
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

render::Camera OverAll(const render::Camera& camera, const std::vector<glm::vec3>& spots,
                       float aspect) {
  const float half = 0.5f * ShownBy(camera);
  const float tangent = std::tan(glm::radians(0.5f * camera.fov_y_degrees));
  const glm::vec2 slopes(aspect * tangent, tangent);
  // At a distance D from the origin's plane, what is seen at a depth z reaches (D - z) * slope to
  // both sides of the middle.
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
  all.fit_shorter_side = false;
  all.target = camera.target + middle.x * RightOf(back) + glm::vec3(0.0f, middle.y, 0.0f);
  all.position = all.target + std::max(distances.x, distances.y) * back;
  return all;
}

Result<std::unique_ptr<Crowd>> Crowd::Create(
    const character::Character& character,
    const std::vector<std::shared_ptr<const motion::Clip>>& clips,
    const std::vector<std::string>& files, const character::SkeletonMatcher& matcher,
    const CrowdOptions& options) {
  auto self = std::make_unique<Crowd>();
  self->character_ = &character;
  self->spacing_ = options.spacing;
  const int num_clips = static_cast<int>(clips.size());
  const int people = options.subjects > 0 ? options.subjects : num_clips;
  for (int i = 0; i < people; ++i) {
    const auto clip = static_cast<std::size_t>(i % num_clips);
    auto performance = Performance::Create(character, clips[clip], matcher, files[clip]);
    FURROW_RETURN_IF_ERROR(performance);
    const int frames = std::max(1, (*performance)->num_frames());
    const int sharing = (people - static_cast<int>(clip) + num_clips - 1) / num_clips;
    const int ahead =
        options.offset_frames >= 0 ? i * options.offset_frames : i / num_clips * frames / sharing;
    self->people_.push_back({std::move(*performance), ahead % frames, files[clip]});
  }
  return self;
}

int Crowd::num_frames() const {
  int most = 0;
  for (const Person& person : people_) most = std::max(most, person.performance->num_frames());
  return most;
}

void Crowd::FrameBy(const render::Camera& camera, float aspect) {
  one_ = all_ = camera;
  spots_.assign(1, glm::vec3(0.0f));
  if (people_.size() == 1) return;
  const float around = ShownBy(camera);
  const float spacing = spacing_ > 0.0f ? spacing_ : std::clamp(around, kShoulders, kArms);
  spots_ = GroupPhotograph(static_cast<int>(people_.size()), spacing, around, aspect);
  all_ = OverAll(camera, spots_, aspect);
}

Status Crowd::Advance(int frame) {
  for (Person& person : people_) {
    const int of_take = (frame + person.ahead) % std::max(1, person.performance->num_frames());
    if (Status status = person.performance->Advance(of_take); !status.ok()) {
      return status.At(person.file);
    }
  }
  return {};
}

// Back to where it would stand at rest, facing as it does there, then to its spot.
glm::mat4 Crowd::PlacementOf(std::size_t person, const render::PosedSubject& subject) const {
  if (people_.size() == 1) return glm::mat4(1.0f);
  const glm::vec3 back = Backwards(one_);
  const glm::vec3 right = RightOf(back);
  const glm::vec3& spot = spots_[person];
  const glm::mat4 follow = render::FollowTransform(one_, character_->skeleton, subject.model);
  return glm::translate(glm::mat4(1.0f),
                        spot.x * right + glm::vec3(0.0f, spot.y, 0.0f) + spot.z * back) *
         glm::inverse(follow);
}

render::FrameRequest Crowd::Request() {
  render::FrameRequest request;
  others_.clear();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    render::PosedSubject subject = people_[i].performance->subject();
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
