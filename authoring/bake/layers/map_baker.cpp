// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/map_baker.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/layers/blood_layer.h"
#include "authoring/bake/layers/parallel_for.h"
#include "authoring/paint/dilate.h"
#include "base/scalar.h"
#include "base/status.h"
#include "wrinkle/weights/vertex_influence.h"

namespace furrow::authoring {
namespace {

constexpr float kFineLines = 1.0f / 3.0f;  // wavelength relative to the main folds
constexpr int kGutter = 16;                // texels to grow planes beyond UV borders
constexpr float kFoldedMillimetres = 0.01f;
constexpr float kEdgesPerFold = 4.0f;  // of the mesh on which cloth is measured

const wrinkle::Region* FindRegion(const wrinkle::Rig& rig, const std::string& name) {
  const auto found =
      std::find_if(rig.regions.begin(), rig.regions.end(),
                   [&](const wrinkle::Region& region) { return region.name == name; });
  return found == rig.regions.end() ? nullptr : &*found;
}

// The renderer scales folds by the mask. The bake only needs to know where poses and strokes apply,
// so the value is 1 well inside the mask's soft border.
float Inside(float mask) { return Smoothstep(0.02f, 0.3f, mask); }

bool Matches(const std::string& region, const std::string& entry) {
  return region == entry || region == entry + "_l" || region == entry + "_r";
}

// A mask is in the atlas of the surface that its region's maps are drawn on. Other masks do not fit
// this surface.
bool Feeds(const wrinkle::Region& region, const std::string& map) {
  return std::any_of(region.feeds.begin(), region.feeds.end(),
                     [&](const wrinkle::Feed& feed) { return feed.map == map; });
}

// The joints whose skin weights mask a map of a region.
std::set<int> JointsOf(const character::Character& character, const wrinkle::Region& region,
                       const std::string& map) {
  std::set<int> joints;
  for (const wrinkle::Feed& feed : region.feeds) {
    if (feed.map != map) continue;
    for (const wrinkle::Feed::Source& source : feed.sources) {
      for (const wrinkle::Driver& driver : character.rig.drivers) {
        if (driver.name != source.driver) continue;
        for (const std::string& name :
             VisitFields(driver, [](const auto& fields) { return JointsInfluenced(fields); })) {
          joints.insert(character.skeleton.Find(name));
        }
      }
    }
  }
  return joints;
}

}  // namespace

MapBaker::MapBaker(const character::Character& character, const BakeSurface& surface,
                   const BakeOptions& options, std::string map, bool cloth)
    : character_(character),
      surface_(surface),
      options_(options),
      material_(MaterialOf(options, cloth)),
      map_(std::move(map)),
      cloth_(cloth),
      profile_(material_.sharpness),
      grain_(cloth ? 0.0f : material_.grain),
      sum_(surface.surface().positions().size()),
      blood_(surface.surface().positions().size()) {
  if (surface.fine_mesh() != nullptr) {
    cloth_folds_ = std::make_unique<ClothFolds>(*surface.fine_mesh(), *surface.relief_mesh(),
                                                options.ease, Depth(), options.seed);
  }
}

// The region's mask per welded vertex; empty if the mask is 1 everywhere.
std::vector<float> MapBaker::MaskOf(const std::string& region) const {
  const wrinkle::Region* found = FindRegion(character_.rig, region);
  if (found == nullptr) return {};
  std::vector<float> mask = surface_.MaskOf(character_, *found);
  for (float& value : mask) value = Inside(value);
  return mask;
}

void MapBaker::AddPose(const BakePose& pose, const BakePose* further) {
  const CompressionSolver::Field field =
      surface_.solver().Solve(pose.skin_matrices, pose.shape_weights, material_.max_compression);
  worst_ = std::max(worst_, field.worst);
  // A pose may move the whole body but feeds only its own region.
  std::vector<float> weights = MaskOf(pose.region);
  if (weights.empty()) weights.assign(field.tensors.size(), 1.0f);
  if (cloth_folds_ != nullptr) {
    cloth_folds_->Add(pose, ClothMask(pose.region, weights), FabricOf(pose.region),
                      EaseOf(pose.region), further);
  }
  for (float& weight : weights) weight *= pose.weight;
  sum_.Add(field.tensors, weights);
  blood_.Add(field.growth, weights);
  if (pose.region.empty()) return;
  auto region = std::find_if(regions_.begin(), regions_.end(),
                             [&](const RegionFolds& r) { return r.region == pose.region; });
  if (region == regions_.end()) {
    regions_.push_back({pose.region, std::vector<float>(field.tensors.size(), 0.0f)});
    region = regions_.end() - 1;
  }
  for (std::size_t v = 0; v < field.tensors.size(); ++v) {
    // Without the region's current mask, because the suggested mask may replace it.
    region->compression[v] =
        std::max(region->compression[v], pose.weight * PrincipalOf(field.tensors[v]).large);
  }
}

void MapBaker::AddStroke(const BakeStroke& stroke) { strokes_.push_back(&stroke); }

// Cloth folds where the region is drawn: `painted` is the texture mask, or 1 everywhere. A region
// masked by skinning is drawn where its drivers' joints move the cloth.
std::vector<float> MapBaker::ClothMask(const std::string& name, std::vector<float> painted) const {
  const wrinkle::Region* region = FindRegion(character_.rig, name);
  if (region == nullptr || region->mask.kind != wrinkle::Mask::Kind::kSkinning) return painted;
  const std::set<int> joints = JointsOf(character_, *region, map_);
  for (std::size_t v = 0; v < painted.size(); ++v) {
    const character::Vertex& vertex = surface_.surface().SourceOf(v);
    painted[v] = 0.0f;
    for (int k = 0; k < 4; ++k) {
      if (!joints.contains(static_cast<int>(vertex.joints[k]))) continue;
      painted[v] = std::max(painted[v], wrinkle::Lambda(region->mask.lambda, vertex.skin_weights[k],
                                                        region->mask.smooth_width));
    }
  }
  return painted;
}

// Folds that the mesh's edges or the texels cannot hold are wider.
FabricFolds MapBaker::FabricOf(const std::string& region) const {
  const auto entry = std::ranges::find_if(
      options_.fabrics, [&](const RegionFabric& one) { return one.Covers(region); });
  FabricFolds folds = FoldsOf(entry == options_.fabrics.end() ? options_.fabric : entry->fabric);
  const std::span<const float> sides = surface_.texel_metres();
  double sum = 0.0;
  for (const float side : sides) sum += static_cast<double>(side);
  const auto texel =
      static_cast<float>(sum / static_cast<double>(std::max<std::size_t>(sides.size(), 1)));
  folds.wavelength = std::max(
      {folds.wavelength, kEdgesPerFold * surface_.fine_mesh()->edge(), kTexelsPerWave * texel});
  return folds;
}

ClothEase MapBaker::EaseOf(const std::string& region) const {
  const auto entry = std::ranges::find_if(
      options_.eases, [&](const RegionEase& one) { return one.Covers(region); });
  return entry == options_.eases.end() ? ClothEase() : entry->ease;
}

// A value per welded vertex from values of regions, by name without side. Regions mix by their
// masks; what the masks leave over counts as `other`.
std::vector<float> MapBaker::ByRegion(std::span<const std::pair<std::string, float>> values,
                                      float other) const {
  const std::size_t count = surface_.surface().positions().size();
  std::vector<float> sums(count, 0.0f), shares(count, 0.0f);
  for (const auto& [name, value] : values) {
    for (const wrinkle::Region& region : character_.rig.regions) {
      if (!Matches(region.name, name) || !Feeds(region, map_)) continue;
      const std::vector<float> mask = surface_.MaskOf(character_, region);
      for (std::size_t v = 0; v < mask.size(); ++v) {
        sums[v] += mask[v] * value;
        shares[v] += mask[v];
      }
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    const float rest = std::max(1.0f - shares[v], 0.0f);
    sums[v] = (sums[v] + rest * other) / (shares[v] + rest);
  }
  return sums;
}

// Metres per welded vertex. Regions mix in the logarithm, so 4 mm and 16 mm meet at 8 mm.
std::vector<float> MapBaker::Wavelengths() const {
  const auto log_of = [](float mm) { return std::log(mm * kMetresPerMillimetre); };
  std::vector<std::pair<std::string, float>> values;
  for (const BakeRegionWavelength& entry : options_.wavelengths) {
    values.emplace_back(entry.region, log_of(entry.wavelength_mm));
  }
  std::vector<float> wavelengths = ByRegion(values, log_of(material_.wavelength_mm));
  for (float& wavelength : wavelengths) wavelength = std::exp(wavelength);
  return wavelengths;
}

// Metres per welded vertex: a shorter wave would have too few texels and alias.
std::vector<float> MapBaker::Smallest() const {
  std::vector<float> smallest(surface_.texel_metres().begin(), surface_.texel_metres().end());
  for (float& side : smallest) side *= kTexelsPerWave;
  return smallest;
}

Status MapBaker::MakeLayers(const StrokeLayer& strokes, const std::vector<Tensor2>& tensors,
                            BakeProgress* progress) {
  const FoldField field(surface_.surface(), strokes, tensors, Wavelengths(), Smallest());
  std::vector<FoldLayer::Options> wanted;
  FoldLayer::Options options;
  options.material = material_;
  options.height = Depth();
  options.seed = options_.seed;
  wanted.push_back(options);
  if (material_.crossing > 0.0f) {
    options.crossing = true;
    options.height = Depth() * material_.crossing;
    // Other seeds, so that layers do not place their kernels at the same points.
    options.seed = options_.seed + 101;
    wanted.push_back(options);
  }
  if (material_.fine_lines > 0.0f) {
    options.crossing = false;
    options.wavelength_scale = kFineLines;
    options.height = Depth() * material_.fine_lines;
    options.seed = options_.seed + 202;
    wanted.push_back(options);
  }
  for (const FoldLayer::Options& layer : wanted) {
    auto made = FoldLayer::Create(field, profile_, layer, progress);
    FURROW_RETURN_IF_ERROR(made);
    layers_.push_back(std::move(*made));
  }
  return {};
}

// Layers add up. A stroke fades them out by `keep`; the product rule gives the slope where `keep`
// changes.
FoldSample MapBaker::FoldsAt(const SurfacePoint& point, const glm::vec3& tangent,
                             const glm::vec3& bitangent, const StrokeLayer& strokes) const {
  FoldSample sum;
  if (cloth_folds_ != nullptr) sum = cloth_folds_->At(point, tangent, bitangent);
  for (const auto& layer : layers_) {
    const FoldSample fold = layer->At(point, tangent, bitangent);
    sum.height += fold.height;
    sum.slope += fold.slope;
    sum.cavity *= fold.cavity;
  }
  const StrokeLayer::Sample drawn = strokes.At(point, tangent, bitangent);
  sum.slope = sum.slope * drawn.keep + drawn.keep_slope * sum.height + drawn.fold.slope;
  sum.height = sum.height * drawn.keep + drawn.fold.height;
  sum.cavity = (1.0f - drawn.keep * (1.0f - sum.cavity)) * drawn.fold.cavity;
  return sum;
}

FoldSample MapBaker::TexelFold(const SurfaceTexel& texel, const StrokeLayer& strokes) const {
  const SurfacePoint place = PlaceOf(texel);
  const FoldSample fold = FoldsAt(place, texel.tangent, texel.bitangent, strokes);
  const float side = surface_.surface().Interpolate(surface_.texel_metres(), place);
  return grain_.Apply(fold, texel.position, texel.tangent, texel.bitangent, kTexelsPerWave * side);
}

// Every texel belongs to one triangle, so threads write to separate places and need no lock.
bool MapBaker::FillTexels(const StrokeLayer& strokes, BakeProgress* progress, BakedMap* map) const {
  const std::size_t count =
      static_cast<std::size_t>(map->width) * static_cast<std::size_t>(map->height);
  map->height_mm.assign(count, 0.0f);
  map->derivative.assign(2 * count, 0.0f);
  map->cavity.assign(count, 1.0f);
  map->covered.assign(count, 0);
  const std::vector<SurfaceTexel>& texels = surface_.texels();
  const auto work = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const SurfaceTexel& texel = texels[i];
      const FoldSample fold = TexelFold(texel, strokes);
      const std::size_t at = map->IndexOf(texel.x, texel.y);
      map->height_mm[at] = fold.height / kMetresPerMillimetre;
      // A normal map's x / z is minus the slope of the height.
      map->derivative[2 * at] = -fold.slope.x;
      map->derivative[2 * at + 1] = -fold.slope.y;
      map->cavity[at] = fold.cavity;
      map->covered[at] = 1;
    }
  };
  return ParallelFor(texels.size(), options_.threads, work,
                     [&](float done) { return progress->Report(done); });
}

