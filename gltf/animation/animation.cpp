// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation/animation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <tiny_gltf.h>

#include "base/text.h"
#include "gltf/document/accessor.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

std::optional<TrackTarget> ParseTarget(std::string_view path) {
  if (path == "translation") return TrackTarget::kTranslation;
  if (path == "rotation") return TrackTarget::kRotation;
  if (path == "scale") return TrackTarget::kScale;
  if (path == "weights") return TrackTarget::kMorphWeights;
  return std::nullopt;
}

ElementType ElementTypeOf(TrackTarget target) {
  switch (target) {
    case TrackTarget::kRotation: return ElementType::kVec4;
    case TrackTarget::kMorphWeights: return ElementType::kScalar;
    default: return ElementType::kVec3;
  }
}

// "0 'walk', 1 'run'", at most 16.
std::string ListOf(const std::vector<tinygltf::Animation>& animations) {
  constexpr std::size_t kMaxListed = 16;
  std::string list;
  for (std::size_t i = 0; i < std::min(animations.size(), kMaxListed); ++i) {
    list += (i == 0 ? "" : ", ") + std::to_string(i) + " " + Quoted(animations[i].name);
  }
  return animations.size() > kMaxListed ? list + ", ..." : list;
}

// The index of the animation with a name, else with a number; the number of animations if there is
// none.
std::size_t FindAnimation(const std::vector<tinygltf::Animation>& animations,
                          std::string_view choice) {
  for (std::size_t i = 0; i < animations.size(); ++i) {
    if (animations[i].name == choice) return i;
  }
  for (std::size_t i = 0; i < animations.size(); ++i) {
    if (std::to_string(i) == choice) return i;
  }
  return animations.size();
}

// Reads one animation: tracks of one node and property each, bounded by kMaxAnimationNumbers
// in total, because many channels may share one large accessor.
class AnimationReader {
 public:
  AnimationReader(Document* document, const NodeForest& forest, std::string_view choice)
      : document_(*document), forest_(forest), choice_(choice) {}

