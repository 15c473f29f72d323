// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/cloth_folds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/cloth_strain.h"
#include "authoring/bake/cloth/crease_relief.h"
#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/bake/layers/parallel_for.h"
#include "authoring/bake/request/fabric.h"
#include "authoring/bake/surface/compression.h"
#include "authoring/bake/surface/posed_surface.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {

// A size of creases.
struct ClothFolds::Size {
  float share = 1.0f;         // of the full height
  float wide = 1.0f;          // spacing, in spacings of the field
  bool only_pressed = false;  // only where a pose presses the cloth together
  bool merges = false;        // where much is to hide, creases of stiff cloth merge
  CreaseOptions creases;
};

namespace {

using glm::mat3;
using glm::vec3;

// How far a bend pushes cloth along the body, how far a pull spreads, and how far around a limb
// cloth slips to where it is pulled, metres.
constexpr ClothSlip kSlip{.pressed = 0.075f, .pulled = 0.025f, .fed = 0.09f};
// How much more length a bend takes from cloth than from the skinned surface, which is rounder.
constexpr float kBend = 2.6f;
// How much wider than the surface cloth is across a pull, per strain of the pull. The weave shears,
// and skinning pulls cloth less than a garment that hangs from its seams.
constexpr float kNarrowing = 1.0f;
constexpr float kMostPull = 0.12f;
// A body that pulls cloth further than that also stretches it smooth: from and to which pull, and
// the share of the excess that is left.
constexpr float kSmoothFrom = 0.2f;
constexpr float kSmoothTo = 0.5f;
constexpr float kSmoothLeaves = 0.8f;
constexpr float kMostExcess = 0.8f;
// The share of the ease that hanging cloth has across gravity, and along it.
constexpr float kHanging = 0.9f;
constexpr float kHangingAlong = 0.1f;
// Strain of cloth that just hangs, and of cloth that a pose deforms.
constexpr float kStill = 0.02f;
constexpr float kMoved = 0.12f;
// How much wider apart and how high drag lines are, relative to folds that are pressed.
constexpr float kDragWidth = 1.35f;
constexpr float kDragHeight = 0.68f;
// Likewise of folds in cloth that feeds a pull nearby: it slides there little by little.
constexpr float kFedWidth = 0.8f;
constexpr float kFedHeight = 0.6f;
// Where much is to hide, the folds of stiff cloth merge: how much wider apart they are then, and
// the wavelengths between which cloth turns from thin (it creases finely) to stiff, metres.
constexpr float kMerged = 0.5f;
constexpr float kThin = 0.038f;
constexpr float kStiff = 0.045f;
// The size of loose and tight places, in wavelengths, and how much longer they are along gravity.
constexpr float kPlace = 2.5f;
constexpr float kLong = 0.7f;  // a share of the way along gravity that does not count
// How far creases turn away from the strongest excess, and by noise: radians, where little is to
// hide and where much is.
constexpr float kFan = 1.2f;
constexpr float kTurn = 0.7f;
constexpr float kTurnDeep = 0.5f;
// Passes over the fine mesh that average over about a centimetre, half a fold, a fold, and a limb.
constexpr int kNear = 6;
constexpr int kHalfFold = 24;
constexpr int kFold = 30;
constexpr int kLimb = 40;
// Passes over the drawn mesh: cloth has a thickness, and a valley is deep relative to a fold.
constexpr int kThickness = 2;
constexpr int kAroundValley = 60;
constexpr float kValleyWidth = 0.04f;  // metres
// Where crests of several sizes meet, they together come near this, metres.
constexpr float kHighest = 0.0195f;
// The share of the mean height over a few folds that is taken off: the surface is where cloth lies
// on average, but the body stops it from below.
constexpr float kSettled = 0.7f;
constexpr int kFewFolds = 400;
constexpr ReliefOptions kRelief{.height = 2.6f, .steepest = 2.0f, .highest = 0.5f, .narrow = 0.6f};
// Crests of several sizes add up. Where their slopes, averaged over kAround passes, come near this,
// all become lower: cloth creases, but it does not gape.
constexpr float kSteepest = 1.15f;
constexpr int kAround = 24;

// Completed share of the time when all poses are measured.
constexpr float kMeasured = 0.7f;

// The vertices of `mesh` on a posed surface.
std::vector<vec3> PlacesOn(const FineMesh& mesh, std::span<const PosedVertex> surface) {
  std::vector<vec3> welded, places;
  for (const PosedVertex& vertex : surface) welded.push_back(vertex.position);
  for (const FineMesh::Vertex& vertex : mesh.vertices()) {
    places.push_back(vertex.Interpolate(std::span<const vec3>(welded)));
  }
  return places;
}

// A tensor across a normal, in the normal's axes.
Tensor2 Across(const mat3& tensor, const wrinkle::SurfaceAxes& axes) {
  const vec3 x = tensor * axes.x, y = tensor * axes.y;
  return {glm::dot(axes.x, x), glm::dot(axes.x, y), glm::dot(axes.y, y)};
}

// The share of its length that cloth hides across its creases. A sheet that is pulled one way is
// too wide the other way; pulled both ways, it is taut.
float ExcessOf(const Principal2& slack) {
  const float pulled = std::max(-slack.small, 0.0f);
  const float pull = std::min(pulled, kMostPull) *
                     std::lerp(1.0f, kSmoothLeaves, Smoothstep(kSmoothFrom, kSmoothTo, pulled));
  return std::clamp(slack.large + kNarrowing * pull, 0.0f, kMostExcess);
}

// The direction of gravity at a vertex of a posed mesh, at rest.
vec3 DownAt(const FineMesh::Vertex& vertex, std::span<const PosedVertex> posed) {
  constexpr vec3 kDown(0.0f, -1.0f, 0.0f);
  vec3 down(0.0f);
  for (int k = 0; k < 3; ++k) {
    const PosedVertex& corner = posed[vertex.corners[static_cast<std::size_t>(k)]];
    down += vertex.shares[k] * (glm::transpose(corner.turn) * kDown);
  }
  return UnitOr(down, kDown);
}

}  // namespace

