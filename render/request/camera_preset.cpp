// SPDX-License-Identifier: Apache-2.0
#include "render/request/camera_preset.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include "base/joined.h"

namespace furrow::render {
namespace {

using character::Character;
using character::Material;

constexpr float kFovY = 24.0f;  // degrees; about 85 mm on a full-frame camera, a portrait lens
// Angles in degrees from the front towards the subject's left.
constexpr float kThreeQuarter = 38.0f;
constexpr float kFromTheLeft = 90.0f;
constexpr std::array<std::string_view, 9> kNames = {
    "face", "three_quarter",      "profile",   "eyes",     "mouth",
    "body", "body_three_quarter", "body_side", "body_back"};

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};

  void Add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  [[nodiscard]] bool empty() const { return low.x > high.x; }
  [[nodiscard]] glm::vec3 centre() const { return 0.5f * (low + high); }
  [[nodiscard]] glm::vec3 size() const { return high - low; }
};

bool ContainsNoCase(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

// The rig's anchor joint. Without one, the first joint with "head" in its name, if any.
int FindHead(const Character& character) {
  const int anchor = character.skeleton.Find(character.rig.anchor);
  if (anchor != wrinkle::kNoJoint) return anchor;
  const auto names = character.skeleton.joint_names();
  for (std::size_t joint = 0; joint < names.size(); ++joint) {
    if (ContainsNoCase(names[joint], "head")) return static_cast<int>(joint);
  }
  return wrinkle::kNoJoint;
}

// The joint above all joints that move vertices: the hips. Joints above it, such as the node of the
// whole scene, need not move with the body. Joint 0 if there is no such joint, or if the character
// is a head alone; kNoJoint without any joint.
int FindBody(const Character& character, int head) {
  const wrinkle::Skeleton& skeleton = character.skeleton;
  if (skeleton.num_joints() == 0) return wrinkle::kNoJoint;
  int body = wrinkle::kNoJoint;
  for (const character::Mesh& mesh : character.meshes) {
    for (const character::Vertex& vertex : mesh.vertices) {
      for (int i = 0; i < 4; ++i) {
        if (!(vertex.skin_weights[i] > 0.0f)) continue;
        if (body == wrinkle::kNoJoint) body = vertex.joints[i];
        while (!skeleton.IsAncestor(body, vertex.joints[i])) {
          body = skeleton.joint_parents()[body];
          if (body == wrinkle::kNoJoint) return 0;
        }
      }
    }
  }
  const bool is_in_head = head != wrinkle::kNoJoint && skeleton.IsAncestor(head, body);
  return body == wrinkle::kNoJoint || is_in_head ? 0 : body;
}

// Bounds of the vertices with most of their skin weight on joints that `accept_joint` accepts, on
// materials that `accept_kind` accepts.
template <class AcceptKind, class AcceptJoint>
Bounds BoundsOf(const Character& character, const AcceptKind& accept_kind,
                const AcceptJoint& accept_joint) {
  Bounds bounds;
  for (const character::Mesh& mesh : character.meshes) {
    if (!accept_kind(character.materials[static_cast<std::size_t>(mesh.material)].kind)) continue;
    for (const character::Vertex& vertex : mesh.vertices) {
      float sum = 0.0f;
      for (int i = 0; i < 4; ++i) {
        if (accept_joint(vertex.joints[i])) sum += vertex.skin_weights[i];
      }
      if (sum > 0.5f) bounds.Add(vertex.position);
    }
  }
  return bounds;
}

// The mean rest-pose tail of the joints with one of `words` in their name. A tail is the end of a
// virtual muscle. nullopt: no such joint.
std::optional<glm::vec3> MeanTail(const Character& character,
                                  std::span<const std::string_view> words) {
  const wrinkle::Skeleton& skeleton = character.skeleton;
  glm::vec3 sum(0.0f);
  int count = 0;
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    const auto holds = [&](std::string_view word) {
      return ContainsNoCase(skeleton.joint_names()[joint], word);
    };
    if (std::none_of(words.begin(), words.end(), holds)) continue;
    sum += glm::vec3(skeleton.rest_model()[joint] * glm::vec4(skeleton.tails()[joint], 1.0f));
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<float>(count);
}

// A camera that shows `height` metres, vertically and horizontally, around `target`, seen from
// `azimuth` degrees towards the subject's left. `depth`: how far the subject reaches from the
// target towards the camera, metres.
Camera Frame(const glm::vec3& target, float height, float depth, float azimuth, int follow_joint) {
  Camera camera;
  camera.target = target;
  camera.fov_y_degrees = kFovY;
  camera.fit_shorter_side = true;
  camera.follow_joint = follow_joint;
  const float distance = 0.5f * height / std::tan(glm::radians(0.5f * kFovY)) + depth;
  const float angle = glm::radians(azimuth);
  camera.position = target + distance * glm::vec3(std::sin(angle), 0.0f, std::cos(angle));
  return camera;
}

// The head without hair and clothes; the whole character if no vertex belongs to the head joint; a
// point if there are no vertices. The presets therefore work for any mesh.
Bounds HeadBounds(const Character& character, int head) {
  const auto in_head = [&](int joint) {
    return head == wrinkle::kNoJoint || character.skeleton.IsAncestor(head, joint);
  };
  const auto no_hair_no_cloth = [](Material::Kind kind) {
    return kind != Material::Kind::kHair && kind != Material::Kind::kCloth;
  };
  Bounds bounds = BoundsOf(character, no_hair_no_cloth, in_head);
  if (bounds.empty())
    bounds = BoundsOf(
        character, [](auto) { return true; }, [](int) { return true; });
  if (bounds.empty()) bounds.Add(glm::vec3(0.0f));
  return bounds;
}

// The largest dimension counts, so a turned view shows the same head at the same size.
Camera HeadPreset(const Bounds& head, int joint, float azimuth) {
  const glm::vec3 size = head.size();
  const float radius = 0.5f * std::max(size.x, size.z);
  const float height = 1.18f * std::max({size.y, size.x, size.z, 1e-3f});
  return Frame(head.centre(), height, 0.6f * radius, azimuth, joint);
}

// A part of the face, `height` head heights tall, at `point`. Without a point, at `fraction` of the
// head's height.
Camera DetailPreset(const Bounds& head, int joint, std::optional<glm::vec3> point, float fraction,
                    float height) {
  glm::vec3 target = head.centre();
  target.y = point ? point->y : head.low.y + fraction * head.size().y;
  target.y = std::clamp(target.y, head.low.y, head.high.y);
  target.z = head.high.z;
  return Frame(target, height * std::max(head.size().y, 1e-3f), 0.0f, 0.0f, joint);
}

std::optional<glm::vec3> EyePoint(const Character& character) {
  const Bounds eyes = BoundsOf(
      character, [](Material::Kind kind) { return kind == Material::Kind::kEye; },
      [](int) { return true; });
  if (!eyes.empty()) return eyes.centre();
  return MeanTail(character, std::array<std::string_view, 1>{"eye"});
}

// The whole body from `azimuth` degrees. The height of the body determines the distance: a
// portrait-format picture shows people who stand or walk, but cuts off the hands of arms stretched
// sideways.
Camera BodyPreset(const Character& character, int body, float azimuth) {
  Bounds all = BoundsOf(
      character, [](auto) { return true; }, [](int) { return true; });
  if (all.empty()) all.Add(glm::vec3(0.0f));
  const glm::vec3 size = all.size();
  const float height = 1.04f * std::max({size.x, size.y, 1e-3f});
  Camera camera = Frame(all.centre(), height, 0.5f * size.z, azimuth, body);
  camera.fit_shorter_side = false;
  return camera;
}

}  // namespace