  Result<Animation> Run() {
    const std::vector<tinygltf::Animation>& animations = document_.model().animations;
    if (animations.empty()) {
      return Status(StatusCode::kSchema, "the file has no animation", "animations");
    }
    if (choice_.empty() && animations.size() > 1) {
      document_.Warn("animations", "the file has " + std::to_string(animations.size()) +
                                       " animations; reading the first of " + ListOf(animations) +
                                       " (choose another with FILE#NAME or FILE#INDEX)");
    }
    const std::size_t index = choice_.empty() ? 0 : FindAnimation(animations, choice_);
    if (index == animations.size()) {
      return Status(StatusCode::kNotFound, "the file has no animation " + Quoted(choice_),
                    "animations", "choose one of: " + ListOf(animations));
    }
    from_ = &animations[index];
    field_ = "animations[" + std::to_string(index) + "]";
    result_.name = from_->name;
    if (from_->channels.size() > kMaxChannels) {
      return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxChannels) + " channels",
                    field_ + ".channels");
    }
    for (std::size_t i = 0; i < from_->channels.size(); ++i) {
      const std::string field = field_ + ".channels[" + std::to_string(i) + "]";
      FURROW_RETURN_IF_ERROR(ReadChannel(from_->channels[i], field));
    }
    return std::move(result_);
  }

 private:
  Status ReadChannel(const tinygltf::AnimationChannel& channel, const std::string& field) {
    if (channel.sampler < 0 || channel.sampler >= static_cast<int>(from_->samplers.size())) {
      return {StatusCode::kSchema, "sampler " + std::to_string(channel.sampler) + " does not exist",
              field + ".sampler"};
    }
    // Extensions may animate other things; glTF 2.0 then omits the node.
    if (channel.target_node == kNone) return {};
    if (channel.target_node < 0 || channel.target_node >= static_cast<int>(forest_.nodes.size())) {
      return {StatusCode::kSchema,
              "node " + std::to_string(channel.target_node) + " does not exist",
              field + ".target.node"};
    }
    const std::optional<TrackTarget> target = ParseTarget(channel.target_path);
    if (!target) {
      document_.Warn(field + ".target.path",
                     Quoted(channel.target_path) + " is not supported and is ignored");
      return {};
    }
    // glTF 2.0 forbids two channels with the same target. A node has four properties, hence the
    // key.
    NodeTrack track{channel.target_node, *target, {}};
    const std::size_t key =
        static_cast<std::size_t>(track.node) * 4 + static_cast<std::size_t>(track.target);
    if (!animated_.insert(key).second) {
      return {StatusCode::kSchema, "another channel animates the same target", field};
    }
    FURROW_RETURN_IF_ERROR(ReadSampler(static_cast<std::size_t>(channel.sampler), &track));
    result_.tracks.push_back(std::move(track));
    return {};
  }

  Status ReadSampler(std::size_t index, NodeTrack* node_track) {
    const std::string field = field_ + ".samplers[" + std::to_string(index) + "]";
    const tinygltf::AnimationSampler& sampler = from_->samplers[index];
    Track& track = node_track->track;
    if (sampler.interpolation == "STEP") {
      track.interpolation = Track::Interpolation::kStep;
    } else if (sampler.interpolation == "CUBICSPLINE") {
      track.interpolation = Track::Interpolation::kCubicSpline;
    } else if (sampler.interpolation != "LINEAR" && !sampler.interpolation.empty()) {
      return {StatusCode::kSchema, "unknown interpolation " + Quoted(sampler.interpolation),
              field + ".interpolation"};
    }
    FURROW_RETURN_IF_ERROR(ReadTimes(sampler.input, field + ".input", &track));
    const ElementType type = ElementTypeOf(node_track->target);
    const auto node = static_cast<std::size_t>(node_track->node);
    track.is_rotation = node_track->target == TrackTarget::kRotation;
    track.width = node_track->target == TrackTarget::kMorphWeights
                      ? document_.NumMorphTargets(forest_.nodes[node].mesh)
                      : static_cast<std::size_t>(ComponentsOf(type));
    Result<std::vector<float>> values =
        ReadFloats(document_, sampler.output, type, field + ".output", &budget_);
    FURROW_RETURN_IF_ERROR(values);
    track.values = std::move(*values);
    return CheckValues(track, field + ".output");
  }

  // Samplers usually share one list of times, so each accessor is read once.
  Status ReadTimes(int accessor, const std::string& where, Track* track) {
    std::shared_ptr<const std::vector<float>>& times = times_[accessor];
    if (times == nullptr) {
      Result<std::vector<float>> read =
          ReadFloats(document_, accessor, ElementType::kScalar, where, &budget_);
      FURROW_RETURN_IF_ERROR(read);
      // Strictly increasing, as glTF requires: interpolation divides by the difference of two
      // times.
      if (!std::is_sorted(read->begin(), read->end(), std::less_equal<>())) {
        return {StatusCode::kSchema, "the times do not increase", where};
      }
      times = std::make_shared<const std::vector<float>>(std::move(*read));
    }
    track->times = times;
    return {};
  }

  static Status CheckValues(const Track& track, const std::string& where) {
    // A cubic spline has an in-tangent, a value and an out-tangent per key.
    const bool cubic = track.interpolation == Track::Interpolation::kCubicSpline;
    const std::size_t expected = track.times->size() * track.width * (cubic ? 3 : 1);
    if (track.width == 0 || track.values.size() != expected) {
      return {StatusCode::kSchema,
              "has " + std::to_string(track.values.size()) + " numbers, expected " +
                  std::to_string(expected),
              where};
    }
    for (std::size_t key = 0; track.is_rotation && key < track.times->size(); ++key) {
      const float* q = track.Value(key);
      const float length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      // Quantised quaternions are slightly off 1. Evaluation normalises them; a far length is
      // another error.
      if (length2 < 0.25f || length2 > 4.0f) {
        return {StatusCode::kSchema, "key " + std::to_string(key) + " is not a unit quaternion",
                where};
      }
    }
    return {};
  }

  Document& document_;
  const NodeForest& forest_;
  const std::string_view choice_;
  std::string field_;  // "animations[0]"
  const tinygltf::Animation* from_ = nullptr;
  std::size_t budget_ = kMaxAnimationNumbers;
  std::map<int, std::shared_ptr<const std::vector<float>>> times_;  // by accessor
  std::unordered_set<std::size_t> animated_;                        // node * 4 + target
  Animation result_;
};

}  // namespace

std::vector<AnimationSummary> ListAnimations(const Document& document) {
  const tinygltf::Model& model = document.model();
  std::vector<AnimationSummary> list;
  for (const tinygltf::Animation& animation : model.animations) {
    AnimationSummary& summary = list.emplace_back();
    summary.name = animation.name;
    for (const tinygltf::AnimationSampler& sampler : animation.samplers) {
      if (sampler.input < 0 || sampler.input >= static_cast<int>(model.accessors.size())) continue;
      const auto& latest = model.accessors[static_cast<std::size_t>(sampler.input)].maxValues;
      if (latest.empty() || !std::isfinite(latest[0])) continue;
      summary.seconds = std::max(summary.seconds, latest[0]);
    }
  }
  return list;
}

Result<Animation> ReadAnimation(Document* document, const NodeForest& forest,
                                std::string_view choice) {
  return AnimationReader(document, forest, choice).Run();
}

}  // namespace furrow::gltf
