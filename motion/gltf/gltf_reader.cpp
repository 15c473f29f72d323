// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/status.h"
#include "motion/clip/limits.h"
#include "motion/gltf/gltf_animation.h"
#include "motion/gltf/gltf_document.h"
#include "motion/gltf/gltf_skeleton.h"
#include "motion/gltf/gltf_track.h"

namespace furrow::motion {
namespace {

using wrinkle::Transform;

// Seconds: keys of different samplers nearer than this are one frame.
constexpr double kSameTime = 1e-5;

enum class Path { kTranslation, kRotation, kScale, kWeights };

struct NodeTrack {
  int node = -1;
  Path path = Path::kTranslation;
  GltfTrack track;
};

struct JointTrack {
  int joint = wrinkle::kNoJoint;
  const NodeTrack* track = nullptr;
};

// Where a column of Clip::blend_shapes comes from.
struct ShapeSource {
  const GltfTrack* track = nullptr;  // null: `rest` throughout
  std::size_t component = 0;
  float rest = 0.0f;
};

class AnimationReader {
 public:
  AnimationReader(GltfDocument* document, const GltfOptions& options, ClipReport* report)
      : document_(*document), options_(options), report_(report) {}

  Result<Clip> Run() {
    if (document_.model().animations.empty()) {
      return document_.Error(StatusCode::kSchema, "animations", "there is no animation");
    }
    if (document_.model().animations.size() > 1) {
      Warn("animations", "there are " + std::to_string(document_.model().animations.size()) +
                             "; the first is read");
    }
    clip_.name = document_.model().animations.front().name;
    FURROW_RETURN_IF_ERROR(ReadTracks());
    Result<VrmAnimation> vrm = ReadVrmAnimation(document_);
    FURROW_RETURN_IF_ERROR(vrm);
    if (vrm->look_at != -1) Warn("extensions.VRMC_vrm_animation.lookAt", "is not read");
    FURROW_RETURN_IF_ERROR(MakeSkeleton(*vrm));
    ListShapes(*vrm);
    FURROW_RETURN_IF_ERROR(ListTimes());
    if (joints_.joint_nodes.empty() && clip_.blend_shape_names.empty()) {
      return document_.Error(StatusCode::kSchema, "animations[0]",
                             "moves neither joints nor morph weights");
    }
    return Sample();
  }

 private:
  void Warn(const std::string& field, const std::string& what) {
    if (report_ == nullptr) return;
    report_->warnings.push_back(document_.Error(StatusCode::kUnsupported, field, what).ToString());
  }

  Status ReadTracks() {
    const tinygltf::Animation& animation = document_.model().animations.front();
    std::unordered_set<std::size_t> taken;  // a node's path may be animated once
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
      const tinygltf::AnimationChannel& channel = animation.channels[i];
      const std::string field = "animations[0].channels[" + std::to_string(i) + "]";
      NodeTrack track;
      track.node = channel.target_node;
      if (channel.target_node == -1) continue;
      if (!FindPath(channel.target_path, &track.path)) {
        Warn(field, "animates '" + channel.target_path.substr(0, 40) + "', which is not read");
        continue;
      }
      const auto key =
          static_cast<std::size_t>(track.node) * 4 + static_cast<std::size_t>(track.path);
      if (!taken.insert(key).second) {
        return document_.Error(StatusCode::kSchema, field,
                               "animates what another channel animates");
      }
      FURROW_RETURN_IF_ERROR(ReadTrack(channel, field, &track));
      tracks_.push_back(std::move(track));
    }
    return {};
  }

  static bool FindPath(const std::string& name, Path* path) {
    static constexpr std::pair<std::string_view, Path> kPaths[] = {
        {"translation", Path::kTranslation},
        {"rotation", Path::kRotation},
        {"scale", Path::kScale},
        {"weights", Path::kWeights}};
    for (const auto& [text, value] : kPaths) {
      if (text == name) return *path = value, true;
    }
    return false;
  }

