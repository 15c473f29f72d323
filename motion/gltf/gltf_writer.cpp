// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/status.h"
#include "motion/gltf/gltf_animation.h"

namespace furrow::motion {
namespace {

using Json = nlohmann::json;
using wrinkle::kNoJoint;
using wrinkle::Transform;

constexpr int kFloat = 5126;  // GL_FLOAT

void AppendU32(std::uint32_t value, std::string* bytes) {
  for (int shift = 0; shift < 32; shift += 8) *bytes += static_cast<char>(value >> shift & 0xFF);
}

Json ToJson(const glm::vec3& v) { return {v.x, v.y, v.z}; }

class GlbWriter {
 public:
  explicit GlbWriter(const Clip& clip)
      : clip_(clip), num_joints_(static_cast<std::size_t>(clip.skeleton.num_joints())) {}

  Result<std::string> Run() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Furrow"}};
    json_["scene"] = 0;
    json_["nodes"] = Json::array();
    FURROW_RETURN_IF_ERROR(AddTimes());
    animation_ = {{"name", clip_.name}, {"samplers", Json::array()}, {"channels", Json::array()}};
    AddJoints();
    AddJointTracks();
    if (!clip_.blend_shape_names.empty()) AddBlendShapes();
    if (animation_["channels"].empty()) {  // glTF allows no animation without a channel
      AddTrack(0, "rotation", "VEC4", [this](std::string* out) {
        for (std::size_t f = 0; f < clip_.times.size(); ++f) AppendRotation(Local(f, 0), out);
      });
    }
    json_["scenes"] = Json::array({{{"nodes", scene_nodes_}}});
    json_["animations"] = Json::array({std::move(animation_)});
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    return Pack();
  }

 private:
  [[nodiscard]] const Transform& Local(std::size_t frame, std::size_t joint) const {
    return clip_.locals[frame * num_joints_ + joint];
  }

  // Appends what `fill` writes as a buffer view and an accessor of floats; its index.
  template <class Fill>
  std::size_t AddAccessor(const char* type, std::size_t count, const Fill& fill) {
    const std::size_t offset = binary_.size();
    fill(&binary_);
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", binary_.size() - offset}});
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", kFloat},
                                  {"count", count},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }

  static void AppendFloat(float value, std::string* out) {
    char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    out->append(bytes, sizeof(value));
  }
  static void AppendVector(const glm::vec3& v, std::string* out) {
    for (int axis = 0; axis < 3; ++axis) AppendFloat(v[axis], out);
  }
  static void AppendRotation(const Transform& local, std::string* out) {
    const glm::quat& q = local.rotation;
    for (const float value : {q.x, q.y, q.z, q.w}) AppendFloat(value, out);
  }

  Status AddTimes() {
    std::vector<float> times;
    for (const double time : clip_.times) {
      times.push_back(static_cast<float>(time - clip_.times.front()));
    }
    if (times.empty()) return {StatusCode::kInvalidArgument, "the clip has no frames"};
    if (!std::is_sorted(times.begin(), times.end(), std::less_equal<>())) {
      return {StatusCode::kInvalidArgument, "two frames are too near for glTF's times"};
    }
    times_ = AddAccessor("SCALAR", times.size(), [&times](std::string* out) {
      for (const float time : times) AppendFloat(time, out);
    });
    json_["accessors"][times_]["min"] = {times.front()};
    json_["accessors"][times_]["max"] = {times.back()};
    return {};
  }

  void AddJoints() {
    if (num_joints_ == 0) return;
    Json indices = Json::array();
    for (std::size_t j = 0; j < num_joints_; ++j) {
      const Transform& rest = clip_.skeleton.rest_pose()[j];
      const glm::quat& q = rest.rotation;
      Json node = {{"name", clip_.skeleton.joint_names()[j]},
                   {"translation", ToJson(rest.translation)},
                   {"rotation", {q.x, q.y, q.z, q.w}},
                   {"extras", {{"furrow_tail", ToJson(clip_.skeleton.tails()[j])}}}};
      if (rest.scale != glm::vec3(1.0f)) node["scale"] = ToJson(rest.scale);
      json_["nodes"].push_back(std::move(node));
      const int parent = clip_.skeleton.joint_parents()[j];
      if (parent == kNoJoint) {
        scene_nodes_.push_back(j);
      } else {
        json_["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(j);
      }
      indices.push_back(j);
    }
    json_["skins"] = Json::array({{{"joints", std::move(indices)}}});
  }

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
      if (LeavesRest(j, &Transform::rotation)) {
        AddTrack(j, "rotation", "VEC4", [&](std::string* out) {
          for (std::size_t f = 0; f < clip_.times.size(); ++f) AppendRotation(Local(f, j), out);
        });
      }
      AddVectorTrack(j, "translation", &Transform::translation);
      AddVectorTrack(j, "scale", &Transform::scale);
    }
  }

