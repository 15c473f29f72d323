// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/wrinkle_mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtx/quaternion.hpp>

#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr std::uint32_t kInactive = 0xffffffffu;
// How much of the difference from its neighbours' slides a vertex loses per iteration.
constexpr float kSlideTogether = 0.5f;
// The wave that resists least, in wavelengths. The one that grows fastest is shorter.
constexpr float kSlowest = 1.35f;
// How far the wavelength varies: by a factor of 2^-v to 2^v.
constexpr float kWavelengthVariation = 0.6f;
// Noise from which on cloth has ease, and at which it has most, in parts of the variation.
constexpr float kTightNoise = -0.4f;
constexpr float kLooseNoise = 0.5f;
// The curvature at which cloth creases, times the wavelength. A sine that is as high as a fifth of
// its length has 4 at its crests.
constexpr float kYield = 10.0f;
// The height in wavelengths from which on the support hardly grows: nothing but its own weight and
// a pull along the surface hold a crest down.
constexpr float kFree = 0.3f;
// How much more a pull presses cloth to the surface, per strain.
constexpr float kPress = 20.0f;
// The radius over which the mean height counts, in wavelengths.
constexpr float kLevelRadius = 0.7f;
// How far the mean may be from the surface, in wavelengths: as high as half a fold that stands on
// the body.
constexpr float kLift = 0.2f;
// The share of the rest that an iteration removes.
constexpr float kLevel = 0.05f;
// The share of the difference between neighbours that their means exchange per iteration.
constexpr float kExchange = 0.8f;
// The part of its weight that presses cloth flat to a body below it. Folds carry the rest.
constexpr float kLying = 0.2f;
// The strength of bending, at edges of a wavelength / pi.
constexpr float kBending = 0.05f;
// A share of the bending that an iteration removes. Larger values make the heights oscillate.
constexpr float kMostBending = 0.8f;
constexpr float kMostSupport = 0.5f;  // of the height, likewise
// Where skinning compresses the surface to less than this, inside a sharp bend, the cloth shortens
// with it: no real limb is pressed so far.
constexpr float kLeastStretch = 0.35f;
// How much wider than the surface cloth is across a pull, per strain of the pull. The weave shears,
// so this is more than Poisson's ratio of the threads. Skinning stretches further than cloth, which
// slips, so the strain has a limit.
constexpr float kNarrowing = 0.9f;
constexpr float kLargestTension = 0.2f;
constexpr float kShortest = 0.3f;  // of the cut length, however far the surface is compressed
// Slopes approach this. Cloth that hangs over would otherwise be a black line.
constexpr float kSteepest = 1.3f;
// Below this cosine between the surface's normal and the skinned one, skinning has turned the
// surface inside out.
constexpr float kInsideOut = 0.3f;

// The nearest rotation to a blend of rotations and scales, by Gram and Schmidt; none if it has
// none.
glm::mat3 RotationIn(const glm::mat3& m) {
  const float first = glm::length(m[0]);
  if (!(first > 1e-6f)) return glm::mat3(1.0f);
  const vec3 x = m[0] / first;
  const vec3 y = m[1] - glm::dot(m[1], x) * x;
  const float second = glm::length(y);
  if (!(second > 1e-6f)) return glm::mat3(1.0f);
  return {x, y / second, glm::cross(x, y / second)};
}

// The hyperbolic tangent within 1e-4, from Lambert's continued fraction, at a quarter of the time.
float Tanh(float x) {
  constexpr float kSaturated = 4.97f;  // where the fraction reaches 1
  const float limited = std::clamp(x, -kSaturated, kSaturated);
  const float square = limited * limited;
  const float above = limited * (135135.0f + square * (17325.0f + square * (378.0f + square)));
  const float below = 135135.0f + square * (62370.0f + square * (3150.0f + 28.0f * square));
  return above / below;
}

vec3 UnitOr(const vec3& v, const vec3& otherwise) {
  const float length = glm::length(v);
  return length > 1e-12f ? v / length : otherwise;
}

}  // namespace

WrinkleMesh::WrinkleMesh(const FineMesh& mesh, std::span<const float> room, const Options& options)
    : mesh_(mesh), options_(options) {
  Activate(room);
  MakeLinks();
}