// After heights and cavities, because folds move the blood.
void MapBaker::AddBlood(BakedMap* map) const {
  std::vector<std::pair<std::string, float>> arms, amounts;
  for (const SkinSite& site : kSkinSites) {
    arms.emplace_back(site.region, BendArm(site));
    amounts.emplace_back(site.region, site.blood);
  }
  FillBlood(surface_,
            {.blood = blood_.Take(),
             .arms = ByRegion(arms, BendArm(kOtherSkin)),
             .amounts = ByRegion(amounts, kOtherSkin.blood),
             .wavelengths = Wavelengths()},
            map);
}

void MapBaker::Measure(const std::vector<float>& compression, const StrokeLayer& strokes,
                       BakedMap* map) const {
  BakedMap::Statistics& statistics = map->statistics;
  statistics.worst_compression = worst_;
  statistics.overlapping_texels = surface_.overlaps();
  double sum = 0.0, sides = 0.0;
  std::vector<char> seen(strokes.num_strokes(), 0);
  for (const SurfaceTexel& texel : surface_.texels()) {
    const std::size_t at = map->IndexOf(texel.x, texel.y);
    ++statistics.covered_texels;
    strokes.MarkFolds(PlaceOf(texel), &seen);
    const float height = map->height_mm[at];
    statistics.deepest_mm = std::max(statistics.deepest_mm, -height);
    statistics.highest_mm = std::max(statistics.highest_mm, height);
    statistics.steepest = std::max(
        statistics.steepest, std::hypot(map->derivative[2 * at], map->derivative[2 * at + 1]));
    if (std::abs(height) < kFoldedMillimetres) continue;
    ++statistics.folded_texels;
    const SurfacePoint place = PlaceOf(texel);
    sum += static_cast<double>(surface_.surface().Interpolate(compression, place));
    sides += static_cast<double>(surface_.surface().Interpolate(surface_.texel_metres(), place));
  }
  statistics.strokes = static_cast<int>(std::count(seen.begin(), seen.end(), 1));
  if (statistics.folded_texels > 0) {
    statistics.mean_compression =
        static_cast<float>(sum / static_cast<double>(statistics.folded_texels));
    statistics.texel_mm =
        static_cast<float>(sides / static_cast<double>(statistics.folded_texels)) /
        kMetresPerMillimetre;
  }
}

