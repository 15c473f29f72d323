// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/body/body_skeleton.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

struct Entry {
  const char* name;  // "*" stands for "_l" and "_r"
  const char* parent;
  vec3 place;  // body: metres; face: head space. The left one of a pair.
};

const Entry kBody[] = {
    {"hips", "", {0, 0.95f, 0}},
    {"spine", "hips", {0, 1.06f, -0.005f}},
    {"chest", "spine", {0, 1.22f, -0.01f}},
    {"neck", "chest", {0, 1.475f, -0.03f}},
    {"head", "neck", {0, 1.585f, 0.0f}},
    {"shoulder*", "chest", {0.03f, 1.425f, -0.01f}},
    {"upper_arm*", "shoulder*", {0.175f, 1.425f, -0.015f}},
    {"lower_arm*", "upper_arm*", {0.455f, 1.425f, -0.02f}},
    {"hand*", "lower_arm*", {0.705f, 1.425f, -0.015f}},
    {"upper_leg*", "hips", {0.092f, 0.91f, 0}},
    {"lower_leg*", "upper_leg*", {0.095f, 0.495f, 0.005f}},
    {"foot*", "lower_leg*", {0.1f, 0.085f, -0.02f}},
    {"toes*", "foot*", {0.105f, 0.022f, 0.115f}},
};

// The fingers of a stretched hand, palm down, slightly bent. The last position is the tip.
struct Finger {
  const char* joints[3];
  vec3 places[4];
};

const Finger kHand[] = {
    {{"thumb_metacarpal*", "thumb_proximal*", "thumb_distal*"},
     {{0.727f, 1.416f, 0.008f},
      {0.759f, 1.404f, 0.038f},
      {0.785f, 1.399f, 0.056f},
      {0.810f, 1.397f, 0.070f}}},
    {{"index_proximal*", "index_intermediate*", "index_distal*"},
     {{0.793f, 1.4265f, 0.011f},
      {0.836f, 1.4225f, 0.0135f},
      {0.860f, 1.4165f, 0.0148f},
      {0.880f, 1.4090f, 0.0158f}}},
    {{"middle_proximal*", "middle_intermediate*", "middle_distal*"},
     {{0.797f, 1.4285f, -0.011f},
      {0.844f, 1.4240f, -0.0112f},
      {0.871f, 1.4170f, -0.0113f},
      {0.892f, 1.4085f, -0.0113f}}},
    {{"ring_proximal*", "ring_intermediate*", "ring_distal*"},
     {{0.790f, 1.4265f, -0.032f},
      {0.833f, 1.4220f, -0.0345f},
      {0.858f, 1.4150f, -0.0360f},
      {0.878f, 1.4070f, -0.0370f}}},
    {{"little_proximal*", "little_intermediate*", "little_distal*"},
     {{0.781f, 1.4225f, -0.0515f},
      {0.8145f, 1.4180f, -0.0580f},
      {0.8335f, 1.4120f, -0.0620f},
      {0.8505f, 1.4050f, -0.0655f}}},
};

const Entry kFace[] = {
    {"jaw", "head", {0, -3.6f, 0.6f}},
    {"frontalis_inner*", "head", {1.6f, 2.3f, 9.0f}},
    {"frontalis_outer*", "head", {4.3f, 2.5f, 7.4f}},
    {"corrugator*", "head", {0.95f, 1.7f, 9.2f}},
    {"orbicularis_oculi_upper*", "head", kEyeCentre},
    {"orbicularis_oculi_lower*", "head", {3.3f, -1.15f, 8.2f}},
    {"eye*", "head", kEyeCentre},
    {"nasalis*", "head", {1.25f, -3.6f, 9.7f}},
    {"levator*", "head", {1.75f, -5.5f, 9.2f}},
    {"zygomaticus*", "head", {4.2f, -3.2f, 7.4f}},
    {"risorius*", "head", {2.7f, -6.95f, 8.5f}},
    {"orbicularis_oris_upper*", "head", {0.95f, -6.45f, 9.8f}},
    {"orbicularis_oris_lower*", "jaw", {0.95f, -7.5f, 9.6f}},
    {"depressor*", "jaw", {2.6f, -8.4f, 8.2f}},
    {"mentalis", "jaw", {0, -9.6f, 9.2f}},
    {"platysma*", "neck", {3.0f, -13.0f, 2.4f}},
};

// The name with a suffix in place of the star.
std::string Named(const std::string& pattern, const char* suffix) {
  const std::size_t star = pattern.find('*');
  return star == std::string::npos ? pattern : pattern.substr(0, star) + suffix;
}

// Adds one joint, or the left and right one of a pair, after its parent.
void Append(const Entry& entry, bool face, std::vector<JointPlace>* places) {
  const vec3 place = face ? HeadToModel(entry.place) : entry.place;
  const std::string name = entry.name;
  if (name.find('*') == std::string::npos) {
    places->push_back({name, entry.parent, place});
    return;
  }
  for (const auto& [suffix, side] : {std::pair("_l", 1.0f), std::pair("_r", -1.0f)}) {
    vec3 at(place.x * side, place.y, place.z);
    // The eyes are not mirror images of each other; see EyeCentre().
    if (name == "eye*" || name == "orbicularis_oculi_upper*") at = HeadToModel(EyeCentre(side));
    places->push_back({Named(name, suffix), Named(entry.parent, suffix), at});
  }
}

// Tails of leaf joints relative to the joint, metres.
std::optional<vec3> Tail(const std::string& name) {
  const float side = name.ends_with("_r") ? -1.0f : 1.0f;
  if (name.starts_with("hand_")) return vec3(side * 0.09f, 0, 0);
  for (const Finger& finger : kHand) {
    const std::string last = finger.joints[2];
    if (name.starts_with(last.substr(0, last.size() - 1))) {
      const vec3 tip = finger.places[3] - finger.places[2];
      return vec3(side * tip.x, tip.y, tip.z);
    }
  }
  if (name.starts_with("toes_")) return vec3(0, 0, 0.08f);
  if (name.starts_with("eye_") || name.starts_with("orbicularis_oculi_upper")) {
    return vec3(0, 0, 0.0135f);
  }
  return std::nullopt;
}

}  // namespace

std::vector<JointPlace> JointPlaces() {
  std::vector<JointPlace> places;
  for (const Entry& entry : kBody) Append(entry, false, &places);
  for (const Finger& finger : kHand) {
    for (int i = 0; i < 3; ++i) {
      const char* parent = i > 0 ? finger.joints[i - 1] : "hand*";
      Append({finger.joints[i], parent, finger.places[i]}, false, &places);
    }
  }
  for (const Entry& entry : kFace) Append(entry, true, &places);
  return places;
}

wrinkle::Skeleton MakeSkeleton() {
  const std::vector<JointPlace> places = JointPlaces();
  std::vector<wrinkle::JointDesc> joints;
  for (const JointPlace& place : places) {
    wrinkle::JointDesc joint;
    joint.name = place.name;
    joint.rest.translation = place.place;
    const auto parent = std::find_if(places.begin(), places.end(),
                                     [&](const JointPlace& p) { return p.name == place.parent; });
    if (parent != places.end()) {
      joint.parent = static_cast<int>(parent - places.begin());
      joint.rest.translation = place.place - parent->place;
    }
    joint.tail = Tail(place.name);
    joints.push_back(std::move(joint));
  }
  // The table above is a tree of valid size, so Create() cannot fail; a test checks that.
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
  return skeleton.ok() ? std::move(skeleton).value() : wrinkle::Skeleton();
}

}  // namespace furrow::authoring