void WrinkleMesh::Activate(std::span<const float> room) {
  std::vector<char> wanted(room.size(), 0);
  for (std::uint32_t v = 0; v < room.size(); ++v) {
    if (!(room[v] > 0.0f)) continue;
    wanted[v] = 1;
    for (const std::uint32_t other : mesh_.Around(v)) wanted[other] = 1;
  }
  index_.assign(room.size(), kInactive);
  std::vector<vec3> normals;
  for (const wrinkle::SurfaceAxes& axes : mesh_.surface().axes()) normals.push_back(axes.normal);
  for (std::uint32_t v = 0; v < room.size(); ++v) {
    if (!wanted[v]) continue;
    index_[v] = static_cast<std::uint32_t>(active_.size());
    Active& point = active_.emplace_back();
    point.vertex = v;
    point.room = room[v];
    point.rest_normal = UnitOr(mesh_.vertices()[v].Interpolate(std::span<const vec3>(normals)),
                               vec3(0.0f, 0.0f, 1.0f));
  }
  ring_starts_.push_back(0);
  for (const Active& point : active_) {
    for (const std::uint32_t other : mesh_.Around(point.vertex)) {
      if (index_[other] != kInactive) rings_.push_back(index_[other]);
    }
    ring_starts_.push_back(rings_.size());
  }
}

void WrinkleMesh::MakeLinks() {
  std::vector<float> lengths(active_.size(), 0.0f), counts(active_.size(), 0.0f);
  for (const FineMesh::Edge& edge : mesh_.edges()) {
    const std::uint32_t a = index_[edge[0]], b = index_[edge[1]];
    if (a == kInactive || b == kInactive) continue;
    const float length = glm::distance(mesh_.positions()[edge[0]], mesh_.positions()[edge[1]]);
    for (const std::uint32_t end : {a, b}) {
      lengths[end] += length;
      counts[end] += 1.0f;
    }
    const float room_a = active_[a].room, room_b = active_[b].room;
    if (room_a <= 0.0f && room_b <= 0.0f) continue;
    const float mobile = (room_a > 0.0f ? 1.0f : 0.0f) + (room_b > 0.0f ? 1.0f : 0.0f);
    links_.push_back({.a = a,
                      .b = b,
                      .ease = EaseOf(edge) * 0.5f * (room_a + room_b),
                      .gain = GainOf(edge) * 0.5f * (room_a + room_b),
                      .share_a = room_a > 0.0f ? 1.0f / mobile : 0.0f,
                      .share_b = room_b > 0.0f ? 1.0f / mobile : 0.0f});
  }
  // The mean of a vertex's neighbours, at the distance l, is lower than a crest by x^2 of its
  // height, with x = pi l / lambda. So a wave loses b x^4 of its height per iteration by bending of
  // strength b, and with a support of the same size, the wave of lambda resists least. Cloth
  // buckles where it is compressed by more than a constant times b x^2, so b = kBending / x^2 lets
  // all fabrics buckle alike, on edges of any length.
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const float varied = std::exp2(kWavelengthVariation * NoiseAt(active_[i].vertex, 1));
    const float wavelength = varied * options_.wavelength *
                             (options_.wider.empty() ? 1.0f : options_.wider[active_[i].vertex]);
    const float edge = lengths[i] / std::max(counts[i], 1.0f);
    const float x = kPi * edge / (kSlowest * wavelength);
    const float square = std::max(x * x, 1e-6f);
    active_[i].bending = std::min(kBending / square, kMostBending);
    active_[i].support = std::min(active_[i].bending * square * square, kMostSupport);
    // The mean of the neighbours at the distance l is higher by l^2 / 4 times the curvature.
    active_[i].yield = kYield / wavelength * 0.25f * edge * edge;
    // Means that exchange D and follow the height by f average over a radius of l sqrt(D / f) / 2.
    const float radius = kLevelRadius * wavelength;
    active_[i].follow = std::min(0.25f * kExchange * edge * edge / (radius * radius), 0.5f);
  }
}

