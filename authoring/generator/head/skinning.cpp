// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/skinning.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/skinning/influences.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// Adds up the weights of a vertex by the names of joints. Unknown joints are ignored.
class Weights {
 public:
  explicit Weights(const wrinkle::Skeleton& skeleton) : skeleton_(skeleton) {}

  void Add(const std::string& joint, float weight) {
    const int index = skeleton_.Find(joint);
    if (index >= 0) sum_.Add(static_cast<std::uint16_t>(index), weight);
  }
  void Store(character::Vertex* vertex) const { sum_.Strongest().CopyTo(vertex); }

 private:
  const wrinkle::Skeleton& skeleton_;
  InfluenceSum sum_;
};

// The influence of a muscle: full at its centre, zero beyond its radii (head space, left side).
struct Muscle {
  const char* name;  // "*" stands for the side
  vec3 centre;
  vec3 radii;
  float strength;
  int lip;  // +1 upper lip only, -1 lower lip only, 0 both
};

const Muscle kMuscles[] = {
    {"frontalis_inner*", {1.5f, 2.6f, 9.0f}, {2.5f, 3.0f, 3.0f}, 0.85f, 0},
    {"frontalis_outer*", {4.5f, 2.7f, 7.2f}, {2.6f, 3.0f, 3.5f}, 0.85f, 0},
    {"corrugator*", {0.95f, 1.6f, 9.2f}, {1.5f, 1.4f, 2.0f}, 0.7f, 0},
    {"orbicularis_oculi_lower*", {3.3f, -1.0f, 8.2f}, {2.3f, 1.15f, 2.2f}, 0.8f, 0},
    // The root of the nose gives way with the brow, so that the brow makes no shelf above it.
    {"corrugator*", {0.3f, 0.8f, 9.2f}, {1.0f, 2.8f, 1.7f}, 0.36f, 0},
    {"nasalis*", {1.2f, -3.4f, 9.6f}, {1.35f, 1.9f, 2.0f}, 0.75f, 0},
    {"levator*", {1.7f, -5.4f, 9.2f}, {1.5f, 1.35f, 2.0f}, 0.75f, 1},
    {"zygomaticus*", {4.2f, -3.3f, 7.2f}, {2.4f, 2.3f, 3.0f}, 0.85f, 0},
    {"risorius*", {2.75f, -6.95f, 8.5f}, {2.4f, 1.9f, 2.8f}, 1.0f, 0},
    {"orbicularis_oris_upper*", {0.9f, -6.5f, 9.8f}, {1.6f, 0.95f, 1.8f}, 0.95f, 1},
    {"orbicularis_oris_lower*", {0.9f, -7.6f, 9.6f}, {1.7f, 1.5f, 1.9f}, 0.95f, -1},
    {"depressor*", {2.7f, -8.5f, 8.2f}, {1.7f, 1.6f, 2.4f}, 0.7f, -1},
    {"mentalis", {0.0f, -9.6f, 9.2f}, {2.1f, 1.8f, 2.2f}, 0.8f, -1},
    {"platysma*", {3.2f, -13.0f, 2.4f}, {3.0f, 3.2f, 3.5f}, 0.7f, 0},
};

// Smooth at the centre and at the border, so that neither shows when the muscle moves.
float Field(const Muscle& muscle, const vec3& p, float side) {
  const vec3 centre(muscle.centre.x * side, muscle.centre.y, muscle.centre.z);
  const float d = glm::length((p - centre) / muscle.radii);
  const float fall = std::max(0.0f, 1.0f - d * d);
  return muscle.strength * fall * fall * (3.0f - 2.0f * fall);
}

// The weight of the neck relative to the head.
float NeckShare(const vec3& p) {
  const float top = -4.0f - 7.5f * Smoothstep(-3.0f, 5.0f, p.z);
  return Smoothstep(top, top - 6.0f, p.y);
}

// Skin follows the jaw gradually. Lips follow it or the skull alone, so that the mouth can open.
float JawShare(const HeadVertex& v) {
  const vec3& p = v.place;
  // The border runs from the corner of the mouth to the joint of the jaw.
  const float border = -3.6f - 3.35f * std::clamp((p.z - 0.6f) / 8.0f, 0.0f, 1.2f);
  const float soft = Smoothstep(1.0f, -1.6f, p.y - border) * Smoothstep(-1.5f, 1.5f, p.z);
  const float hard = v.mouth_side < 0.0f ? 1.0f : (v.mouth_side > 0.0f ? 0.0f : 0.5f);
  const float lips = Smoothstep(3.3f, 2.0f, std::abs(p.x)) * Smoothstep(1.0f, 3.0f, p.z);
  return soft + (hard - soft) * lips;
}

// How far the vertex belongs to the upper lid: 1 at its edge, 0 at the brow and at both corners.
float UpperLid(const HeadVertex& v, float side) {
  const vec3 d = v.place - EyeCentre(side);
  if (v.eye_side <= 0.0f || d.z < -0.2f) return 0.0f;
  const float across = std::max(0.0f, 1.0f - d.x * d.x / (1.62f * 1.62f));
  return Smoothstep(1.3f, 0.62f, d.y) * std::sqrt(across);
}

