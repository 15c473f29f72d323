// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/clip_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "authoring/assimp/frame_times.h"
#include "authoring/assimp/pivots.h"
#include "authoring/assimp/scene_file.h"
#include "authoring/assimp/scene_shapes.h"
#include "base/text.h"
#include "gltf/scene/transform.h"
#include "motion/clip/limits.h"

namespace furrow::authoring {
namespace {

double TicksPerSecond(const aiAnimation& animation) {
  return animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 1.0;
}

// assimp does not count the keys of blend shapes.
double SecondsOf(const aiAnimation& animation) {
  const double ticks = animation.mDuration > 0.0 ? animation.mDuration : LastShapeKey(animation);
  return ticks / TicksPerSecond(animation);
}

std::string NameOf(const aiAnimation& animation) { return OneLine(animation.mName.C_Str()); }

std::string ListOf(const std::vector<motion::AnimationInfo>& animations) {
  static constexpr std::size_t kNamed = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(animations.size(), kNamed); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(i) + " " + Quoted(animations[i].name);
  return text + (animations.size() > kNamed ? ", ..." : "");
}

// The index of the chosen animation. Names go first: an animation may be called "1".
Result<std::size_t> Choose(const std::vector<motion::AnimationInfo>& animations,
                           const std::string& choice) {
  if (choice.empty()) return std::size_t{0};
  for (std::size_t i = 0; i < animations.size(); ++i)
    if (animations[i].name == choice) return i;
  const bool is_index = choice.size() < 6 && choice.find_first_not_of("0123456789") == choice.npos;
  if (is_index && std::stoul(choice) < animations.size()) return std::stoul(choice);
  return Status(StatusCode::kNotFound, "the file has no animation " + Quoted(choice), {},
                "animations: " + ListOf(animations));
}

// Joins the parts of one performance: Collada files often have an animation per joint, which assimp
// joins only if all have the same duration.
bool IsOneInParts(const aiScene& scene) {
  std::unordered_set<std::string> nodes;
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& part = *scene.mAnimations[a];
    if (part.mNumChannels != 1 || !nodes.insert(part.mChannels[0]->mNodeName.C_Str()).second)
      return false;
  }
  return scene.mNumAnimations > 1;
}

class ClipReader {
 public:
  ClipReader(const aiScene& scene, motion::ClipReport* report) : scene_(scene), report_(*report) {}

  Result<motion::Clip> Run(const std::string& choice) {
    FURROW_RETURN_IF_ERROR(ChooseParts(choice));
    Result<std::vector<SceneNode>> nodes = ListNodes(scene_);
    FURROW_RETURN_IF_ERROR(nodes);
    nodes_ = std::move(*nodes);
    FURROW_RETURN_IF_ERROR(ListChannels());
    ChooseJoints();
    FindSpace();
    FURROW_RETURN_IF_ERROR(BuildSkeleton());
    FURROW_RETURN_IF_ERROR(ListShapes());
    FURROW_RETURN_IF_ERROR(ListTimes());
    return Sample();
  }

 private:
  // The parts of the chosen animation share their unit of time.
  Status ChooseParts(const std::string& choice) {
    for (unsigned a = 0; a < scene_.mNumAnimations; ++a) {
      const aiAnimation& animation = *scene_.mAnimations[a];
      report_.animations.push_back({NameOf(animation), SecondsOf(animation)});
    }
    if (scene_.mNumAnimations == 0) {
      return {StatusCode::kSchema,
              "the file has no animation",
              {},
              "export it with its animation, baked to keys"};
    }
    const bool in_parts = IsOneInParts(scene_);
    if (in_parts) report_.animations.resize(1);
    const Result<std::size_t> chosen = Choose(report_.animations, choice);
    FURROW_RETURN_IF_ERROR(chosen);
    for (unsigned a = 0; a < scene_.mNumAnimations; ++a)
      if (in_parts || a == *chosen) parts_.push_back(scene_.mAnimations[a]);
    clip_.name = NameOf(*parts_.front());
    if (choice.empty() && report_.animations.size() > 1) {
      report_.warnings.push_back("the file has " + Counted(report_.animations.size(), "animation") +
                                 "; reading the first of " + ListOf(report_.animations) +
                                 " (choose another with FILE#NAME or FILE#INDEX)");
    }
    return {};
  }

  Status ListChannels() {
    for (const aiAnimation* part : parts_) {
      for (unsigned c = 0; c < part->mNumChannels; ++c) {
        const aiNodeAnim& channel = *part->mChannels[c];
        FURROW_RETURN_IF_ERROR(CheckChannel(channel));
        channel_by_name_.emplace(channel.mNodeName.C_Str(), Channel{&channel, part});
      }
    }
    return {};
  }