// Measures the requested wavelengths where strain makes folds, and how far the texels force them to
// be wider.
void MapBaker::MeasureWavelengths(BakedMap* map) const {
  BakedMap::Statistics& statistics = map->statistics;
  if (cloth_folds_ != nullptr) {
    const auto [least, most] = cloth_folds_->Wavelengths();
    statistics.finest_mm = least / kMetresPerMillimetre;
    statistics.coarsest_mm = most / kMetresPerMillimetre;
    return;
  }
  const std::vector<float> asked = Wavelengths(), smallest = Smallest();
  const float scale = material_.fine_lines > 0.0f ? kFineLines : 1.0f;
  float widened = 1.0f;
  for (const SurfaceTexel& texel : surface_.texels()) {
    const std::size_t at = map->IndexOf(texel.x, texel.y);
    if (std::abs(map->height_mm[at]) < kFoldedMillimetres) continue;
    const SurfacePoint place = PlaceOf(texel);
    const float wavelength =
        scale * surface_.surface().Interpolate(asked, place) / kMetresPerMillimetre;
    const float least = surface_.surface().Interpolate(smallest, place) / kMetresPerMillimetre;
    if (statistics.finest_mm == 0.0f) statistics.finest_mm = wavelength;
    statistics.finest_mm = std::min(statistics.finest_mm, wavelength);
    statistics.coarsest_mm = std::max(statistics.coarsest_mm, wavelength / scale);
    if (!(least > wavelength)) continue;
    ++statistics.widened_texels;
    if (least <= widened * wavelength) continue;
    widened = least / wavelength;
    statistics.widened_from_mm = wavelength;
    statistics.widened_to_mm = least;
  }
}