std::span<const std::string_view> CameraPresetNames() { return kNames; }

std::vector<std::pair<std::string, Camera>> CameraPresets(const Character& character) {
  const int joint = FindHead(character);
  const int body = FindBody(character, joint);
  const Bounds head = HeadBounds(character, joint);
  const std::array<std::string_view, 3> mouth{"oris", "mouth", "lip"};
  const std::array<Camera, kNames.size()> cameras = {
      HeadPreset(head, joint, 0.0f),
      HeadPreset(head, joint, kThreeQuarter),
      HeadPreset(head, joint, kFromTheLeft),
      DetailPreset(head, joint, EyePoint(character), 0.55f, 0.42f),
      DetailPreset(head, joint, MeanTail(character, mouth), 0.22f, 0.42f),
      BodyPreset(character, body, 0.0f),
      BodyPreset(character, body, kThreeQuarter),
      BodyPreset(character, body, kFromTheLeft),
      BodyPreset(character, body, 180.0f)};
  std::vector<std::pair<std::string, Camera>> presets;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    presets.emplace_back(kNames[i], cameras[i]);
    presets.back().second.turn_joint = body;
  }
  return presets;
}

Status UnknownPreset(std::string_view name) {
  return {StatusCode::kInvalidArgument, "no camera preset '" + std::string(name) + "'", "camera",
          "one of " + ListCameraPresets()};
}

std::string ListCameraPresets() { return Joined(kNames); }

}  // namespace furrow::render
