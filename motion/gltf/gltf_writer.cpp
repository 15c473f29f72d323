// SPDX-License-Identifier: Apache-2.0
// ClipToGlb(): the frames of a clip as the tracks of a glTF animation.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "gltf/scene/joints.h"
#include "gltf/write/builder.h"
#include "gltf/write/scene_json.h"
#include "motion/gltf/gltf_animation.h"

namespace furrow::motion {
namespace {

using gltf::Builder;
using wrinkle::Transform;
using Json = Builder::Json;

// Joints are nodes 0 to num_joints - 1, so tracks address a joint by its index.
class ClipWriter {
 public:
  explicit ClipWriter(const Clip& clip)
      : clip_(clip), num_joints_(static_cast<std::size_t>(clip.skeleton.num_joints())) {}

  Result<std::string> Run() {
    FURROW_RETURN_IF_ERROR(AddTimes());
    AddJoints();
    AddJointTracks();
    if (!clip_.blend_shape_names.empty()) AddBlendShapes();
    if (channels_.empty()) AddRotationTrack(0);  // glTF requires at least one channel
    Json& root = builder_.root();
    root["scenes"] = Json::array({{{"nodes", std::move(scene_nodes_)}}});
    root["nodes"] = std::move(nodes_);
    root["animations"] = Json::array({{{"name", clip_.name},
                                       {"samplers", std::move(samplers_)},
                                       {"channels", std::move(channels_)}}});
    return builder_.Finish();
  }

 private:
  [[nodiscard]] const Transform& Local(std::size_t frame, std::size_t joint) const {
    return clip_.locals[frame * num_joints_ + joint];
  }

  Status AddTimes() {
    std::vector<float> times;
    for (const double time : clip_.times) {
      // glTF stores times as floats. Starting at 0 keeps their digits.
      times.push_back(static_cast<float>(time - clip_.times.front()));
    }
    if (times.empty()) return {StatusCode::kInvalidArgument, "the clip has no frames"};
    if (!std::is_sorted(times.begin(), times.end(), std::less_equal<>())) {
      return {StatusCode::kInvalidArgument, "two frames are too close for glTF's float times"};
    }
    times_ = builder_.AddAccessor(times, Builder::kFloat, "SCALAR", Builder::kNoTarget);
    // glTF requires min and max for the times of a sampler.
    builder_.accessor(times_)["min"] = {times.front()};
    builder_.accessor(times_)["max"] = {times.back()};
    return {};
  }

  void AddJoints() {
    if (num_joints_ == 0) return;
    std::vector<gltf::Joint> joints;
    Json indices = Json::array();
    for (std::size_t j = 0; j < num_joints_; ++j) {
      const Transform& rest = clip_.skeleton.rest_pose()[j];
      joints.push_back({clip_.skeleton.joint_names()[j],
                        clip_.skeleton.joint_parents()[j],
                        {rest.translation, rest.rotation, rest.scale},
                        clip_.skeleton.tails()[j],
                        static_cast<int>(j),
                        {}});
      indices.push_back(j);
    }
    gltf::AddJointNodes(joints, &nodes_, &scene_nodes_);
    builder_.root()["skins"] = Json::array({{{"joints", std::move(indices)}}});
  }

  // Properties that never leave rest need no track: the node's transform states them.
  template <class Member>
  [[nodiscard]] bool LeavesRest(std::size_t joint, Member Transform::*member) const {
    const Member& rest = clip_.skeleton.rest_pose()[joint].*member;
    for (std::size_t f = 0; f < clip_.times.size(); ++f) {
      if (Local(f, joint).*member != rest) return true;
    }
    return false;
  }

  void AddJointTracks() {
    for (std::size_t j = 0; j < num_joints_; ++j) {
      if (LeavesRest(j, &Transform::rotation)) AddRotationTrack(j);
      AddVectorTrack(j, "translation", &Transform::translation);
      AddVectorTrack(j, "scale", &Transform::scale);
    }
  }

  void AddRotationTrack(std::size_t joint) {
    std::vector<float> values;
    for (std::size_t f = 0; f < clip_.times.size(); ++f) {
      const glm::quat& q = Local(f, joint).rotation;
      values.insert(values.end(), {q.x, q.y, q.z, q.w});
    }
    AddTrack(joint, "rotation", "VEC4", values, clip_.times.size());
  }

  void AddVectorTrack(std::size_t joint, const char* path, glm::vec3 Transform::*member) {
    if (!LeavesRest(joint, member)) return;
    std::vector<float> values;
    for (std::size_t f = 0; f < clip_.times.size(); ++f) {
      const glm::vec3& v = Local(f, joint).*member;
      values.insert(values.end(), {v.x, v.y, v.z});
    }
    AddTrack(joint, path, "VEC3", values, clip_.times.size());
  }

  void AddTrack(std::size_t node, const char* path, const char* type,
                const std::vector<float>& values, std::size_t num_elements) {
    const int output =
        builder_.AddAccessor(values, Builder::kFloat, type, Builder::kNoTarget, num_elements);
    channels_.push_back(
        {{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", times_}, {"output", output}, {"interpolation", "LINEAR"}});
  }

  // Morph weights need a mesh. Its one triangle has all corners at the origin, and the same zeros
  // serve as every morph target.
  void AddBlendShapes() {
    const std::vector<float> zeros(9, 0.0f);
    const int position =
        builder_.AddAccessor(zeros, Builder::kFloat, "VEC3", Builder::kNoTarget, 3);
    builder_.accessor(position)["min"] = {0.0, 0.0, 0.0};
    builder_.accessor(position)["max"] = {0.0, 0.0, 0.0};
    const Json target = {{"POSITION", position}};
    Json targets = Json::array();
    for (std::size_t i = 0; i < clip_.blend_shape_names.size(); ++i) targets.push_back(target);
    Json primitive = {{"attributes", target}, {"targets", std::move(targets)}};
    builder_.root()["meshes"] =
        Json::array({{{"name", "blend_shapes"},
                      {"primitives", Json::array({std::move(primitive)})},
                      {"extras", {{"targetNames", clip_.blend_shape_names}}}}});
    const std::size_t node = nodes_.size();
    nodes_.push_back({{"name", "blend_shapes"}, {"mesh", 0}});
    scene_nodes_.push_back(node);
    AddTrack(node, "weights", "SCALAR", clip_.blend_shapes, clip_.blend_shapes.size());
  }

  const Clip& clip_;
  const std::size_t num_joints_;
  Builder builder_;
  Json nodes_ = Json::array();
  Json scene_nodes_ = Json::array();
  Json samplers_ = Json::array();
  Json channels_ = Json::array();
  int times_ = 0;  // accessor
};

}  // namespace

Result<std::string> ClipToGlb(const Clip& clip) {
  if (clip.skeleton.num_joints() == 0 && clip.blend_shape_names.empty()) {
    return Status(StatusCode::kUnsupported, "the clip has neither joints nor blend shapes");
  }
  return ClipWriter(clip).Run();
}

}  // namespace furrow::motion