BakedMask MapBaker::SuggestMask(const RegionFolds& folds) const {
  // The mask is 1 where the region's poses reach half of their largest compression.
  const float most = *std::max_element(folds.compression.begin(), folds.compression.end());
  const float full = std::max(0.5f * most, 2.0f * material_.threshold + 1e-4f);
  std::vector<float> values;
  for (const float compression : folds.compression) {
    values.push_back(Smoothstep(0.5f * material_.threshold, full, compression));
  }
  BakedMask mask;
  mask.region = folds.region;
  mask.width = mask.height = std::max(options_.size / 4, 64);
  const auto count = static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height);
  mask.texels.assign(count, 0.0f);
  std::vector<std::uint8_t> covered(count, 0);
  for (const SurfaceTexel& texel :
       RasterizeSurface(surface_.surface().mesh(), mask.width, mask.height)) {
    const std::size_t at =
        static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(mask.width) +
        static_cast<std::size_t>(texel.x);
    mask.texels[at] = surface_.surface().Interpolate(values, PlaceOf(texel));
    covered[at] = 1;
  }
  Dilation(covered, mask.width, mask.height, kGutter / 4).Apply(1, &mask.texels);
  return mask;
}

Result<std::unique_ptr<BakedMap>> MapBaker::Bake(float from, float to, BakeProgress* progress) {
  // Completed share of the time after each part.
  constexpr float kStrokes = 0.1f, kFolds = 0.35f, kClothFolds = 0.7f;
  const auto at = [&](float share) { return from + (to - from) * share; };
  progress->BeginPart(from, at(kStrokes));
  std::vector<std::vector<float>> masks;
  for (const BakeStroke* stroke : strokes_) masks.push_back(MaskOf(stroke->region));
  const auto strokes =
      StrokeLayer::Create(surface_.surface(), strokes_, std::move(masks), Depth(), progress);
  FURROW_RETURN_IF_ERROR(strokes);
  const std::vector<Tensor2> tensors = sum_.Take();
  std::vector<float> compression;
  for (const Tensor2& tensor : tensors) compression.push_back(PrincipalOf(tensor).large);
  const float folds_end = cloth_ ? kClothFolds : kFolds;
  progress->BeginPart(at(kStrokes), at(folds_end));
  if (cloth_folds_ == nullptr) {
    FURROW_RETURN_IF_ERROR(MakeLayers(**strokes, tensors, progress));
  } else if (!cloth_folds_->Solve(options_.threads, progress)) {
    return BakeProgress::CancelledStatus();
  }

  auto map = std::make_unique<BakedMap>();
  map->map = map_;
  map->cloth = cloth_;
  map->width = map->height = options_.size;
  progress->BeginPart(at(folds_end), to);
  if (!FillTexels(**strokes, progress, map.get())) return BakeProgress::CancelledStatus();
  AddBlood(map.get());
  Measure(compression, **strokes, map.get());
  MeasureWavelengths(map.get());
  // Grows the planes beyond UV borders, where filtering and mip levels read them.
  const Dilation dilation(map->covered, map->width, map->height, kGutter);
  dilation.Apply(1, &map->height_mm);
  dilation.Apply(2, &map->derivative);
  dilation.Apply(1, &map->cavity);
  dilation.Apply(1, &map->blood);
  for (const RegionFolds& region : regions_) map->masks.push_back(SuggestMask(region));
  return map;
}

}  // namespace furrow::authoring
