// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/pivots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "authoring/assimp/scene_file.h"
#include "gltf/limits.h"

namespace furrow::authoring {
namespace {

// "mixamorig:Hips_$AssimpFbx$_PreRotation"
constexpr std::string_view kFactorMark = "_$AssimpFbx$_";

// The kind of a factor node ("PreRotation"); empty for the joint itself.
std::string_view FactorKind(const aiNode& node) {
  const std::string_view name(node.mName.C_Str(), node.mName.length);
  const std::size_t at = name.rfind(kFactorMark);
  return at == std::string_view::npos ? std::string_view() : name.substr(at + kFactorMark.size());
}

glm::dmat4 RestMatrix(const aiNode& node) { return glm::dmat4(ToGlm(node.mTransformation)); }

glm::dquat RotationOf(const aiQuaternion& q) {
  const glm::dquat rotation(q.w, q.x, q.y, q.z);
  const double length = glm::length(rotation);
  return length > 1e-6 ? rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

glm::dvec3 Blend(const aiVectorKey& a, const aiVectorKey& b, double share) {
  return glm::mix(glm::dvec3(ToGlm(a.mValue)), glm::dvec3(ToGlm(b.mValue)), share);
}
glm::dquat Blend(const aiQuatKey& a, const aiQuatKey& b, double share) {
  return glm::slerp(RotationOf(a.mValue), RotationOf(b.mValue), share);
}

template <class Value, class Key>
Value Sample(const Key* keys, unsigned count, double ticks, const Value& without_keys) {
  if (count == 0) return without_keys;
  const Key* end = keys + count;
  const Key* next = std::upper_bound(keys, end, ticks,
                                     [](double time, const Key& key) { return time < key.mTime; });
  if (next == keys) return Blend(*next, *next, 0.0);
  if (next == end) return Blend(*(end - 1), *(end - 1), 0.0);
  const Key& last = *(next - 1);
  return Blend(last, *next, (ticks - last.mTime) / (next->mTime - last.mTime));
}

glm::bvec3 AxesWithout(const aiVectorKey* keys, unsigned count, float value) {
  glm::bvec3 result(count > 0);
  for (unsigned k = 0; k < count; ++k) {
    for (unsigned axis = 0; axis < 3; ++axis)
      result[static_cast<int>(axis)] =
          result[static_cast<int>(axis)] && keys[k].mValue[axis] == value;
  }
  return result;
}

template <class Key>
Status CheckKeys(const Key* keys, unsigned count, const std::string& name) {
  for (unsigned k = 0; k < count; ++k) {
    if (!std::isfinite(keys[k].mTime)) {
      return {StatusCode::kNonFinite, "a key of joint '" + name + "' has no finite time"};
    }
    if (k > 0 && !(keys[k].mTime >= keys[k - 1].mTime)) {
      return {StatusCode::kSchema, "the keys of joint '" + name + "' are not in order"};
    }
  }
  return {};
}

// Values that differ from 1 only by rounding would give every joint a scale track.
gltf::Transform Cleaned(gltf::Transform transform) {
  for (int axis = 0; axis < 3; ++axis) {
    float& scale = transform.scale[axis];
    if (std::abs(scale - 1.0f) < 1e-5f) scale = 1.0f;
    if (std::abs(scale) < 1e-9f) scale = std::copysign(1e-9f, scale);
  }
  return transform;
}

}  // namespace

Result<std::vector<SceneNode>> ListNodes(const aiScene& scene) {
  struct Waiting {
    const aiNode* node;
    int parent;
    std::vector<const aiNode*> factors;
  };
  std::vector<SceneNode> nodes;
  std::vector<Waiting> stack;
  std::size_t seen = 0;
  const auto add_children = [&stack](const aiNode& node, int parent,
                                     const std::vector<const aiNode*>& factors) {
    // Backwards, so that the first child is taken first.
    for (unsigned c = node.mNumChildren; c-- > 0;)
      stack.push_back({node.mChildren[c], parent, factors});
  };
  add_children(*scene.mRootNode, -1, {});
  while (!stack.empty()) {
    Waiting top = std::move(stack.back());
    stack.pop_back();
    if (++seen > gltf::kMaxNodes) {
      return Status(StatusCode::kLimit,
                    "the file has more than " + std::to_string(gltf::kMaxNodes) + " nodes");
    }
    const std::string_view kind = FactorKind(*top.node);
    if (!kind.starts_with("Geometric")) top.factors.push_back(top.node);
    if (!kind.empty()) {
      add_children(*top.node, top.parent, top.factors);
      continue;
    }
    const int index = static_cast<int>(nodes.size());
    nodes.push_back({top.node->mName.C_Str(), top.parent, std::move(top.factors)});
    add_children(*top.node, index, {});
  }
  return nodes;
}

gltf::Transform RestOf(const SceneNode& node) {
  glm::dmat4 local(1.0);
  for (const aiNode* factor : node.factors) local *= RestMatrix(*factor);
  return Cleaned(gltf::Decompose(local).transform);
}

NodeMotion::Factor NodeMotion::FactorOf(const aiNode& node, const aiNodeAnim* channel) {
  const glm::dmat4 rest = RestMatrix(node);
  Factor factor = {rest, gltf::Decompose(rest).transform, channel};
  if (channel == nullptr || FactorKind(node).empty()) return factor;
  factor.unmoved_position = AxesWithout(channel->mPositionKeys, channel->mNumPositionKeys, 0.0f);
  factor.unmoved_scale = AxesWithout(channel->mScalingKeys, channel->mNumScalingKeys, 1.0f);
  return factor;
}

NodeMotion::NodeMotion(const SceneNode& node, const std::vector<const aiNodeAnim*>& channels) {
  const std::size_t last = node.factors.size() - 1;
  if (last == 0 || channels[last] == nullptr) {
    for (std::size_t f = 0; f <= last; ++f)
      factors_.push_back(FactorOf(*node.factors[f], channels[f]));
    return;
  }
  // assimp 5.2: joints with T, R, S, Rpre and Rpost alone have one channel, for the joint itself.
  // It holds T, Rpre * R * Rpost and S, so it replaces the factors. They are not to be applied once
  // more; this is how assimp's own exporter bends Mixamo's legs upwards. FBX means Rpost^-1.
  factors_.push_back(FactorOf(*node.factors[last], channels[last]));
  for (const aiNode* factor : node.factors) {
    if (FactorKind(*factor) != "PostRotation") continue;
    const glm::dquat inverse = glm::quat_cast(glm::dmat3(RestMatrix(*factor)));
    after_ = inverse * inverse;
  }
}

gltf::Transform NodeMotion::At(double ticks) const {
  glm::dmat4 local(1.0);
  for (const Factor& factor : factors_) {
    if (factor.channel == nullptr) {
      local *= factor.rest;
      continue;
    }
    const gltf::Transform& rest = factor.parts;
    const aiNodeAnim& channel = *factor.channel;
    glm::dvec3 position = Sample(channel.mPositionKeys, channel.mNumPositionKeys, ticks,
                                 glm::dvec3(rest.translation));
    glm::dvec3 scale =
        Sample(channel.mScalingKeys, channel.mNumScalingKeys, ticks, glm::dvec3(rest.scale));
    position = glm::mix(position, glm::dvec3(rest.translation), factor.unmoved_position);
    scale = glm::mix(scale, glm::dvec3(rest.scale), factor.unmoved_scale);
    const glm::dquat rotation =
        Sample(channel.mRotationKeys, channel.mNumRotationKeys, ticks, glm::dquat(rest.rotation)) *
        after_;
    if (factors_.size() == 1) {  // nothing to multiply, so nothing to round
      return Cleaned({glm::vec3(position), glm::normalize(glm::quat(rotation)), glm::vec3(scale)});
    }
    local *= glm::translate(glm::dmat4(1.0), position) * glm::mat4_cast(rotation) *
             glm::scale(glm::dmat4(1.0), scale);
  }
  return Cleaned(gltf::Decompose(local).transform);
}

Status CheckChannel(const aiNodeAnim& channel) {
  const std::string name = OneLine(channel.mNodeName.C_Str());
  FURROW_RETURN_IF_ERROR(CheckKeys(channel.mPositionKeys, channel.mNumPositionKeys, name));
  FURROW_RETURN_IF_ERROR(CheckKeys(channel.mRotationKeys, channel.mNumRotationKeys, name));
  return CheckKeys(channel.mScalingKeys, channel.mNumScalingKeys, name);
}

}  // namespace furrow::authoring