  Status ReadTrack(const tinygltf::AnimationChannel& channel, const std::string& field,
                   NodeTrack* result) {
    const tinygltf::AnimationSampler& sampler =
        document_.model().animations.front().samplers[static_cast<std::size_t>(channel.sampler)];
    GltfTrack& track = result->track;
    if (sampler.interpolation == "STEP") {
      track.interpolation = GltfTrack::Interpolation::kStep;
    } else if (sampler.interpolation == "CUBICSPLINE") {
      track.interpolation = GltfTrack::Interpolation::kCubicSpline;
    } else if (sampler.interpolation != "LINEAR" && !sampler.interpolation.empty()) {
      return document_.Error(StatusCode::kSchema, field, "unknown interpolation");
    }
    FURROW_RETURN_IF_ERROR(ReadTimes(sampler.input, field, &track));
    track.is_rotation = result->path == Path::kRotation;
    const int type = result->path == Path::kWeights ? TINYGLTF_TYPE_SCALAR
                     : track.is_rotation            ? TINYGLTF_TYPE_VEC4
                                                    : TINYGLTF_TYPE_VEC3;
    Result<std::vector<float>> values = document_.ReadFloats(sampler.output, type, field);
    FURROW_RETURN_IF_ERROR(values);
    track.values = std::move(*values);
    const auto node = static_cast<std::size_t>(result->node);
    track.width = result->path == Path::kWeights
                      ? document_.MorphTargets(document_.model().nodes[node].mesh).size()
                      : static_cast<std::size_t>(
                            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    return CheckValues(track, field);
  }

  Status ReadTimes(int accessor, const std::string& field, GltfTrack* track) {
    std::shared_ptr<const std::vector<float>>& times = times_[accessor];
    if (times == nullptr) {
      Result<std::vector<float>> read = document_.ReadFloats(accessor, TINYGLTF_TYPE_SCALAR, field);
      FURROW_RETURN_IF_ERROR(read);
      if (!std::is_sorted(read->begin(), read->end(), std::less_equal<>())) {
        return document_.Error(StatusCode::kSchema, field, "its times do not increase");
      }
      times = std::make_shared<const std::vector<float>>(std::move(*read));
    }
    track->times = times;
    return {};
  }

  Status CheckValues(const GltfTrack& track, const std::string& field) const {
    const bool cubic = track.interpolation == GltfTrack::Interpolation::kCubicSpline;
    const std::size_t wanted = track.times->size() * track.width * (cubic ? 3 : 1);
    if (track.width == 0 || track.values.size() != wanted) {
      return document_.Error(StatusCode::kSchema, field,
                             "has " + std::to_string(track.values.size()) + " numbers where " +
                                 std::to_string(wanted) + " are due");
    }
    for (std::size_t key = 0; track.is_rotation && key < track.times->size(); ++key) {
      const float* q = track.Value(key);
      const float length = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      if (length < 0.25f || length > 4.0f) {
        return document_.Error(StatusCode::kSchema, field,
                               "key " + std::to_string(key) + " is not a unit quaternion");
      }
    }
    return {};
  }

  Status MakeSkeleton(const VrmAnimation& vrm) {
    std::vector<int> moving;
    for (const NodeTrack& track : tracks_) {
      if (track.path != Path::kWeights) moving.push_back(track.node);
    }
    Result<GltfSkeleton> joints = BuildGltfSkeleton(document_, vrm, moving, options_.load.scale);
    FURROW_RETURN_IF_ERROR(joints);
    joints_ = std::move(*joints);
    clip_.skeleton = joints_.skeleton;
    return {};
  }

  void AddShape(const std::string& name, const ShapeSource& source) {
    const std::vector<std::string>& names = clip_.blend_shape_names;
    if (names.size() >= kMaxBlendShapes || !shape_names_.insert(name).second) return;
    clip_.blend_shape_names.push_back(name);
    shapes_.push_back(source);
  }

  void ListShapes(const VrmAnimation& vrm) {
    for (const auto& [name, node] : vrm.expressions) {
      const std::vector<double>& rest =
          document_.model().nodes[static_cast<std::size_t>(node)].translation;
      ShapeSource source;
      source.rest = rest.empty() ? 0.0f : static_cast<float>(rest[0]);
      for (const NodeTrack& track : tracks_) {
        if (track.node == node && track.path == Path::kTranslation) source.track = &track.track;
      }
      AddShape(name, source);
    }
    for (const NodeTrack& track : tracks_) {
      if (track.path != Path::kWeights) continue;
      const auto node = static_cast<std::size_t>(track.node);
      const std::vector<std::string>& names =
          document_.MorphTargets(document_.model().nodes[node].mesh);
      for (std::size_t i = 0; i < names.size(); ++i) AddShape(names[i], {&track.track, i, 0.0f});
    }
  }

  Status ListTimes() {
    std::vector<double> all;
    std::unordered_set<const void*> seen;
    for (const NodeTrack& track : tracks_) {
      if (!seen.insert(track.track.times.get()).second) continue;
      all.insert(all.end(), track.track.times->begin(), track.track.times->end());
    }
    if (all.empty()) return document_.Error(StatusCode::kSchema, "animations[0]", "has no keys");
    std::sort(all.begin(), all.end());
    if (options_.load.sample_rate > 0.0) return ListEvenTimes(all.front(), all.back());
    for (const double time : all) {
      if (clip_.times.empty() || time - clip_.times.back() > kSameTime) clip_.times.push_back(time);
    }
    return CheckSize(clip_.times.size());
  }

  Status ListEvenTimes(double first, double last) {
    const double count = std::floor((last - first) * options_.load.sample_rate + kSameTime) + 1.0;
    if (!(count <= static_cast<double>(kMaxFrames))) {
      return document_.Error(StatusCode::kLimit, "animations[0]", "too many frames at this rate");
    }
    FURROW_RETURN_IF_ERROR(CheckSize(static_cast<std::size_t>(count)));
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      clip_.times.push_back(first + static_cast<double>(i) / options_.load.sample_rate);
    }
    return {};
  }