void ClothFolds::Add(const BakePose& pose, std::span<const float> mask, float wavelength,
                     const ClothEase& ease, const BakePose* further) {
  SkinMatrices cut(pose.skin_matrices.size(), glm::mat4(1.0f)), bent = pose.skin_matrices;
  if (!pose.path.empty()) {
    cut = pose.path.front();
    bent = pose.path.back();
  }
  SkinMatrices beyond;
  if (further != nullptr) beyond = further->skin_matrices;
  const auto same = [&](const Pose& other) {
    return other.wavelength == wavelength && other.cut == cut && other.bent == bent &&
           other.further == beyond && other.shape_weights == pose.shape_weights;
  };
  auto found = std::ranges::find_if(poses_, same);
  if (found == poses_.end()) {
    found = poses_.insert(found, {.cut = std::move(cut),
                                  .bent = std::move(bent),
                                  .further = std::move(beyond),
                                  .shape_weights = pose.shape_weights,
                                  .room = std::vector<float>(mesh_.vertices().size(), 0.0f),
                                  .shares = std::vector<float>(mesh_.vertices().size(), 0.0f),
                                  .eases = std::vector<ClothEase>(mesh_.vertices().size()),
                                  .wavelength = wavelength,
                                  .own = {},
                                  .laid = {}});
  }
  found->feeds = found->feeds ? std::min(*found->feeds, ease.feeds) : ease.feeds;
  for (std::size_t v = 0; v < mesh_.vertices().size(); ++v) {
    const float inside = mesh_.vertices()[v].Interpolate(mask);
    found->room[v] = std::max(found->room[v], inside);
    found->shares[v] = std::max(found->shares[v], inside * pose.weight);
    ClothEase& here = found->eases[v];
    here.looser = std::max(here.looser, std::lerp(1.0f, ease.looser, inside));
    here.least = std::max(here.least, inside * ease.least);
  }
  mask_.resize(mask.size(), 0.0f);
  for (std::size_t v = 0; v < mask.size(); ++v) mask_[v] = std::max(mask_[v], mask[v]);
}

// How much ease a place has, relative to the mean. Seams, wear and the body below make cloth
// uneven; hanging cloth falls in long folds, so loose places are longer along gravity than wide.
float ClothFolds::LoosenessAt(std::uint32_t vertex, const vec3& down, float wavelength,
                              float least) const {
  const vec3 p = mesh_.positions()[vertex];
  const vec3 place = (p - kLong * glm::dot(p, down) * down) / (kPlace * wavelength);
  const vec3 shift(34.0f, 0.37f * static_cast<float>(seed_ % 997), 5.0f);
  return std::lerp(least, 2.0f - least, Smoothstep(-0.3f, 0.6f, SignedNoise(place + shift)));
}

