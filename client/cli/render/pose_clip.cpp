// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/pose_clip.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/ascii.h"
#include "base/status.h"
#include "base/text.h"
#include "rig/rig_reference_pose.h"
#include "rig/shapes/rig_shapes.h"
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

// A sum of reference poses and of blend shapes.
struct Mix {
  std::vector<WeightedPose> poses;
  std::vector<std::pair<std::string, float>> shapes;  // name, coefficient
};

// The blend shape of this name in any case, or else those of both sides.
std::vector<std::string> ShapesNamed(std::span<const std::string> known, std::string_view name) {
  const std::string left = std::string(name) + "Left", right = std::string(name) + "Right";
  std::vector<std::string> found;
  for (const std::string& shape : known) {
    if (EqualsIgnoreCase(shape, name)) return {shape};
    if (EqualsIgnoreCase(shape, left) || EqualsIgnoreCase(shape, right)) found.push_back(shape);
  }
  return found;
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
  std::vector<std::string> words = rig::ArkitAndRigShapes(rig);
  for (const wrinkle::ReferencePose& pose : rig.reference_poses) {
    known += ", " + pose.name;
    words.push_back(pose.name);
  }
  for (const wrinkle::Region& region : rig.regions) words.push_back(region.name);
  words.emplace_back("neutral");
  const std::string what = "the rig has no reference pose '" + std::string(name) +
                           "', and no wrinkle map of this name that poses feed";
  if (const std::string meant = DidYouMean(name, words); !meant.empty()) {
    return {StatusCode::kNotFound, what, {}, meant};
  }
  return {StatusCode::kNotFound,
          what + "; valid names: " + known +
              ", ARKit's blend shapes (browInnerUp, mouthSmile, ...) and the character's shapes"};
}

Result<Mix> ParseMix(const character::Character& character, std::string_view text) {
  const wrinkle::Rig& rig = character.rig;
  std::vector<std::string> known = rig::ArkitAndRigShapes(rig);
  for (const std::string& shape : character.shapes) {
    const bool is_known = std::ranges::any_of(
        known, [&](const std::string& name) { return EqualsIgnoreCase(name, shape); });
    if (!is_known) known.push_back(shape);
  }
  Mix mix;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto term = ParseTerm(text.substr(at, comma - at));
    FURROW_RETURN_IF_ERROR(term);
    at = comma + 1;
    const auto poses = PosesOf(rig, *term);
    if (poses.empty() && term->name == "neutral") continue;  // adds nothing
    mix.poses.insert(mix.poses.end(), poses.begin(), poses.end());
    if (!poses.empty()) continue;
    const std::vector<std::string> shapes = ShapesNamed(known, term->name);
    if (shapes.empty()) return Unknown(rig, term->name);
    for (const std::string& shape : shapes) mix.shapes.emplace_back(shape, term->weight);
  }
  return mix;
}

// True if two poses move the same joints in the same way, up to rounding.
bool MovesAlike(const wrinkle::ReferencePose& a, const wrinkle::ReferencePose& b) {
  constexpr float kSame = 1e-4f;
  return std::ranges::equal(
      a.joints, b.joints, [](const wrinkle::JointDelta& x, const wrinkle::JointDelta& y) {
        return x.joint == y.joint && std::abs(glm::dot(x.rotation, y.rotation)) > 1.0f - kSame &&
               glm::distance(x.translation, y.translation) < kSame &&
               glm::distance(x.unscaled_translation, y.unscaled_translation) < kSame;
      });
}

// Limits mouthClose to jawOpen, as for streams (wrinkle::BlendShapePose): it brings the lips
// together on an open jaw, and alone it would push each lip through the other. Poses that move as
// jawOpen does, such as the one that it mixes, open the jaw as well.
void LimitMouthClose(const wrinkle::Rig& rig, std::vector<WeightedPose>* parts) {
  const wrinkle::ReferencePose* open = FindPose(rig, "jawOpen");
  const wrinkle::ReferencePose* close = FindPose(rig, "mouthClose");
  if (open == nullptr || close == nullptr) return;
  float jaw = 0.0f, closed = 0.0f;
  for (const WeightedPose& part : *parts) {
    if (part.pose == close) closed += part.weight;
    if (part.pose == open || MovesAlike(*part.pose, *open)) jaw += part.weight;
  }
  if (closed <= std::max(jaw, 0.0f)) return;
  for (WeightedPose& part : *parts) {
    if (part.pose == close) part.weight *= std::max(jaw, 0.0f) / closed;
  }
}

// Gives the clip the blend shapes of a mix, and those of the pose that its poses add up to.
void AddShapes(const Mix& mix, std::span<const wrinkle::ShapeValue> of_poses,
               const wrinkle::Rig& rig, motion::Clip* clip) {
  if (mix.shapes.empty() && of_poses.empty()) return;
  std::vector<std::string>& names = clip->blend_shape_names;
  names = rig::ArkitAndRigShapes(rig);
  clip->blend_shapes.assign(names.size(), 0.0f);
  const auto add = [&](const std::string& shape, float weight) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return EqualsIgnoreCase(name, shape);
    });
    if (found == names.end()) {
      names.push_back(shape);
      clip->blend_shapes.push_back(weight);
    } else {
      clip->blend_shapes[static_cast<std::size_t>(found - names.begin())] += weight;
    }
  };
  for (const auto& [shape, weight] : mix.shapes) add(shape, weight);
  for (const wrinkle::ShapeValue& shape : of_poses) add(shape.blend_shape, shape.value);
}

}  // namespace

Result<motion::Clip> PoseClip(const character::Character& character, const std::string& text) {
  auto mix = ParseMix(character, text);
  FURROW_RETURN_IF_ERROR(mix);
  LimitMouthClose(character.rig, &mix->poses);
  motion::Clip clip;
  clip.name = text;
  clip.skeleton = character.skeleton;
  clip.times = {0.0};
  clip.locals.assign(clip.skeleton.rest_pose().begin(), clip.skeleton.rest_pose().end());
  const wrinkle::ReferencePose pose = rig::MixReferencePoses(text, mix->poses);
  FURROW_RETURN_IF_ERROR(wrinkle::ApplyReferencePose(pose, clip.skeleton, clip.locals));
  AddShapes(*mix, pose.shapes, character.rig, &clip);
  return clip;
}

}  // namespace furrow::cli
