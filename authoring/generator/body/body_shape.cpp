// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/body/body_shape.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::mat4;
using glm::vec3;

constexpr float kShoulderDrop = 4.0f;  // degrees, in the modelling pose
constexpr float kArmDrop = 42.0f;

// Metres: height, half width, front, back, x, z. The shirt is tucked in and loose above the belt.
constexpr Section kTorso[] = {
    {0.960f, 0.146f, 0.100f, 0.103f, 0, 0.000f},  {1.020f, 0.147f, 0.103f, 0.103f, 0, 0.000f},
    {1.040f, 0.150f, 0.107f, 0.106f, 0, 0.000f},  {1.056f, 0.161f, 0.119f, 0.114f, 0, 0.000f},
    {1.080f, 0.164f, 0.121f, 0.113f, 0, 0.000f},  {1.120f, 0.161f, 0.117f, 0.109f, 0, 0.001f},
    {1.180f, 0.161f, 0.117f, 0.111f, 0, 0.001f},  {1.240f, 0.167f, 0.122f, 0.118f, 0, -0.002f},
    {1.300f, 0.172f, 0.126f, 0.124f, 0, -0.007f}, {1.345f, 0.170f, 0.121f, 0.126f, 0, -0.013f},
    {1.385f, 0.158f, 0.106f, 0.119f, 0, -0.020f}, {1.420f, 0.134f, 0.085f, 0.102f, 0, -0.026f},
    {1.450f, 0.100f, 0.066f, 0.083f, 0, -0.030f}, {1.475f, 0.070f, 0.056f, 0.066f, 0, -0.032f}};

constexpr Section kPelvis[] = {
    {1.045f, 0.153f, 0.112f, 0.109f, 0, 0.000f},  {1.000f, 0.157f, 0.112f, 0.114f, 0, 0.000f},
    {0.960f, 0.164f, 0.112f, 0.124f, 0, 0.000f},  {0.920f, 0.171f, 0.110f, 0.132f, 0, 0.000f},
    {0.880f, 0.173f, 0.107f, 0.131f, 0, 0.000f},  {0.845f, 0.165f, 0.098f, 0.118f, 0, -0.002f},
    {0.815f, 0.140f, 0.078f, 0.088f, 0, -0.004f}, {0.795f, 0.100f, 0.045f, 0.050f, 0, -0.006f}};

constexpr Section kLeg[] = {{0.920f, 0.080f, 0.100f, 0.118f, 0.090f, 0.000f},
                            {0.850f, 0.087f, 0.099f, 0.112f, 0.091f, 0.000f},
                            {0.780f, 0.0855f, 0.094f, 0.099f, 0.0925f, 0.001f},
                            {0.700f, 0.080f, 0.088f, 0.089f, 0.094f, 0.003f},
                            {0.620f, 0.074f, 0.081f, 0.081f, 0.095f, 0.004f},
                            {0.550f, 0.0690f, 0.076f, 0.074f, 0.0955f, 0.006f},
                            {0.495f, 0.0665f, 0.074f, 0.070f, 0.096f, 0.006f},
                            {0.440f, 0.0645f, 0.069f, 0.072f, 0.0965f, 0.001f},
                            {0.370f, 0.0635f, 0.066f, 0.077f, 0.098f, -0.006f},
                            {0.290f, 0.0610f, 0.063f, 0.074f, 0.099f, -0.011f},
                            {0.210f, 0.0580f, 0.061f, 0.067f, 0.100f, -0.014f},
                            {0.140f, 0.0560f, 0.062f, 0.064f, 0.100f, -0.013f},
                            {0.090f, 0.0560f, 0.066f, 0.064f, 0.100f, -0.009f},
                            {0.040f, 0.0575f, 0.070f, 0.066f, 0.100f, -0.007f}};

// The radius of a sleeve at a distance from the shoulder's joint, metres. The cuff narrows it.
constexpr Knot kSleeve[] = {
    {-0.02f, 0.0310f}, {0.01f, 0.0380f},  {0.05f, 0.0455f}, {0.09f, 0.0490f},
    {0.14f, 0.0495f},  {0.20f, 0.0485f},  {0.25f, 0.0470f}, {0.29f, 0.0465f},
    {0.33f, 0.0465f},  {0.38f, 0.0450f},  {0.43f, 0.0430f}, {0.455f, 0.0415f},
    {0.466f, 0.0400f}, {0.472f, 0.0370f}, {0.50f, 0.0362f}, {0.535f, 0.0358f}};

// A copy of a table, fitted to the parameters of a body.
std::vector<Section> Fitted(std::span<const Section> sections, const auto& fit) {
  std::vector<Section> fitted(sections.begin(), sections.end());
  for (Section& section : fitted) fit(&section);
  return fitted;
}

void Widen(float factor, Section* s) {
  s->half_width *= factor;
  s->front *= factor;
  s->back *= factor;
}

// The body is symmetric, so solids describe the left half only.
vec3 Mirrored(const vec3& p) { return {std::abs(p.x), p.y, p.z}; }

}  // namespace