ClothFolds::Effect ClothFolds::EffectOf(const Pose& pose, const SkinMatrices& bent) const {
  const Surface& surface = mesh_.surface();
  const std::vector<vec3> morphed =
      pose.shape_weights.empty() ? std::vector<vec3>() : surface.Morphed(pose.shape_weights);
  const std::vector<PosedVertex> posed =
      PoseSurface(surface, bent, morphed.empty() ? surface.positions() : std::span(morphed));
  const std::vector<vec3> cut =
      PlacesOn(mesh_, PoseSurface(surface, pose.cut, surface.positions()));
  ClothSlip slip = kSlip;
  slip.feeds = pose.feeds.value_or(slip.feeds);
  const ClothStrain strain =
      MeasureClothStrain(mesh_, cut, PlacesOn(mesh_, posed), pose.room, slip);
  const std::vector<vec3> normals = NormalsOf(mesh_);
  const std::size_t count = mesh_.vertices().size();
  Effect effect{std::vector<mat3>(count, mat3(0.0f)), std::vector<float>(count, 0.0f),
                std::vector<float>(count, 1.0f), std::vector<float>(count, 1.0f)};
  for (std::uint32_t v = 0; v < mesh_.vertices().size(); ++v) {
    if (!(pose.room[v] > 0.0f)) continue;
    const vec3 down = DownAt(mesh_.vertices()[v], posed);
    const vec3 fall = down - normals[v] * glm::dot(down, normals[v]);
    const vec3 along = UnitOr(fall, vec3(0.0f)), level = glm::cross(normals[v], along);
    const ClothEase& ease = pose.eases[v];
    // Cloth that lies on the body does not hang, and taut cloth has no ease left.
    const float lost = TraceOf(strain.lost[v]), pulled = TraceOf(strain.pulled[v]);
    const float fed = strain.fed[v];
    const float taut = 0.8f * Smoothstep(0.03f, 0.15f, pulled);
    const float loose = (1.0f - taut) * ease_ * ease.looser *
                        LoosenessAt(v, down, pose.wavelength, ease.least) *
                        Smoothstep(0.2f, 0.7f, glm::length(fall));
    effect.slack[v] = kBend * strain.lost[v] - strain.pulled[v] +
                      loose * (kHanging * glm::outerProduct(level, level) +
                               kHangingAlong * glm::outerProduct(along, along));
    const float moved = Smoothstep(kStill, kMoved, lost + pulled);
    const float dragged = Smoothstep(0.04f, 0.2f, pulled - 0.5f * lost);
    // Cloth that feeds a pull has no large forms: those are lumps below a kneecap.
    effect.pressed[v] = moved * Smoothstep(0.15f, 0.8f, (lost - fed) / (pulled + kStill));
    const float feeding = fed / (lost + kStill);
    effect.height[v] = std::lerp(1.0f, kDragHeight, dragged) * std::lerp(1.0f, kFedHeight, feeding);
    effect.width[v] = std::lerp(HangingWidth(), std::lerp(1.0f, kDragWidth, dragged), moved) *
                      std::lerp(1.0f, kFedWidth, feeding);
  }
  return effect;
}

bool ClothFolds::Solve(int threads, BakeProgress* progress) {
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  // Progress is reported by the calling thread alone.
  const auto caller = std::this_thread::get_id();
  const auto work = [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last && !stopped; ++p) {
      Pose& pose = poses_[p];
      pose.own = EffectOf(pose, pose.bent);
      if (!pose.further.empty()) pose.laid = EffectOf(pose, pose.further);
      const float share = static_cast<float>(++done) / static_cast<float>(poses_.size());
      if (std::this_thread::get_id() == caller && !progress->Report(kMeasured * share)) {
        stopped = true;
      }
    }
  };
  // A pose is long: each is a range of its own.
  const bool solved = ParallelFor(
      poses_.size(), threads, work, [&](float) { return !stopped; }, 1);
  if (!solved || stopped || !progress->Report(kMeasured)) return false;
  Join();
  Steer();
  return Draw(progress) && progress->Report(1.0f);
}