// How much a vertex belongs to the rims of the mouth, which are weighted along the lips' own curve.
float LipZone(const HeadVertex& v) {
  if (v.mouth_side == 0.0f && std::abs(v.place.x) < 0.9f * kMouthCornerX) return 0.0f;
  const float d = std::abs(v.place.y - kMouthY) / (v.mouth_side > 0.0f ? 1.55f : 1.5f);
  const float x = std::abs(v.place.x) / kMouthCornerX;
  return Smoothstep(1.0f, 0.25f, d) * Smoothstep(1.35f, 1.0f, x) *
         Smoothstep(4.0f, 6.0f, v.place.z);
}

struct NamedField {
  std::string joint;
  float weight;
};

// The muscles that move a vertex, without those of the other lip and the other lid.
std::vector<NamedField> MuscleFields(const HeadVertex& v) {
  std::vector<NamedField> fields;
  for (const Muscle& muscle : kMuscles) {
    const std::string name = muscle.name;
    if (muscle.lip != 0 && static_cast<float>(muscle.lip) * v.mouth_side < 0.0f) continue;
    if (name.starts_with("orbicularis_oculi_lower") && v.eye_side > 0.0f) continue;
    const std::size_t star = name.find('*');
    for (const float side : {1.0f, -1.0f}) {
      if (star == std::string::npos && side < 0.0f) continue;
      float field = Field(muscle, v.place, side);
      if (field <= 0.0f) continue;
      const char* end = side > 0.0f ? "_l" : "_r";
      fields.push_back({star == std::string::npos ? name : name.substr(0, star) + end, field});
    }
  }
  return fields;
}

// The middle of a lip follows orbicularis oris, the corner follows risorius. Between them the
// weight changes along a parabola, so that a smile is an arc and not a box.
void WeighLips(const HeadVertex& v, float share, Weights* weights) {
  const float x = v.place.x / kMouthCornerX;
  const float corner = std::pow(std::min(std::abs(x), 1.0f), 2.6f);
  const float left = Smoothstep(-0.35f, 0.35f, x);
  const std::string oris =
      v.mouth_side < 0.0f ? "orbicularis_oris_lower" : "orbicularis_oris_upper";
  weights->Add(oris + "_l", share * (1.0f - corner) * left);
  weights->Add(oris + "_r", share * (1.0f - corner) * (1.0f - left));
  weights->Add(x > 0.0f ? "risorius_l" : "risorius_r", share * corner);
}

// Face and neck. Lids come first, then lips and muscles; chest, neck and jaw share the rest.
void WeighSkin(const HeadVertex& v, Weights* weights) {
  float rest = 1.0f;
  // Takes a share of what is left, so the weights always sum to 1.
  const auto take = [&](const std::string& joint, float share) {
    weights->Add(joint, rest * share);
    rest *= 1.0f - share;
  };
  const bool left = v.place.x >= 0.0f;
  take(left ? "orbicularis_oculi_upper_l" : "orbicularis_oculi_upper_r",
       UpperLid(v, left ? 1.0f : -1.0f));
  // Deep inside the mouth nothing follows the face's muscles.
  const float hold = v.part == kMouthInside ? Smoothstep(5.5f, 8.5f, v.place.z) : 1.0f;
  const float lips = hold * LipZone(v);
  WeighLips(v, rest * lips, weights);
  rest *= 1.0f - lips;
  const std::vector<NamedField> fields = MuscleFields(v);
  float sum = 0.0f;
  for (const NamedField& field : fields) sum += hold * field.weight;
  const float scale = rest * hold / std::max(sum, 1.0f);
  for (const NamedField& field : fields) weights->Add(field.joint, field.weight * scale);
  rest *= std::max(0.0f, 1.0f - sum);
  take("chest", Smoothstep(-15.5f, -20.0f, v.place.y));
  take("neck", NeckShare(v.place));
  take("jaw", JawShare(v));
  weights->Add("head", rest);
}

void SkinHeadVertex(const wrinkle::Skeleton& skeleton, const HeadVertex& v,
                    character::Vertex* vertex) {
  Weights weights(skeleton);
  switch (v.part) {
    case kEyeball: weights.Add(v.place.x >= 0.0f ? "eye_l" : "eye_r", 1.0f); break;
    case kHairCap:
    case kEar: weights.Add("head", 1.0f); break;
    case kTeeth: weights.Add(v.mouth_side < 0.0f ? "jaw" : "head", 1.0f); break;
    case kLash: {
      HeadVertex lid = v;
      lid.place = v.root;
      WeighSkin(lid, &weights);
      break;
    }
    default: WeighSkin(v, &weights); break;
  }
  weights.Store(vertex);
}

}  // namespace

void SkinHead(const wrinkle::Skeleton& skeleton, HeadMesh* head) {
  for (std::size_t i = 0; i < head->info.size(); ++i) {
    SkinHeadVertex(skeleton, head->info[i], &head->mesh.vertices[i]);
  }
}

}  // namespace furrow::authoring
