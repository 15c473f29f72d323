// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/pose_clip.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "rig/rig_reference_pose.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::cli {
namespace {

using rig::WeightedPose;

constexpr float kMaxWeight = 4.0f;

struct Term {
  std::string_view name;
  float weight = 1.0f;
};

Result<Term> ParseTerm(std::string_view text) {
  Term term;
  const std::size_t equals = text.find('=');
  term.name = text.substr(0, equals);
  if (equals == std::string_view::npos) return term;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + equals + 1, end, term.weight);
  if (read.ec == std::errc() && read.ptr == end && term.weight >= -kMaxWeight &&
      term.weight <= kMaxWeight) {
    return term;
  }
  return Status(StatusCode::kParse, "'" + std::string(text) +
                                        "' is not NAME or NAME=WEIGHT with a weight from -4 to 4");
}

const wrinkle::ReferencePose* FindPose(const wrinkle::Rig& rig, std::string_view name) {
  const auto found = std::find_if(rig.reference_poses.begin(), rig.reference_poses.end(),
                                  [&](const auto& pose) { return pose.name == name; });
  return found == rig.reference_poses.end() ? nullptr : &*found;
}

void AddOnce(const wrinkle::ReferencePose* pose, float weight, std::vector<WeightedPose>* parts) {
  const bool there = std::any_of(parts->begin(), parts->end(),
                                 [&](const WeightedPose& part) { return part.pose == pose; });
  if (pose != nullptr && !there) parts->push_back({pose, weight});
}

// All reference poses that feed wrinkle map `map` in any region.
std::vector<WeightedPose> PosesOfMap(const wrinkle::Rig& rig, std::string_view map, float weight) {
  std::vector<WeightedPose> parts;
  for (const wrinkle::Region& region : rig.regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      if (feed.map != map) continue;
      for (const wrinkle::Feed::Source& source : feed.sources) {
        const auto driver =
            std::find_if(rig.drivers.begin(), rig.drivers.end(),
                         [&](const wrinkle::Driver& d) { return d.name == source.driver; });
        if (driver == rig.drivers.end() || driver->kind != wrinkle::Driver::Kind::kPose) continue;
        for (const auto& value : driver->pose.values) {
          if (value.name == source.value)
            AddOnce(FindPose(rig, value.reference_pose), weight, &parts);
        }
      }
    }
  }
  return parts;
}

std::vector<WeightedPose> PosesOf(const wrinkle::Rig& rig, const Term& term) {
  const std::string name(term.name);
  if (const auto* pose = FindPose(rig, name)) return {{pose, term.weight}};
  const auto* left = FindPose(rig, name + "_l");
  const auto* right = FindPose(rig, name + "_r");
  if (left != nullptr && right != nullptr) return {{left, term.weight}, {right, term.weight}};
  return PosesOfMap(rig, name, term.weight);
}

Status Unknown(const wrinkle::Rig& rig, std::string_view name) {
  std::string known = "neutral";
  for (const wrinkle::ReferencePose& pose : rig.reference_poses) known += ", " + pose.name;
  return {StatusCode::kNotFound,
          "the rig has no reference pose '" + std::string(name) +
              "' and no wrinkle map of this name that poses feed; valid names: " + known};
}

Result<std::vector<WeightedPose>> ParsePoses(const wrinkle::Rig& rig, std::string_view text) {
  std::vector<WeightedPose> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto term = ParseTerm(text.substr(at, comma - at));
    FURROW_RETURN_IF_ERROR(term);
    at = comma + 1;
    const auto poses = PosesOf(rig, *term);
    if (poses.empty() && term->name == "neutral") continue;  // adds nothing
    if (poses.empty()) return Unknown(rig, term->name);
    parts.insert(parts.end(), poses.begin(), poses.end());
  }
  return parts;
}

}  // namespace

Result<motion::Clip> PoseClip(const character::Character& character, const std::string& text) {
  const auto parts = ParsePoses(character.rig, text);
  FURROW_RETURN_IF_ERROR(parts);
  motion::Clip clip;
  clip.name = text;
  clip.skeleton = character.skeleton;
  clip.times = {0.0};
  clip.locals.assign(clip.skeleton.rest_pose().begin(), clip.skeleton.rest_pose().end());
  const wrinkle::ReferencePose mix = rig::MixReferencePoses(text, *parts);
  FURROW_RETURN_IF_ERROR(wrinkle::ApplyReferencePose(mix, clip.skeleton, clip.locals));
  return clip;
}

}  // namespace furrow::cli