  struct Channel {
    const aiNodeAnim* keys = nullptr;
    const aiAnimation* part = nullptr;
  };

  [[nodiscard]] Channel ChannelOf(const aiNode& node) const {
    const auto found = channel_by_name_.find(node.mName.C_Str());
    return found == channel_by_name_.end() ? Channel{} : found->second;
  }

  [[nodiscard]] std::vector<const aiNodeAnim*> ChannelsOf(const SceneNode& node) const {
    std::vector<const aiNodeAnim*> channels;
    for (const aiNode* factor : node.factors) channels.push_back(ChannelOf(*factor).keys);
    return channels;
  }

  // Marks the joints among the nodes, as the header describes.
  void ChooseJoints() {
    std::unordered_set<std::string> bones;
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      for (unsigned b = 0; b < scene_.mMeshes[m]->mNumBones; ++b)
        bones.insert(scene_.mMeshes[m]->mBones[b]->mName.C_Str());
    }
    needed_.assign(nodes_.size(), false);
    std::vector<std::size_t> tree(nodes_.size());
    std::vector<bool> tree_moves(nodes_.size(), false);
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      const std::vector<const aiNodeAnim*> channels = ChannelsOf(nodes_[i]);
      const bool moves =
          std::ranges::any_of(channels, [](const aiNodeAnim* c) { return c != nullptr; });
      needed_[i] = needed_[i] || moves || bones.contains(nodes_[i].name);
      if (needed_[i] && nodes_[i].parent >= 0)
        needed_[static_cast<std::size_t>(nodes_[i].parent)] = true;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int parent = nodes_[i].parent;
      tree[i] = parent < 0 ? i : tree[static_cast<std::size_t>(parent)];
      tree_moves[tree[i]] = tree_moves[tree[i]] || needed_[i];
    }
    // A node below a mesh that is left out is left out, too.
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int parent = nodes_[i].parent;
      const bool has_parent = parent < 0 || needed_[static_cast<std::size_t>(parent)];
      const bool is_plain = nodes_[i].factors.back()->mNumMeshes == 0;
      needed_[i] = needed_[i] || (tree_moves[tree[i]] && has_parent && is_plain);
    }
  }

  // Collada states unit and axes as the root's transform, FBX as properties.
  void FindSpace() {
    std::vector<std::string> remarks;  // unused: a conversion to metres needs no warning
    const glm::dmat4 space(wrinkle::ToMatrix(SpaceOf(scene_, &remarks)));
    space_ =
        gltf::Decompose(space * glm::dmat4(ToGlm(scene_.mRootNode->mTransformation))).transform;
    const glm::vec3 scale = space_.scale;
    const bool uniform = std::abs(scale.x - scale.y) < 1e-4f * std::abs(scale.x) &&
                         std::abs(scale.x - scale.z) < 1e-4f * std::abs(scale.x) && scale.x > 0.0f;
    unit_ = uniform ? scale.x : 1.0f;
    if (uniform) space_.scale = glm::vec3(1.0f);
  }

  [[nodiscard]] wrinkle::Transform InSpace(gltf::Transform local, bool is_root) const {
    local.translation *= unit_;
    if (is_root) {
      const glm::dmat4 model = glm::dmat4(gltf::ToMatrix(space_)) * glm::dmat4(ToMatrix(local));
      local = gltf::Decompose(model).transform;
      // Decomposing rounds. A scale of 1 stays 1.
      for (int axis = 0; axis < 3; ++axis)
        if (std::abs(local.scale[axis] - 1.0f) < 1e-5f) local.scale[axis] = 1.0f;
    }
    return {local.translation, local.rotation, local.scale};
  }

  Status BuildSkeleton() {
    std::vector<wrinkle::JointDesc> joints;
    std::vector<int> joint_of_node(nodes_.size(), wrinkle::kNoJoint);
    std::unordered_set<std::string> names;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!needed_[i]) continue;
      const int above = nodes_[i].parent;
      const int parent =
          above < 0 ? wrinkle::kNoJoint : joint_of_node[static_cast<std::size_t>(above)];
      std::string name = OneLine(nodes_[i].name).substr(0, 240);
      if (name.empty()) name = "node_" + std::to_string(i);
      if (!names.insert(name).second) {
        name += "." + std::to_string(i);
        names.insert(name);
      }
      joint_of_node[i] = static_cast<int>(joints.size());
      joint_nodes_.push_back(i);
      joints.push_back({std::move(name), parent,
                        InSpace(RestOf(nodes_[i]), parent == wrinkle::kNoJoint), std::nullopt});
    }
    if (joints.empty()) return {};
    // Parents come before their children, so Create() keeps the order.
    Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
    FURROW_RETURN_IF_ERROR(skeleton);
    clip_.skeleton = std::move(*skeleton);
    return {};
  }

  Status ListShapes() {
    Result<std::vector<ShapeCurve>> curves = ListShapeCurves(scene_, *parts_.front());
    FURROW_RETURN_IF_ERROR(curves);
    shapes_ = std::move(*curves);
    for (const ShapeCurve& curve : shapes_) clip_.blend_shape_names.push_back(curve.name);
    return {};
  }

  static std::vector<double> KeyTimes(const Channel& channel) {
    std::vector<double> times;
    const auto add = [&](const auto* keys, unsigned count) {
      for (unsigned k = 0; count > 1 && k < count; ++k)
        times.push_back(keys[k].mTime / TicksPerSecond(*channel.part));
    };
    add(channel.keys->mPositionKeys, channel.keys->mNumPositionKeys);
    add(channel.keys->mRotationKeys, channel.keys->mNumRotationKeys);
    add(channel.keys->mScalingKeys, channel.keys->mNumScalingKeys);
    return times;
  }

  Status ListTimes() {
    double end = 0.0;
    for (const aiAnimation* part : parts_) end = std::max(end, SecondsOf(*part));
    FrameTimes all;
    for (const auto& [name, channel] : channel_by_name_) all.Add(KeyTimes(channel));
    for (const ShapeCurve& curve : shapes_) {
      std::vector<double> times;
      for (const auto& [ticks, value] : curve.keys)
        times.push_back(ticks / TicksPerSecond(*parts_.front()));
      all.Add(std::move(times));
    }
    clip_.times = all.Finish(end);
    const std::size_t frames = clip_.times.size();
    if (frames > motion::kMaxFrames || frames * joint_nodes_.size() > motion::kMaxTransforms ||
        frames * shapes_.size() > motion::kMaxBlendShapeValues) {
      return {StatusCode::kLimit, "the animation has too many keys: " + Counted(frames, "frame")};
    }
    if (joint_nodes_.empty() && shapes_.empty()) {
      return {StatusCode::kSchema, "the animation moves neither joints nor blend shapes"};
    }
    return {};
  }

  Result<motion::Clip> Sample() {
    std::vector<NodeMotion> motions;
    std::vector<double> rates;  // ticks per second, per joint
    for (const std::size_t node : joint_nodes_) {
      motions.emplace_back(nodes_[node], ChannelsOf(nodes_[node]));
      double rate = TicksPerSecond(*parts_.front());
      for (const aiNode* factor : nodes_[node].factors) {
        if (const Channel channel = ChannelOf(*factor); channel.part != nullptr)
          rate = TicksPerSecond(*channel.part);
      }
      rates.push_back(rate);
    }
    clip_.locals.reserve(clip_.times.size() * motions.size());
    for (const double time : clip_.times) {
      for (std::size_t j = 0; j < motions.size(); ++j) {
        const bool is_root = clip_.skeleton.joint_parents()[j] == wrinkle::kNoJoint;
        clip_.locals.push_back(InSpace(motions[j].At(time * rates[j]), is_root));
      }
      for (const ShapeCurve& curve : shapes_)
        clip_.blend_shapes.push_back(curve.At(time * TicksPerSecond(*parts_.front())));
    }
    if (!std::all_of(clip_.locals.begin(), clip_.locals.end(), wrinkle::IsValid)) {
      return Status(StatusCode::kNonFinite, "the animation leaves the range of a float");
    }
    return std::move(clip_);
  }

  const aiScene& scene_;
  motion::ClipReport& report_;
  std::vector<const aiAnimation*> parts_;
  std::vector<SceneNode> nodes_;
  std::vector<bool> needed_;              // per node: is a joint
  std::vector<std::size_t> joint_nodes_;  // per joint: its node
  std::unordered_map<std::string, Channel> channel_by_name_;
  std::vector<ShapeCurve> shapes_;
  gltf::Transform space_;  // without the scale if it is uniform
  float unit_ = 1.0f;      // metres per unit of length
  motion::Clip clip_;
};

}  // namespace

Result<motion::Clip> ReadClip(const aiScene& scene, const std::string& animation,
                              motion::ClipReport* report) {
  return ClipReader(scene, report).Run(animation);
}

}  // namespace furrow::authoring