  void AddVectorTrack(std::size_t joint, const char* path, glm::vec3 Transform::*member) {
    if (!LeavesRest(joint, member)) return;
    AddTrack(joint, path, "VEC3", [&](std::string* out) {
      for (std::size_t f = 0; f < clip_.times.size(); ++f)
        AppendVector(Local(f, joint).*member, out);
    });
  }

  template <class Fill>
  void AddTrack(std::size_t node, const char* path, const char* type, const Fill& fill,
                std::size_t elements_a_frame = 1) {
    const std::size_t output = AddAccessor(type, clip_.times.size() * elements_a_frame, fill);
    animation_["samplers"].push_back(
        {{"input", times_}, {"output", output}, {"interpolation", "LINEAR"}});
    animation_["channels"].push_back({{"sampler", animation_["samplers"].size() - 1},
                                      {"target", {{"node", node}, {"path", path}}}});
  }

  // Morph weights need a mesh: one triangle in one point, whose zeros serve as every target.
  void AddBlendShapes() {
    const std::size_t num_shapes = clip_.blend_shape_names.size();
    const std::size_t position = AddAccessor("VEC3", 3, [](std::string* out) {
      for (int corner = 0; corner < 3; ++corner) AppendVector(glm::vec3(0.0f), out);
    });
    json_["accessors"][position]["min"] = {0.0, 0.0, 0.0};
    json_["accessors"][position]["max"] = {0.0, 0.0, 0.0};
    const Json target = {{"POSITION", position}};
    const Json primitive = {{"attributes", {{"POSITION", position}}},
                            {"targets", Json(num_shapes, target)}};
    json_["meshes"] = Json::array({{{"name", "blend_shapes"},
                                    {"primitives", Json::array({primitive})},
                                    {"extras", {{"targetNames", clip_.blend_shape_names}}}}});
    const std::size_t node = json_["nodes"].size();
    json_["nodes"].push_back({{"name", "blend_shapes"}, {"mesh", 0}});
    scene_nodes_.push_back(node);
    AddTrack(
        node, "weights", "SCALAR",
        [this](std::string* out) {
          for (const float value : clip_.blend_shapes) AppendFloat(value, out);
        },
        num_shapes);
  }

  Result<std::string> Pack() {
    std::string json = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.append((4 - json.size() % 4) % 4, ' ');
    const std::size_t size = 12 + 8 + json.size() + 8 + binary_.size();
    if (size > 0xFFFFFFFFu) return Status(StatusCode::kLimit, "a GLB holds at most 4 GiB");
    std::string glb = "glTF";
    AppendU32(2, &glb);
    AppendU32(static_cast<std::uint32_t>(size), &glb);
    AppendU32(static_cast<std::uint32_t>(json.size()), &glb);
    glb += "JSON" + json;
    AppendU32(static_cast<std::uint32_t>(binary_.size()), &glb);  // floats alone: a multiple of 4
    glb.append("BIN\0", 4);
    return glb + binary_;
  }

  const Clip& clip_;
  const std::size_t num_joints_;
  Json json_;
  Json animation_;
  std::vector<std::size_t> scene_nodes_;
  std::string binary_;
  std::size_t times_ = 0;  // accessor
};

}  // namespace

Result<std::string> ClipToGlb(const Clip& clip) {
  if (clip.skeleton.num_joints() == 0 && clip.blend_shape_names.empty()) {
    return Status(StatusCode::kUnsupported, "the clip has neither joints nor blend shapes");
  }
  return GlbWriter(clip).Run();
}

}  // namespace furrow::motion
