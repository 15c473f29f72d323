// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_primitives.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

// Union with a rounding about `k` centimetres wide where the surfaces meet (Quilez's polynomial).
float Join(float a, float b, float k) {
  const float h = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::min(a, b) - h * h * k * 0.25f;
}

// Distance to first order: the implicit function over the length of its gradient (Quilez). The
// exact distance has no closed form.
float Ellipsoid(const vec3& p, const HeadPrimitive& primitive) {
  const vec3 d = p - primitive.a;
  const float cy = std::cos(primitive.r.x), sy = std::sin(primitive.r.x);
  const float cx = std::cos(primitive.r.y), sx = std::sin(primitive.r.y);
  const vec3 t(cy * d.x - sy * d.z, d.y, sy * d.x + cy * d.z);
  const vec3 e(t.x, cx * t.y + sx * t.z, cx * t.z - sx * t.y);
  const float k0 = glm::length(e / primitive.b);
  const float k1 = glm::length(e / (primitive.b * primitive.b));
  return k1 > 1e-6f ? k0 * (k0 - 1.0f) / k1
                    : -std::min({primitive.b.x, primitive.b.y, primitive.b.z});
}

// A capsule with a different radius at each end.
float Limb(const vec3& p, const HeadPrimitive& primitive) {
  const vec3 ab = primitive.b - primitive.a;
  const float t = std::clamp(glm::dot(p - primitive.a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
  return glm::length(p - primitive.a - ab * t) -
         (primitive.r.x + (primitive.r.y - primitive.r.x) * t);
}

constexpr HeadPrimitive Add(const char* name, vec3 centre, vec3 radii, float blend,
                            glm::vec2 turn = {}) {
  return {name, HeadPrimitive::Form::kEllipsoid, HeadPrimitive::Use::kAdd, centre, radii, turn,
          blend};
}
constexpr HeadPrimitive Cut(const char* name, vec3 centre, vec3 radii, float blend,
                            glm::vec2 turn = {}) {
  return {name, HeadPrimitive::Form::kEllipsoid, HeadPrimitive::Use::kCut, centre, radii, turn,
          blend};
}
constexpr HeadPrimitive AddLimb(const char* name, vec3 a, vec3 b, float ra, float rb, float blend) {
  return {name, HeadPrimitive::Form::kLimb, HeadPrimitive::Use::kAdd, a, b, {ra, rb}, blend};
}
constexpr HeadPrimitive CutLimb(const char* name, vec3 a, vec3 b, float ra, float rb, float blend) {
  return {name, HeadPrimitive::Form::kLimb, HeadPrimitive::Use::kCut, a, b, {ra, rb}, blend};
}

// Fitted to MakeHuman's base mesh (CC0), scaled to the landmarks of docs/DEFAULT-CHARACTER.md. The
// primitives were fitted first, by least squares on 5,400 points and their normals. The bulges were
// then fitted to the remaining differences.
constexpr HeadPrimitive kPrimitives[] = {
    Add("skull", {0.00f, 3.84f, -0.71f}, {7.71f, 7.82f, 8.80f}, 1.00f, {0.00f, -0.12f}),
    Add("forehead", {0.00f, 4.27f, 2.53f}, {5.69f, 4.83f, 6.39f}, 3.02f, {0.00f, 0.15f}),
    Add("face", {0.00f, -1.30f, 3.48f}, {6.80f, 7.31f, 5.85f}, 2.50f, {0.00f, 0.07f}),
    Add("maxilla", {0.00f, -6.49f, 3.62f}, {3.23f, 4.68f, 4.52f}, 1.97f, {0.00f, 0.01f}),
    Add("occiput", {0.00f, -0.64f, -4.83f}, {5.59f, 5.95f, 3.80f}, 2.49f, {0.00f, -0.14f}),
    AddLimb("jaw body", {4.44f, -6.22f, 0.45f}, {1.72f, -9.27f, 6.63f}, 0.97f, 1.31f, 1.68f),
    AddLimb("jaw branch", {5.60f, -1.01f, -0.66f}, {4.48f, -6.27f, 0.17f}, 1.01f, 0.98f, 1.35f),
    Add("chin", {0.00f, -9.74f, 7.61f}, {1.74f, 1.45f, 1.68f}, 1.57f, {0.00f, -0.02f}),
    Add("floor of the mouth", {0.00f, -7.85f, 3.71f}, {4.35f, 2.16f, 5.19f}, 1.71f, {0.00f, 0.03f}),
    AddLimb("cheekbone", {4.36f, -2.33f, 5.59f}, {6.04f, -1.39f, 1.16f}, 1.23f, 0.89f, 1.64f),
    Add("cheek", {2.85f, -4.70f, 5.92f}, {2.24f, 2.71f, 2.29f}, 2.07f, {0.48f, -0.03f}),
    Add("cheek beside the mouth", {3.13f, -6.81f, 5.17f}, {1.95f, 1.89f, 1.57f}, 1.40f,
        {0.54f, 0.03f}),
    Add("masseter", {5.00f, -4.85f, 2.37f}, {1.07f, 2.40f, 2.00f}, 1.50f, {0.51f, -0.02f}),
    CutLimb("temple", {8.49f, 1.97f, 3.80f}, {8.69f, 3.90f, 3.11f}, 1.16f, 1.10f, 1.80f),
    AddLimb("brow", {0.96f, 1.75f, 8.22f}, {4.43f, 2.06f, 6.38f}, 0.71f, 0.71f, 1.13f),
    Add("glabella", {0.00f, 2.33f, 8.28f}, {1.48f, 1.17f, 0.95f}, 1.21f, {0.00f, 0.02f}),
    AddLimb("neck", {0.00f, -6.11f, -2.32f}, {0.00f, -22.03f, -5.16f}, 4.74f, 5.50f, 1.63f),
    AddLimb("sternomastoid", {5.07f, -3.41f, -3.27f}, {1.07f, -19.48f, 0.45f}, 0.72f, 0.84f, 1.39f),
    Add("larynx", {0.00f, -14.39f, 1.81f}, {0.80f, 1.22f, 0.77f}, 1.14f, {0.00f, 0.01f}),
    AddLimb("trapezius", {2.47f, -9.11f, -7.15f}, {7.01f, -23.50f, -7.19f}, 1.42f, 2.19f, 2.89f),
    Cut("socket", {3.05f, -0.04f, 6.96f}, {1.56f, 1.53f, 1.59f}, 0.84f, {-0.01f, 0.00f}),
    Cut("beside the root", {1.71f, -0.33f, 9.51f}, {0.96f, 1.36f, 0.99f}, 1.04f, {-0.00f, 0.07f}),
    AddLimb("bridge", {0.00f, 0.72f, 8.11f}, {0.00f, -3.10f, 10.23f}, 0.57f, 0.63f, 0.66f),
    AddLimb("side of the nose", {0.41f, -0.70f, 8.11f}, {0.87f, -3.51f, 9.45f}, 0.46f, 0.75f,
            0.69f),
    Add("tip", {0.00f, -3.56f, 10.25f}, {1.01f, 0.70f, 0.86f}, 0.75f, {0.00f, -0.01f}),
    Add("tip, its side", {0.32f, -4.15f, 9.89f}, {0.47f, 0.78f, 0.47f}, 0.42f, {0.00f, 0.02f}),
    Add("wing", {1.25f, -4.53f, 9.19f}, {0.87f, 0.78f, 0.33f}, 0.40f, {0.32f, -0.08f}),
    AddLimb("columella", {0.00f, -4.68f, 10.56f}, {0.00f, -4.83f, 9.55f}, 0.25f, 0.35f, 0.32f),
    CutLimb("nostril", {0.32f, -4.97f, 10.28f}, {0.86f, -4.24f, 10.08f}, 0.35f, 0.29f, 0.39f),
    CutLimb("wing's furrow", {2.07f, -3.64f, 9.39f}, {1.90f, -4.58f, 9.09f}, 0.12f, 0.13f, 0.51f),
    AddLimb("upper lip, skin", {0.00f, -5.76f, 9.98f}, {2.80f, -6.10f, 8.05f}, 0.47f, 0.36f, 0.90f),
    AddLimb("upper lip", {0.00f, -6.48f, 9.84f}, {0.75f, -6.18f, 9.76f}, 0.40f, 0.42f, 0.45f),
    AddLimb("upper lip to the corner", {1.07f, -6.31f, 9.61f}, {2.77f, -6.77f, 8.28f}, 0.40f, 0.28f,
            0.31f),
    CutLimb("philtrum", {0.00f, -5.09f, 9.74f}, {0.00f, -6.00f, 9.86f}, 0.11f, 0.21f, 0.29f),
    CutLimb("under the lip", {0.00f, -8.60f, 10.02f}, {1.90f, -8.30f, 9.44f}, 0.22f, 0.14f, 0.95f),
    AddLimb("lower lip", {0.00f, -7.57f, 9.62f}, {0.89f, -7.44f, 9.35f}, 0.49f, 0.45f, 0.46f),
    AddLimb("lower lip to the corner", {1.09f, -7.53f, 9.07f}, {2.71f, -7.11f, 8.18f}, 0.51f, 0.29f,
            0.37f),
    AddLimb("between the lips", {0.00f, -6.88f, 9.40f}, {2.50f, -6.93f, 8.38f}, 0.40f, 0.30f,
            0.25f),
    Cut("corner", {2.76f, -6.98f, 8.95f}, {0.30f, 0.22f, 0.28f}, 0.45f),
    // The lids: a shell over the eyeball, longer than high, so that it ends at the corners.
    Add("lids", {3.2f, 0.0f, 7.22f}, {1.76f, 1.42f, 1.43f}, 0.75f),
    // The fold above the upper lid.
    // Its halves end apart, because two cuts at one place are deeper and would dent the closed lid.
    CutLimb("lid crease, inner half", {2.25f, 0.75f, 8.42f}, {3.14f, 0.91f, 8.54f}, 0.02f, 0.04f,
            0.25f),
    CutLimb("lid crease, outer half", {3.46f, 0.9f, 8.5f}, {4.6f, 0.62f, 8.0f}, 0.04f, 0.02f,
            0.25f),
};

constexpr Bulge kBulges[] = {
    {{0.82f, -6.07f, 9.24f}, 0.5f, -0.126f},
    {{7.21f, 4.44f, 3.03f}, 1.2f, 0.132f},
    {{4.94f, 0.48f, 7.62f}, 0.8f, 0.061f},
    {{6.17f, 2.10f, 5.80f}, 1.2f, -0.081f},
    {{3.32f, -7.38f, 8.14f}, 0.5f, 0.094f},
    {{4.51f, -8.11f, 5.99f}, 0.8f, -0.117f},
    {{4.68f, 9.20f, 3.90f}, 1.8f, 0.111f},
    {{0.32f, 3.96f, 9.57f}, 0.8f, 0.099f},
    {{2.66f, 1.24f, 8.76f}, 0.5f, -0.104f},
    {{2.97f, 6.67f, 7.74f}, 1.8f, -0.070f},
    {{4.73f, -5.34f, 7.37f}, 0.8f, -0.098f},
    {{2.35f, -3.84f, 8.95f}, 0.5f, 0.095f},
    {{1.12f, -5.52f, 9.94f}, 0.5f, 0.059f},
    {{5.87f, -0.00f, 6.65f}, 0.5f, 0.069f},
    {{1.94f, -1.94f, 8.87f}, 0.8f, -0.049f},
    {{6.88f, 1.98f, 3.64f}, 0.8f, 0.086f},
    {{3.99f, -9.13f, 3.34f}, 0.5f, -0.112f},
    {{5.13f, -8.16f, 3.87f}, 0.8f, 0.085f},
    {{0.48f, -3.91f, 10.82f}, 0.5f, -0.037f},
    {{6.83f, -0.28f, 4.24f}, 1.2f, -0.046f},
    {{0.89f, 2.05f, 9.55f}, 0.5f, -0.085f},
    {{1.35f, 0.62f, 8.88f}, 0.5f, 0.049f},
    {{1.08f, -7.04f, 9.59f}, 0.5f, 0.043f},
    {{0.97f, -5.55f, 9.11f}, 0.5f, -0.049f},
    {{0.66f, -7.17f, 9.82f}, 0.5f, 0.045f},
    {{1.86f, -7.25f, 8.18f}, 0.5f, -0.066f},
    {{4.69f, -8.53f, 3.26f}, 1.8f, -0.033f},
    {{3.77f, -9.58f, 5.65f}, 0.5f, 0.085f},
    {{5.02f, -1.06f, 7.45f}, 0.5f, -0.051f},
    {{0.66f, -0.41f, 9.15f}, 0.5f, -0.044f},
    {{5.93f, -5.03f, 5.42f}, 0.8f, 0.068f},
    {{0.00f, -5.83f, 10.39f}, 0.5f, -0.034f},
    {{0.82f, -5.17f, 9.91f}, 0.5f, 0.033f},
    {{1.21f, -4.23f, 9.50f}, 0.5f, -0.024f},
    {{2.23f, -4.67f, 9.02f}, 0.5f, 0.059f},
    {{2.35f, -7.93f, 8.64f}, 0.5f, 0.044f},
    {{0.92f, -2.63f, 10.10f}, 0.5f, 0.041f},
    // Adjusted by hand: fuller lips, a softer rim.
    {{0.40f, -6.50f, 10.0f}, 0.38f, 0.12f},
    {{1.35f, -6.52f, 9.65f}, 0.32f, 0.12f},
    {{0.00f, -5.60f, 10.4f}, 0.60f, -0.04f},
    {{1.20f, -5.70f, 10.1f}, 0.60f, -0.09f},
};

}  // namespace

float PrimitivesDistance(std::span<const HeadPrimitive> primitives, const vec3& q) {
  float d = 1e3f;
  for (const HeadPrimitive& primitive : primitives) {
    const float own =
        primitive.form == HeadPrimitive::Form::kLimb ? Limb(q, primitive) : Ellipsoid(q, primitive);
    d = primitive.use == HeadPrimitive::Use::kAdd ? Join(d, own, primitive.blend)
                                                  : -Join(-d, own, primitive.blend);
  }
  return d;
}

float BulgesHeight(std::span<const Bulge> bulges, const vec3& q) {
  float height = 0.0f;
  for (const Bulge& bulge : bulges) {
    const vec3 d = q - bulge.centre;
    const float far = glm::dot(d, d) / (2.0f * bulge.width * bulge.width);
    if (far < 9.0f) height += bulge.height * std::exp(-far);
  }
  return height;
}

std::span<const HeadPrimitive> AdultPrimitives() { return kPrimitives; }
std::span<const Bulge> AdultBulges() { return kBulges; }

}  // namespace furrow::authoring