std::pair<float, float> ClothFolds::Wavelengths() const {
  if (poses_.empty()) return {0.0f, 0.0f};
  const auto [least, most] = std::ranges::minmax(poses_, {}, &Pose::wavelength);
  return {least.wavelength, most.wavelength};
}

// Joins the poses to one field. The mean of two directions would be neither, so the strongest
// excess counts most.
void ClothFolds::Join() {
  const std::size_t count = mesh_.vertices().size();
  field_ = {std::vector<vec3>(count, vec3(0.0f)), std::vector<float>(count, 0.0f),
            std::vector<float>(count, kValleyWidth), std::vector<float>(count, 0.0f)};
  excess_.assign(count, 0.0f);
  pressed_.assign(count, 0.0f);
  merged_.assign(count, 0.0f);
  deep_.assign(count, 0.0f);
  const std::vector<vec3> normals = NormalsOf(mesh_);
  for (std::size_t v = 0; v < count; ++v) {
    const wrinkle::SurfaceAxes axes = AxesAcross(normals[v]);
    mat3 laid(0.0f), own(0.0f);
    float weights = 0.0f, spacing = 0.0f;
    for (const Pose& pose : poses_) {
      if (!(pose.room[v] > 0.0f)) continue;
      const Effect& effect = pose.further.empty() ? pose.own : pose.laid;
      const float excess = ExcessOf(PrincipalOf(Across(effect.slack[v], axes)));
      const float weight = pose.shares[v] * (excess * excess * excess + 1e-5f);
      laid += weight * effect.slack[v];
      own += weight * pose.own.slack[v];
      pressed_[v] += weight * effect.pressed[v];
      spacing += weight * pose.wavelength * effect.width[v];
      merged_[v] += weight * kMerged * Smoothstep(kThin, kStiff, pose.wavelength);
      // A weak pose has shallow folds.
      deep_[v] += weight * pose.own.height[v] * pose.shares[v] / pose.room[v];
      weights += weight;
    }
    if (!(weights > 0.0f)) continue;
    const Principal2 principal = PrincipalOf(Across(laid * (1.0f / weights), axes));
    const vec3 across = axes.x * principal.direction.x + axes.y * principal.direction.y;
    field_.along[v] = glm::cross(normals[v], across);
    field_.excess[v] = ExcessOf(principal);
    field_.spacing[v] = spacing / weights;
    excess_[v] = ExcessOf(PrincipalOf(Across(own * (1.0f / weights), axes)));
    pressed_[v] /= weights;
    merged_[v] *= Smoothstep(0.2f, 0.5f, field_.excess[v]) / weights;
    deep_[v] /= weights;
  }
  SmoothOver(mesh_, kNear, &field_.excess);
  SmoothOver(mesh_, kNear, &excess_);
  SmoothOver(mesh_, kHalfFold, &field_.spacing);
}

// Creases fan out from the strongest excess: as they run around the limb, they turn away from it
// along the limb.
void ClothFolds::Steer() {
  std::vector<float> wide = field_.excess;
  SmoothOver(mesh_, kLimb, &wide);
  const std::vector<vec3> slopes = SlopesOf(mesh_, wide), normals = NormalsOf(mesh_);
  for (std::size_t v = 0; v < wide.size(); ++v) {
    const vec3 along = field_.along[v], across = glm::cross(along, normals[v]);
    const float a = glm::dot(slopes[v], along), c = glm::dot(slopes[v], across);
    // Slopes that would change the excess by half in 25 cm are not a bend.
    const float flat = 2.0f * std::max(wide[v], kStill);
    field_.along[v] = UnitOr(along + kFan * a * c / (a * a + c * c + flat * flat) * across, along);
    field_.tilt[v] = std::lerp(kTurn, kTurnDeep, Smoothstep(0.1f, 0.3f, field_.excess[v]));
  }
}