BodyShape::BodyShape(const BodyParameters& parameters, const wrinkle::Skeleton& skeleton,
                     const HeadShape& head)
    : parameters_(parameters), skeleton_(skeleton), head_(&head) {
  // Clothes are modelled with lowered arms. The skin matrices lead from the rest pose to this
  // modelling pose, and CarryToRest() leads back.
  std::vector<mat4> model(skeleton.num_joints());
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const std::string& name = skeleton.joint_names()[j];
    const float side = name.ends_with("_r") ? 1.0f : -1.0f;
    const float drop = name.starts_with("shoulder_")    ? kShoulderDrop
                       : name.starts_with("upper_arm_") ? kArmDrop
                                                        : 0.0f;
    const mat4 local = glm::rotate(glm::translate(mat4(1.0f), skeleton.rest_pose()[j].translation),
                                   side * drop * kDegrees, vec3(0, 0, 1));
    const int parent = skeleton.joint_parents()[j];
    model[j] = parent == wrinkle::kNoJoint ? local : model[parent] * local;
    skin_matrices_.push_back(model[j] *
                             glm::translate(mat4(1.0f), -vec3(skeleton.rest_model()[j][3])));
  }
  const auto place = [&](const char* joint) { return vec3(model[skeleton.Find(joint)][3]); };
  shoulder_ = place("upper_arm_l");
  arm_ = glm::normalize(place("hand_l") - shoulder_);
  outward_ = glm::normalize(vec3(-arm_.y, arm_.x, 0.0f));
  forward_ = glm::cross(arm_, outward_);
  if (forward_.z < 0.0f) forward_ = -forward_;

  torso_ = Fitted(kTorso, [&](Section* s) {
    const float chest = Smoothstep(1.12f, 1.28f, s->height);
    const float shoulders = Smoothstep(1.30f, 1.40f, s->height);
    Widen(parameters.waist + (parameters.chest - parameters.waist) * chest, s);
    s->half_width *= 1.0f + (parameters.shoulder_width / parameters.chest - 1.0f) * shoulders;
    s->front += parameters.bust * Bump(s->height - 1.265f, 0.075f);
    s->front += parameters.belly * Bump(s->height - 1.09f, 0.10f);
  });
  pelvis_ = Fitted(kPelvis, [&](Section* s) {
    const float waist = Smoothstep(0.95f, 1.03f, s->height);
    Widen(parameters.hips + (parameters.waist - parameters.hips) * waist, s);
    s->front += parameters.belly * 0.5f * Bump(s->height - 1.02f, 0.08f);
  });
  const float leg_x = skeleton.rest_model()[skeleton.Find("upper_leg_l")][3].x - 0.092f;
  leg_ = Fitted(kLeg, [&](Section* s) {
    Widen(parameters.limbs, s);
    s->x += leg_x;
  });
}

float BodyShape::Sleeve(const vec3& p) const {
  const float along = std::clamp(glm::dot(p - shoulder_, arm_), -0.02f, 0.54f);
  const vec3 middle = shoulder_ + arm_ * along;
  // Deltoid and triceps: fuller on the outside near the shoulder, and behind below it.
  const vec3 off = outward_ * (0.002f * Bump(along - 0.08f, 0.07f)) -
                   forward_ * (0.005f * Bump(along - 0.20f, 0.10f));
  return glm::distance(p, middle + off) - Interpolate(kSleeve, along) * parameters_.limbs;
}

float BodyShape::Shirt(const vec3& p) const {
  const vec3 q = Mirrored(p);
  const float wide = parameters_.shoulder_width;
  // The slope of the shoulder, from the neck to the cap of the joint.
  const float slope =
      RodDistance(q, {0.050f, 1.466f, -0.038f}, {0.155f * wide, 1.391f, -0.022f}, 0.036f, 0.035f);
  const float trunk = SmoothMin(TrunkDistance(q, torso_, 2.3f), slope, 0.05f);
  // Shoulder blades and chest muscles, softened by the cloth.
  const float blades =
      RodDistance(q, {0.075f, 1.36f, -0.105f}, {0.085f, 1.29f, -0.098f}, 0.032f, 0.03f);
  const float chest =
      RodDistance(q, {0.060f, 1.325f, 0.073f}, {0.105f, 1.335f, 0.058f}, 0.042f, 0.04f);
  const float back = SmoothMin(SmoothMin(trunk, blades, 0.05f), chest, 0.05f);
  return SmoothMin(back, Sleeve(q), 0.04f);
}

float BodyShape::TrouserLeg(const vec3& p) const { return TrunkDistance(p, leg_, 2.15f); }

float BodyShape::Trousers(const vec3& p) const {
  const vec3 q = Mirrored(p);
  return SmoothMin(TrunkDistance(q, pelvis_, 2.25f), TrouserLeg(q), 0.035f);
}

// The head's solid is in centimetres. The surface lies 7 mm outside the skin.
float BodyShape::Neck(const vec3& p) const {
  return head_->Distance(ModelToHead(p)) * 0.01f - 0.007f;
}

}  // namespace furrow::authoring