// How much longer than the surface the cloth is along an edge, if it lies level.
float WrinkleMesh::EaseOf(const FineMesh::Edge& edge) const {
  const ClothEase ease = options_.eases.empty() ? ClothEase() : options_.eases[edge[0]];
  const float loose = std::lerp(ease.least, 2.0f - ease.least,
                                Smoothstep(kTightNoise, kLooseNoise, NoiseAt(edge[0], 2)));
  return options_.ease * ease.looser * std::lerp(1.0f, loose, options_.variation);
}

// How much length an edge gains in the last pose, as a share of its cut length.
float WrinkleMesh::GainOf(const FineMesh::Edge& edge) const {
  if (options_.slipped.empty()) return 0.0f;
  const vec3 along = UnitOr(mesh_.positions()[edge[1]] - mesh_.positions()[edge[0]], vec3(0.0f));
  const glm::mat3 gain = 0.5f * (options_.slipped[edge[0]] + options_.slipped[edge[1]]);
  return glm::dot(along, gain * along);
}

// Smooth noise over the surface at rest, [-variation, variation]. `stream` selects one of several.
float WrinkleMesh::NoiseAt(std::uint32_t vertex, int stream) const {
  constexpr float kFeature = 3.0f;  // wavelengths
  const vec3 place = mesh_.positions()[vertex] / (kFeature * options_.wavelength);
  const vec3 shift(17.0f * static_cast<float>(stream),
                   0.37f * static_cast<float>(options_.seed % 997), 5.0f);
  return options_.variation * SignedNoise(place + shift);
}

// Moves the surface; the cloth keeps its place relative to the surface.
void WrinkleMesh::Carry(std::span<const PosedVertex> surface, float way) {
  for (Active& point : active_) {
    const FineMesh::Vertex& vertex = mesh_.vertices()[point.vertex];
    const vec3 offset = glm::transpose(point.turn) * (point.cloth - point.base);
    point.base = vec3(0.0f);
    glm::mat3 turn(0.0f);
    for (int k = 0; k < 3; ++k) {
      const PosedVertex& corner = surface[vertex.corners[static_cast<std::size_t>(k)]];
      point.base += vertex.shares[k] * corner.position;
      turn += vertex.shares[k] * corner.turn;
    }
    point.turn = RotationIn(turn);
    point.normal = point.turn * point.rest_normal;
    const float dent = options_.dents * point.room *
                       RandomAt(static_cast<int>(point.vertex), static_cast<int>(options_.seed), 5);
    point.cloth = point.base + (started_ ? point.turn * offset : dent * point.normal);
  }
  if (!started_) Cut();
  MeasureTension();
  for (Link& link : links_) SetLength(way, &link);
  started_ = true;
}

// Cuts the cloth for this pose.
void WrinkleMesh::Cut() {
  for (Link& link : links_) {
    const vec3 edge = active_[link.b].base - active_[link.a].base;
    const float length = glm::length(edge);
    const float down = length > 0.0f ? edge.y / length : 0.0f;
    link.cut = length * (1.0f + link.ease * std::lerp(1.0f, options_.hang, down * down));
  }
}

// How far the surface is stretched beyond the cloth's length, as a tensor: the mean of e d d^T over
// the edges of a vertex, with the direction d of an edge and its strain e > 0.
void WrinkleMesh::MeasureTension() {
  std::vector<float> counts(active_.size(), 0.0f);
  for (Active& point : active_) point.tension = glm::mat3(0.0f);
  for (const Link& link : links_) {
    const vec3 edge = active_[link.b].base - active_[link.a].base;
    const float now = glm::length(edge);
    const float strain = std::clamp(now / std::max(link.cut, 1e-9f) - 1.0f, 0.0f, kLargestTension);
    const vec3 d = UnitOr(edge, vec3(0.0f));
    for (const std::uint32_t end : {link.a, link.b}) {
      counts[end] += 1.0f;
      active_[end].tension += strain * glm::outerProduct(d, d);
    }
  }
  for (std::size_t i = 0; i < active_.size(); ++i) {
    Active& point = active_[i];
    point.tension *= 1.0f / std::max(counts[i], 1.0f);
    // A taut sheet presses on what it lies on.
    const float pull = 2.0f * (point.tension[0][0] + point.tension[1][1] + point.tension[2][2]);
    point.pressed = std::min(point.support * (1.0f + kPress * pull), kMostSupport);
  }
}