// Adds the relief of creases of one size.
void ClothFolds::Add(const Size& size) {
  CreaseField field = field_;
  std::vector<float> own = excess_;
  for (std::vector<float>* excess : {&field.excess, &own}) {
    if (!size.only_pressed) continue;
    for (std::size_t v = 0; v < excess->size(); ++v) (*excess)[v] *= pressed_[v];
    SmoothOver(mesh_, kFold, excess);
  }
  for (std::size_t v = 0; v < field.spacing.size(); ++v) {
    field.spacing[v] *= size.wide + (size.merges ? merged_[v] : 0.0f);
  }
  const std::vector<Crease> creases = LayCreases(mesh_, field, own, size.creases);
  const std::vector<float> heights = DrawCreases(drawn_, creases, kRelief);
  for (std::size_t v = 0; v < heights.size(); ++v) heights_[v] += size.share * heights[v];
}

bool ClothFolds::Draw(BakeProgress* progress) {
  heights_.assign(drawn_.vertices().size(), 0.0f);
  const Size sizes[] = {
      {.share = 1.0f,
       .wide = 2.1f,
       .only_pressed = true,
       .creases = {.least = 0.09f, .start = 0.13f, .longest = 4.0f, .seed = seed_}},
      // Long and even ones: a crest that breaks off is a gash.
      {.merges = true,
       .creases = {.variation = 0.2f, .shortest = 2.5f, .longest = 8.0f, .seed = seed_ + 1}},
      {.share = 0.12f,
       .wide = 0.5f,
       .creases = {.least = 0.15f, .start = 0.19f, .longest = 7.0f, .seed = seed_ + 2}}};
  float drawn = 0.0f;
  for (const Size& size : sizes) {
    if (poses_.empty()) break;
    Add(size);
    drawn += 1.0f / static_cast<float>(std::size(sizes));
    if (!progress->Report(std::lerp(kMeasured, 1.0f, drawn))) return false;
  }
  // None are outside of the masks.
  std::vector<float> shown(mask_.size(), 0.0f);
  for (std::size_t v = 0; v < shown.size(); ++v) shown[v] = depth_ * deep_[v] * mask_[v];
  std::vector<float> mean = heights_;
  SmoothOver(drawn_, kFewFolds, &mean);
  for (std::size_t v = 0; v < heights_.size(); ++v) {
    heights_[v] = kHighest * std::tanh((heights_[v] - kSettled * mean[v]) / kHighest);
  }
  LimitSlopes();
  for (std::size_t v = 0; v < heights_.size(); ++v) {
    heights_[v] *=
        shown.empty() ? 0.0f : drawn_.vertices()[v].Interpolate(std::span<const float>(shown));
  }
  SmoothOver(drawn_, kThickness, &heights_);
  gradients_ = SlopesOf(drawn_, heights_);
  MeasureCavities();
  return true;
}

void ClothFolds::LimitSlopes() {
  // Fourth powers, in which the steepest places count most.
  constexpr float kMost = kSteepest * kSteepest * kSteepest * kSteepest;
  std::vector<float> steep;
  for (const vec3& slope : SlopesOf(drawn_, heights_)) {
    const float square = glm::dot(slope, slope);
    steep.push_back(square * square);
  }
  SmoothOver(drawn_, kAround, &steep);
  for (std::size_t v = 0; v < steep.size(); ++v) {
    heights_[v] /= std::sqrt(std::sqrt(1.0f + steep[v] / kMost));
  }
}

// A valley is deep relative to the mean height around it.
void ClothFolds::MeasureCavities() {
  std::vector<float> mean = heights_;
  SmoothOver(drawn_, kAroundValley, &mean);
  cavities_.clear();
  for (std::size_t v = 0; v < mean.size(); ++v) {
    cavities_.push_back(CavityOf(heights_[v] - mean[v], kValleyWidth));
  }
}

FoldSample ClothFolds::At(const SurfacePoint& point, const vec3& tangent,
                          const vec3& bitangent) const {
  const FineMesh::Place place = drawn_.Find(point);
  const auto& vertices = drawn_.triangles()[place.triangle].vertices;
  FoldSample fold{.cavity = 0.0f};
  vec3 gradient(0.0f);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = vertices[static_cast<std::size_t>(k)];
    fold.height += place.corners[k] * heights_[v];
    gradient += place.corners[k] * gradients_[v];
    fold.cavity += place.corners[k] * cavities_[v];
  }
  fold.slope = {glm::dot(gradient, tangent), glm::dot(gradient, bitangent)};
  return fold;
}

}  // namespace furrow::authoring
