// SPDX-License-Identifier: Apache-2.0
// ParseGltfAnimation(): samples the tracks of a glTF animation into the frames of a clip.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/status.h"
#include "gltf/animation/animation.h"
#include "gltf/animation/vrm_animation.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"
#include "motion/clip/limits.h"
#include "motion/gltf/gltf_animation.h"
#include "motion/gltf/gltf_skeleton.h"

namespace furrow::motion {
namespace {

using gltf::NodeTrack;
using gltf::TrackTarget;
using wrinkle::Transform;

// Seconds. Keys of different samplers that are closer than this are one frame.
constexpr double kSameTime = 1e-5;

constexpr const char* kAnimationField = "animations";

struct JointTrack {
  int joint = wrinkle::kNoJoint;
  const NodeTrack* track = nullptr;
};

// The source of one column of Clip::blend_shapes.
struct ShapeSource {
  const gltf::Track* track = nullptr;  // null: `rest` in every frame
  std::size_t component = 0;
  float rest = 0.0f;
};

// Samples all tracks at all times of any key. Keys stay exact, and frames are as uneven as the
// keys.
class ClipSampler {
 public:
  ClipSampler(gltf::Document* document, const GltfOptions& options)
      : document_(*document), options_(options) {}

  Result<Clip> Run() {
    Result<gltf::NodeForest> forest = gltf::ReadNodes(&document_);
    FURROW_RETURN_IF_ERROR(forest);
    forest_ = std::move(*forest);
    Result<gltf::Animation> animation =
        gltf::ReadAnimation(&document_, forest_, options_.load.animation);
    FURROW_RETURN_IF_ERROR(animation);
    animation_ = std::move(*animation);
    clip_.name = animation_.name;
    const Result<gltf::VrmAnimation> vrm = gltf::ReadVrmAnimation(document_);
    FURROW_RETURN_IF_ERROR(vrm);
    if (vrm->look_at != gltf::kNone) {
      document_.Warn("extensions.VRMC_vrm_animation.lookAt", "is not supported and is ignored");
    }
    Result<GltfSkeleton> joints =
        BuildGltfSkeleton(&document_, forest_, *vrm, animation_, options_.load.scale);
    FURROW_RETURN_IF_ERROR(joints);
    joint_of_node_ = std::move(joints->joint_of_node);
    clip_.skeleton = std::move(joints->skeleton);
    ListShapes(*vrm);
    FURROW_RETURN_IF_ERROR(ListTimes());
    if (clip_.skeleton.num_joints() == 0 && clip_.blend_shape_names.empty()) {
      return Status(StatusCode::kSchema, "the animation moves neither joints nor morph weights",
                    kAnimationField);
    }
    return Sample();
  }

 private:
  // Several meshes (face, teeth) often share shapes of one name; the first one counts.
  void AddShape(const std::string& name, const ShapeSource& source) {
    std::vector<std::string>& names = clip_.blend_shape_names;
    if (names.size() >= kMaxBlendShapes || !shape_names_.insert(name).second) return;
    names.push_back(name);
    shapes_.push_back(source);
  }

  void ListShapes(const gltf::VrmAnimation& vrm) {
    for (const auto& [name, node] : vrm.expressions) {
      ShapeSource source;
      // VRM stores an expression's weight in the node's translation along x.
      source.rest = forest_.nodes[static_cast<std::size_t>(node)].local.translation.x;
      for (const NodeTrack& track : animation_.tracks) {
        if (track.node == node && track.target == TrackTarget::kTranslation) {
          source.track = &track.track;
        }
      }
      AddShape(name, source);
    }
    for (const NodeTrack& track : animation_.tracks) {
      if (track.target != TrackTarget::kMorphWeights) continue;
      const int mesh = forest_.nodes[static_cast<std::size_t>(track.node)].mesh;
      const std::vector<std::string> names = document_.MorphTargetNames(mesh);
      for (std::size_t i = 0; i < names.size(); ++i) AddShape(names[i], {&track.track, i, 0.0f});
    }
  }

  Status ListTimes() {
    std::vector<double> all;
    std::unordered_set<const void*> seen;
    for (const NodeTrack& track : animation_.tracks) {
      // Samplers share lists of times; each list is added once.
      if (!seen.insert(track.track.times.get()).second) continue;
      all.insert(all.end(), track.track.times->begin(), track.track.times->end());
    }
    if (all.empty()) {
      return {StatusCode::kSchema, "the animation has no keys", kAnimationField};
    }
    std::sort(all.begin(), all.end());
    if (options_.load.sample_rate > 0.0) return ListEvenTimes(all.front(), all.back());
    for (const double time : all) {
      if (clip_.times.empty() || time - clip_.times.back() > kSameTime) clip_.times.push_back(time);
    }
    return CheckSize(clip_.times.size());
  }

  Status ListEvenTimes(double first, double last) {
    // In double, and compared before the cast, because the rate comes from the caller and the times
    // from the file.
    const double count = std::floor((last - first) * options_.load.sample_rate + kSameTime) + 1.0;
    if (!(count <= static_cast<double>(kMaxFrames))) {
      return {StatusCode::kLimit, "too many frames at this sample rate", kAnimationField};
    }
    FURROW_RETURN_IF_ERROR(CheckSize(static_cast<std::size_t>(count)));
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      clip_.times.push_back(first + static_cast<double>(i) / options_.load.sample_rate);
    }
    return {};
  }