// Cloth that is pulled gives way, because it slips along the body: a taut mesh could not rise. It
// is then too wide across the pull (Cerda and Mahadevan 2003), and folds along it.
void WrinkleMesh::SetLength(float way, Link* link) const {
  const Active& a = active_[link->a];
  const Active& b = active_[link->b];
  const vec3 edge = b.base - a.base;
  const float now = glm::length(edge);
  const vec3 across = UnitOr(glm::cross(a.normal + b.normal, edge), vec3(0.0f));
  const vec3 along = UnitOr(edge, vec3(0.0f));
  const glm::mat3 tension = 0.5f * (a.tension + b.tension);
  // Over all directions, the mean of cos^4 is 3/8 and that of cos^2 sin^2 1/8; this inverts them.
  const float pull = 3.0f * glm::dot(across, tension * across) - glm::dot(along, tension * along);
  const float narrowing = 1.0f + kNarrowing * std::clamp(pull, 0.0f, kLargestTension);
  const float pressed =
      link->cut * std::clamp(now / (kLeastStretch * std::max(link->cut, 1e-9f)), kShortest, 1.0f);
  link->length = narrowing * std::max(pressed, now) + way * link->gain * link->cut;
}

void WrinkleMesh::Step(std::span<const PosedVertex> surface, int iterations, float way) {
  Carry(surface, way);
  Gather();
  for (int i = 0; i < iterations; ++i) {
    for (std::size_t v = 0; v < cloth_.size(); ++v) {
      if (held_[v].room > 0.0f) cloth_[v] += held_[v].weight;
    }
    KeepLengths();
    Bend();
    StayNear();
  }
  for (std::size_t v = 0; v < cloth_.size(); ++v) active_[v].cloth = cloth_[v];
}

// An iteration reads little of each vertex and link. Side by side, that fits the processor's cache.
void WrinkleMesh::Gather() {
  cloth_.resize(active_.size());
  held_.resize(active_.size());
  levels_.resize(active_.size(), 0.0f);
  for (std::size_t v = 0; v < active_.size(); ++v) {
    const Active& point = active_[v];
    cloth_[v] = point.cloth;
    const vec3 down(0.0f, -options_.weight, 0.0f);
    const float into = std::min(glm::dot(down, point.normal), 0.0f);
    held_[v] = {point.base,
                point.normal,
                point.room,
                point.bending,
                point.support,
                point.pressed,
                std::max(point.yield, 1e-9f),
                point.follow,
                down - (1.0f - kLying) * into * point.normal};
  }
  springs_.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    springs_[i] = {link.a, link.b, link.length, link.share_a, link.share_b};
  }
}

// Gauss-Seidel over the edges. Pressed and pulled edges are corrected alike, so that cloth without
// room in the surface leaves it.
void WrinkleMesh::KeepLengths() {
  for (const Spring& spring : springs_) {
    vec3& a = cloth_[spring.a];
    vec3& b = cloth_[spring.b];
    vec3 step = b - a;
    const float length = glm::length(step);
    if (length < 1e-9f) continue;
    step *= (length - spring.length) / length;
    a += spring.share_a * step;
    b -= spring.share_b * step;
  }
}

// The mean of the values around each vertex, minus its own.
template <class T>
void WrinkleMesh::Laplacian(const std::vector<T>& values, std::vector<T>* result) const {
  result->resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t first = ring_starts_[i], end = ring_starts_[i + 1];
    T sum(0.0f);
    for (std::size_t k = first; k < end; ++k) sum += values[rings_[k]];
    (*result)[i] = end == first ? T(0.0f) : sum / static_cast<float>(end - first) - values[i];
  }
}

