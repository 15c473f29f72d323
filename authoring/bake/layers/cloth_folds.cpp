// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/cloth_folds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/crease_relief.h"
#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/bake/layers/parallel_for.h"
#include "authoring/bake/surface/compression.h"
#include "base/scalar.h"

namespace furrow::authoring {

// A size of creases.
struct ClothFolds::Size {
  float share = 1.0f;         // of the full height
  float wide = 1.0f;          // spacing, in spacings of the field
  bool only_pressed = false;  // only where a pose presses the cloth together
  bool merges = false;        // where much is to hide, creases of stiff cloth merge
  float turned = 0.0f;        // from the field, radians
  CreaseOptions creases;
};

namespace {

using glm::mat3;
using glm::vec3;

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
constexpr float kLittle = 0.02f;  // an excess that shows no folds
// Where much is to hide, the folds of stiff cloth merge: how much wider apart they are then, and
// the wavelengths between which cloth turns from thin (it creases finely) to stiff, metres.
constexpr float kMerged = 0.5f;
constexpr float kThin = 0.038f;
constexpr float kStiff = 0.045f;
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
// Passes over the drawn mesh: a valley is deep relative to a fold.
constexpr int kAroundValley = 60;
constexpr float kValleyWidth = 0.04f;  // metres
// Where crests of several sizes meet, they together come near this, metres.
constexpr float kHighest = 0.0195f;
// The height of the sides of diamonds, as a share of the full height, and how far they turn from
// the creases between them, radians.
constexpr float kFacets = 0.4f;
constexpr float kFacetTurn = 0.65f;
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

}  // namespace

void ClothFolds::Add(const BakePose& pose, std::span<const float> mask, const FabricFolds& fabric,
                     const ClothEase& ease, const BakePose* further) {
  SkinMatrices cut(pose.skin_matrices.size(), glm::mat4(1.0f)), bent = pose.skin_matrices;
  if (!pose.path.empty()) {
    cut = pose.path.front();
    bent = pose.path.back();
  }
  SkinMatrices beyond;
  if (further != nullptr) beyond = further->skin_matrices;
  const auto same = [&](const Pose& other) {
    return other.cloth.fabric == fabric && other.cloth.cut == cut && other.bent == bent &&
           other.further == beyond && other.shape_weights == pose.shape_weights;
  };
  const std::size_t count = mesh_.vertices().size();
  auto found = std::ranges::find_if(poses_, same);
  if (found == poses_.end()) {
    found = poses_.insert(found, {.cloth = {.cut = std::move(cut),
                                            .room = std::vector<float>(count, 0.0f),
                                            .eases = std::vector<ClothEase>(count),
                                            .fabric = fabric,
                                            .ease = ease_,
                                            .feeds = ease.feeds,
                                            .seed = seed_},
                                  .bent = std::move(bent),
                                  .further = std::move(beyond),
                                  .shape_weights = pose.shape_weights,
                                  .shares = std::vector<float>(count, 0.0f),
                                  .own = {},
                                  .laid = {}});
  }
  WornCloth& cloth = found->cloth;
  cloth.feeds = std::min(cloth.feeds, ease.feeds);
  for (std::size_t v = 0; v < count; ++v) {
    const float inside = mesh_.vertices()[v].Interpolate(mask);
    cloth.room[v] = std::max(cloth.room[v], inside);
    found->shares[v] = std::max(found->shares[v], inside * pose.weight);
    ClothEase& here = cloth.eases[v];
    here.looser = std::max(here.looser, std::lerp(1.0f, ease.looser, inside));
    here.least = std::max(here.least, inside * ease.least);
    here.stacks = std::max(here.stacks, inside * ease.stacks);
  }
  mask_.resize(mask.size(), 0.0f);
  radii_.resize(mask.size(), 0.0f);
  for (std::size_t v = 0; v < mask.size(); ++v) {
    mask_[v] = std::max(mask_[v], mask[v]);
    radii_[v] = std::max(radii_[v], mask[v] * fabric.radius);
  }
}

bool ClothFolds::Solve(int threads, BakeProgress* progress) {
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  // Progress is reported by the calling thread alone.
  const auto caller = std::this_thread::get_id();
  const auto work = [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last && !stopped; ++p) {
      Pose& pose = poses_[p];
      pose.own = MeasureClothEffect(mesh_, pose.cloth, pose.bent, pose.shape_weights);
      if (!pose.further.empty()) {
        pose.laid = MeasureClothEffect(mesh_, pose.cloth, pose.further, pose.shape_weights);
      }
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
  const auto wavelength = [](const Pose& pose) { return pose.cloth.fabric.wavelength; };
  const auto [least, most] = std::ranges::minmax(poses_, {}, wavelength);
  return {wavelength(least), wavelength(most)};
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
  normals_ = NormalsOf(mesh_);
  for (std::size_t v = 0; v < count; ++v) {
    const wrinkle::SurfaceAxes axes = AxesAcross(normals_[v]);
    mat3 laid(0.0f), own(0.0f);
    float weights = 0.0f, spacing = 0.0f;
    for (const Pose& pose : poses_) {
      const float wavelength = pose.cloth.fabric.wavelength;
      if (!(pose.cloth.room[v] > 0.0f)) continue;
      const ClothEffect& effect = pose.further.empty() ? pose.own : pose.laid;
      const float excess = ExcessOf(PrincipalOf(Across(effect.slack[v], axes)));
      const float weight = pose.shares[v] * (excess * excess * excess + 1e-5f);
      laid += weight * effect.slack[v];
      own += weight * pose.own.slack[v];
      pressed_[v] += weight * effect.pressed[v];
      spacing += weight * wavelength * effect.width[v];
      merged_[v] += weight * kMerged * Smoothstep(kThin, kStiff, wavelength);
      // A weak pose has shallow folds.
      deep_[v] += weight * pose.own.height[v] * pose.shares[v] / pose.cloth.room[v];
      weights += weight;
    }
    if (!(weights > 0.0f)) continue;
    const Principal2 principal = PrincipalOf(Across(laid * (1.0f / weights), axes));
    const vec3 across = axes.x * principal.direction.x + axes.y * principal.direction.y;
    field_.along[v] = glm::cross(normals_[v], across);
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
  const std::vector<vec3> slopes = SlopesOf(mesh_, wide);
  for (std::size_t v = 0; v < wide.size(); ++v) {
    const vec3 along = field_.along[v], across = glm::cross(along, normals_[v]);
    const float a = glm::dot(slopes[v], along), c = glm::dot(slopes[v], across);
    // Slopes that would change the excess by half in 25 cm are not a bend.
    const float flat = 2.0f * std::max(wide[v], kLittle);
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
    const vec3 across = glm::cross(normals_[v], field.along[v]);
    field.along[v] = std::cos(size.turned) * field.along[v] + std::sin(size.turned) * across;
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
       .creases = {.least = 0.15f, .start = 0.19f, .longest = 7.0f, .seed = seed_ + 2}},
      // The pressed side of a sharp bend buckles in the diamonds of a tube under axial load
      // (Yoshimura 1955): its creases also turn to both sides.
      {.share = kFacets,
       .wide = 1.2f,
       .turned = kFacetTurn,
       .creases =
           {.least = 0.3f, .start = 0.4f, .variation = 0.15f, .longest = 4.0f, .seed = seed_ + 3}},
      {.share = kFacets,
       .wide = 1.2f,
       .turned = -kFacetTurn,
       .creases = {
           .least = 0.3f, .start = 0.4f, .variation = 0.15f, .longest = 4.0f, .seed = seed_ + 4}}};
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
  RoundFolds();
  gradients_ = SlopesOf(drawn_, heights_);
  MeasureCavities();
  return true;
}

// A kink between flanks that rise by 45 degrees, averaged by a Gaussian of standard deviation s,
// has the radius sqrt(pi / 2) s.
void ClothFolds::RoundFolds() {
  // The variance of one average over a vertex and its six neighbours, in squared edges.
  constexpr float kOfPass = 3.0f / 7.0f;
  constexpr int kMostPasses = 200;
  const float pass = kOfPass * MeanSquaredEdge(drawn_);
  if (poses_.empty() || !(pass > 0.0f)) return;
  std::vector<float> shares;  // of a pass
  for (const FineMesh::Vertex& vertex : drawn_.vertices()) {
    const float radius = vertex.Interpolate(std::span<const float>(radii_));
    shares.push_back(radius * radius * 2.0f / (kPi * pass));
  }
  const float most = std::min(std::ranges::max(shares), static_cast<float>(kMostPasses));
  const int passes = std::max(static_cast<int>(std::ceil(most)), 1);
  for (int k = 0; k < passes; ++k) {
    std::vector<float> mean = heights_;
    SmoothOver(drawn_, 1, &mean);
    for (std::size_t v = 0; v < heights_.size(); ++v) {
      const float share = std::min(shares[v] / static_cast<float>(passes), 1.0f);
      heights_[v] = std::lerp(heights_[v], mean[v], share);
    }
  }
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