  [[nodiscard]] Status CheckSize(std::size_t frames) const {
    if (frames <= kMaxFrames && frames * joints_.joint_nodes.size() <= kMaxTransforms &&
        frames * shapes_.size() <= kMaxBlendShapeValues) {
      return {};
    }
    return document_.Error(StatusCode::kLimit, "animations[0]", "too many frames");
  }

  // The tracks that move a joint; a file may hold thousands for other nodes.
  [[nodiscard]] std::vector<JointTrack> ListJointTracks() const {
    std::vector<int> joint_of_node(static_cast<std::size_t>(document_.num_nodes()),
                                   wrinkle::kNoJoint);
    for (std::size_t j = 0; j < joints_.joint_nodes.size(); ++j) {
      joint_of_node[static_cast<std::size_t>(joints_.joint_nodes[j])] = static_cast<int>(j);
    }
    std::vector<JointTrack> result;
    for (const NodeTrack& track : tracks_) {
      const int joint = joint_of_node[static_cast<std::size_t>(track.node)];
      if (track.path != Path::kWeights && joint != wrinkle::kNoJoint) {
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

  // Shapes of one track stand together: it is evaluated once.
  void SampleShapes(double time, std::vector<float>* values) {
    const GltfTrack* evaluated = nullptr;
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
    switch (track.path) {
      case Path::kTranslation:
        local->translation = glm::vec3(v[0], v[1], v[2]) * options_.load.scale;
        break;
      case Path::kRotation: local->rotation = glm::quat(v[3], v[0], v[1], v[2]); break;
      case Path::kScale: local->scale = glm::vec3(v[0], v[1], v[2]); break;
      case Path::kWeights: break;
    }
  }

  // q and -q are one rotation; the one nearer to the frame before is taken.
  void KeepSigns(std::size_t frame, std::size_t num_joints) {
    for (std::size_t j = 0; frame > 0 && j < num_joints; ++j) {
      glm::quat& rotation = clip_.locals[frame * num_joints + j].rotation;
      const glm::quat& before = clip_.locals[(frame - 1) * num_joints + j].rotation;
      if (glm::dot(rotation, before) < 0.0f) rotation = -rotation;
    }
  }

  // Finite keys far apart can overshoot between them (splines, large scales).
  Result<Clip> CheckFinite() {
    const bool finite = std::all_of(clip_.locals.begin(), clip_.locals.end(), wrinkle::IsValid) &&
                        std::all_of(clip_.blend_shapes.begin(), clip_.blend_shapes.end(),
                                    [](float value) { return std::isfinite(value); });
    if (!finite) {
      return document_.Error(StatusCode::kNonFinite, "animations[0]",
                             "leaves the range of a float");
    }
    return std::move(clip_);
  }

  GltfDocument& document_;
  const GltfOptions& options_;
  ClipReport* report_;
  std::map<int, std::shared_ptr<const std::vector<float>>> times_;  // by accessor
  std::vector<NodeTrack> tracks_;
  GltfSkeleton joints_;
  std::vector<ShapeSource> shapes_;
  std::unordered_set<std::string> shape_names_;
  Clip clip_;
};

}  // namespace

Result<Clip> ParseGltfAnimation(std::string_view bytes, std::string_view source_name,
                                const GltfOptions& options, ClipReport* report) {
  if (!std::isfinite(options.load.scale) || options.load.scale <= 0.0f) {
    return Status(StatusCode::kInvalidArgument, "the scale must be above 0");
  }
  Result<GltfDocument> document = GltfDocument::Open(bytes, source_name, options.folder);
  FURROW_RETURN_IF_ERROR(document);
  return AnimationReader(&*document, options, report).Run();
}

}  // namespace furrow::motion