  [[nodiscard]] Status CheckSize(std::size_t frames) const {
    const auto joints = static_cast<std::size_t>(clip_.skeleton.num_joints());
    if (frames <= kMaxFrames && frames * joints <= kMaxTransforms &&
        frames * shapes_.size() <= kMaxBlendShapeValues) {
      return {};
    }
    return {StatusCode::kLimit, "too many frames", kAnimationField};
  }

  // Tracks of other nodes are left out: a file may have thousands of them.
  [[nodiscard]] std::vector<JointTrack> ListJointTracks() const {
    std::vector<JointTrack> result;
    for (const NodeTrack& track : animation_.tracks) {
      const int joint = joint_of_node_[static_cast<std::size_t>(track.node)];
      if (track.target != TrackTarget::kMorphWeights && joint != wrinkle::kNoJoint) {
        result.push_back({joint, &track});
      }
    }
    return result;
  }

  Result<Clip> Sample() {
    const auto rest = clip_.skeleton.rest_pose();
    const std::vector<JointTrack> joint_tracks = ListJointTracks();
    clip_.locals.reserve(clip_.times.size() * rest.size());
    std::vector<float> shape_values;
    for (std::size_t f = 0; f < clip_.times.size(); ++f) {
      clip_.locals.insert(clip_.locals.end(), rest.begin(), rest.end());
      Transform* locals = clip_.locals.data() + f * rest.size();
      for (const auto& [joint, track] : joint_tracks) {
        Apply(*track, clip_.times[f], locals + joint);
      }
      KeepSigns(f, rest.size());
      SampleShapes(clip_.times[f], &shape_values);
    }
    return CheckFinite();
  }

  // The shapes of one track are neighbours in `shapes_`, so each track is evaluated once.
  void SampleShapes(double time, std::vector<float>* values) {
    const gltf::Track* evaluated = nullptr;
    for (const ShapeSource& shape : shapes_) {
      if (shape.track != nullptr && shape.track != evaluated) {
        values->resize(shape.track->width);
        shape.track->Evaluate(time, values->data());
        evaluated = shape.track;
      }
      clip_.blend_shapes.push_back(shape.track != nullptr ? (*values)[shape.component]
                                                          : shape.rest);
    }
  }

  void Apply(const NodeTrack& track, double time, Transform* local) const {
    float v[4];
    track.track.Evaluate(time, v);
    switch (track.target) {
      case TrackTarget::kTranslation:
        local->translation = glm::vec3(v[0], v[1], v[2]) * options_.load.scale;
        break;
      case TrackTarget::kRotation: local->rotation = glm::quat(v[3], v[0], v[1], v[2]); break;
      case TrackTarget::kScale: local->scale = glm::vec3(v[0], v[1], v[2]); break;
      case TrackTarget::kMorphWeights: break;
    }
  }

  // q and -q are the same rotation. Takes the one closer to the previous frame, so that later
  // interpolation between frames follows the shorter arc.
  void KeepSigns(std::size_t frame, std::size_t num_joints) {
    for (std::size_t j = 0; frame > 0 && j < num_joints; ++j) {
      glm::quat& rotation = clip_.locals[frame * num_joints + j].rotation;
      const glm::quat& before = clip_.locals[(frame - 1) * num_joints + j].rotation;
      if (glm::dot(rotation, before) < 0.0f) rotation = -rotation;
    }
  }

  // Splines and large scales can leave the range of a float between finite keys.
  Result<Clip> CheckFinite() {
    const bool finite = std::all_of(clip_.locals.begin(), clip_.locals.end(), wrinkle::IsValid) &&
                        std::all_of(clip_.blend_shapes.begin(), clip_.blend_shapes.end(),
                                    [](float value) { return std::isfinite(value); });
    if (!finite) {
      return Status(StatusCode::kNonFinite, "the animation leaves the range of a float",
                    kAnimationField);
    }
    return std::move(clip_);
  }

  gltf::Document& document_;
  const GltfOptions& options_;
  gltf::NodeForest forest_;
  gltf::Animation animation_;
  std::vector<int> joint_of_node_;
  std::vector<ShapeSource> shapes_;
  std::unordered_set<std::string> shape_names_;
  Clip clip_;
};

}  // namespace

Result<Clip> ParseGltfAnimation(std::string_view bytes, std::string_view source_name,
                                const GltfOptions& options, ClipReport* report) {
  if (!std::isfinite(options.load.scale) || options.load.scale <= 0.0f) {
    return Status(StatusCode::kInvalidArgument, "the scale must be greater than 0");
  }
  Result<gltf::Document> document = gltf::Document::Open(
      bytes, {.contents = gltf::Contents::kAnimation, .folder = options.folder});
  if (!document.ok()) return document.status().Within(source_name);
  Result<Clip> clip = ClipSampler(&*document, options).Run();
  if (!clip.ok()) return clip.status().Within(source_name);
  if (report != nullptr) {
    // A converted file holds the chosen animation only; its converter listed all of them.
    if (report->animations.empty()) {
      for (gltf::AnimationSummary& animation : gltf::ListAnimations(*document)) {
        report->animations.push_back({std::move(animation.name), animation.seconds});
      }
    }
    for (const std::string& warning : document->warnings()) {
      report->warnings.push_back(std::string(source_name) + ": " + warning);
    }
  }
  return clip;
}

}  // namespace furrow::motion