// Bending resists by the second Laplacian of the height, the support by the height. In the surface,
// neighbours slide together: otherwise compressed edges would give way by a zigzag in the surface
// instead of a fold.
void WrinkleMesh::Bend() {
  heights_.resize(cloth_.size());
  slides_.resize(cloth_.size());
  for (std::size_t i = 0; i < cloth_.size(); ++i) {
    const vec3 offset = cloth_[i] - held_[i].base;
    heights_[i] = glm::dot(offset, held_[i].normal);
    slides_[i] = offset - heights_[i] * held_[i].normal;
  }
  Laplacian(heights_, &bends_);
  for (std::size_t i = 0; i < cloth_.size(); ++i) {
    bends_[i] = held_[i].yield * Tanh(bends_[i] / held_[i].yield);
  }
  Laplacian(bends_, &changes_);
  Laplacian(slides_, &slide_changes_);
  FollowLevels();
  const float lift = kLift * options_.wavelength;
  const float free = kFree * options_.wavelength;
  for (std::size_t i = 0; i < cloth_.size(); ++i) {
    const Held& held = held_[i];
    if (held.room <= 0.0f) continue;
    const float back = held.support * free * Tanh(heights_[i] / free) +
                       (held.pressed - held.support) * heights_[i] +
                       kLevel * (levels_[i] - std::clamp(levels_[i], -lift, lift));
    cloth_[i] -= held.normal * (held.bending * changes_[i] + back);
    cloth_[i] += kSlideTogether * slide_changes_[i];
  }
}

// The levels relax towards the solution of a screened diffusion: a mean of the heights.
void WrinkleMesh::FollowLevels() {
  Laplacian(levels_, &level_changes_);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    levels_[i] += kExchange * level_changes_[i] + held_[i].follow * (heights_[i] - levels_[i]);
  }
}

void WrinkleMesh::StayNear() {
  const float most_slide = options_.slide * options_.wavelength;
  const float most_rise = options_.rise * options_.wavelength;
  for (std::size_t i = 0; i < cloth_.size(); ++i) {
    const Held& held = held_[i];
    const vec3 offset = cloth_[i] - held.base;
    const float height = glm::dot(offset, held.normal);
    vec3 slide = offset - height * held.normal;
    const float length = glm::length(slide), limit = most_slide * held.room;
    if (length > limit) slide *= limit / length;
    const float kept = std::clamp(height, -options_.sink * held.room, most_rise * held.room);
    cloth_[i] = held.base + slide + kept * held.normal;
  }
}

// Per active vertex: the sum of the normals of its triangles, weighted by area.
std::vector<vec3> WrinkleMesh::Normals(const vec3 Active::*position) const {
  std::vector<vec3> normals(active_.size(), vec3(0.0f));
  for (const FineMesh::Triangle& triangle : mesh_.triangles()) {
    const std::uint32_t a = index_[triangle.vertices[0]], b = index_[triangle.vertices[1]],
                        c = index_[triangle.vertices[2]];
    if (a == kInactive || b == kInactive || c == kInactive) continue;
    const vec3 area = glm::cross(active_[b].*position - active_[a].*position,
                                 active_[c].*position - active_[a].*position);
    for (const std::uint32_t corner : {a, b, c}) normals[corner] += area;
  }
  return normals;
}

std::vector<WrinkleMesh::Fold> WrinkleMesh::Folds() const {
  std::vector<Fold> folds(mesh_.vertices().size());
  if (!started_) return folds;
  const std::vector<vec3> cloth = Normals(&Active::cloth), base = Normals(&Active::base);
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const Active& point = active_[i];
    if (point.room <= 0.0f) continue;
    Fold& fold = folds[point.vertex];
    fold.height = glm::dot(point.cloth - point.base, point.normal);
    // Slopes are measured from the normal of the surface, whose own bend does not count.
    const glm::mat3 back = glm::transpose(point.turn);
    vec3 from = back * UnitOr(base[i], point.normal);
    if (glm::dot(from, point.rest_normal) < kInsideOut) from = point.rest_normal;
    const vec3 seen =
        glm::rotation(from, point.rest_normal) * (back * UnitOr(cloth[i], point.normal));
    const float up = std::max(glm::dot(seen, point.rest_normal), 1e-3f);
    fold.gradient = point.rest_normal - seen / up;
    fold.gradient -= point.rest_normal * glm::dot(fold.gradient, point.rest_normal);
    const float steep = glm::length(fold.gradient);
    if (steep > 1e-6f) fold.gradient *= kSteepest * std::tanh(steep / kSteepest) / steep;
  }
  return folds;
}

}  // namespace furrow::authoring
