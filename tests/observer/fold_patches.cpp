// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_patches.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>

#include "authoring/bake/bake_poses.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/compression.h"
#include "authoring/paint/strokes.h"

namespace furrow::observer {
namespace {

using authoring::BakePose;
using authoring::BakeStroke;
using authoring::BakeSurface;
using authoring::SurfaceTexel;
using authoring::Tensor2;
using character::Character;
using character::Picture;

constexpr float kLeastRegionMask = 0.5f;
constexpr float kDrawnWidths = 1.25f;    // to the far flank of a stroke's ridges
constexpr float kMillimetres = 1000.0f;  // per metre

const Picture* FindPicture(const Character& character, const std::string& name) {
  const int index = character.FindRigPicture(name);
  return index < 0 ? nullptr : &character.pictures[static_cast<std::size_t>(index)];
}

double WavelengthOf(const std::string& region) {
  const authoring::BakeOptions options;
  for (const authoring::BakeRegionWavelength& entry : options.wavelengths) {
    if (region == entry.region || region == entry.region + "_l" || region == entry.region + "_r") {
      return static_cast<double>(entry.wavelength_mm);
    }
  }
  return static_cast<double>(options.skin.wavelength_mm);
}

// A fold stroke on the surface.
struct DrawnLine {
  authoring::StrokeLine line;
  float reach;  // metres
};

std::vector<DrawnLine> LinesOf(const authoring::Surface& surface,
                               std::span<const BakeStroke> strokes, const std::string& map) {
  std::vector<DrawnLine> lines;
  for (const BakeStroke& stroke : strokes) {
    if (stroke.kind != BakeStroke::Kind::kFold || std::ranges::count(stroke.maps, map) == 0) {
      continue;
    }
    std::vector<glm::vec3> points =
        stroke.smooth ? authoring::Smooth(stroke.points, 8) : stroke.points;
    for (glm::vec3& point : points) point = surface.Nearest(point).position;
    lines.push_back({authoring::StrokeLine(std::move(points)),
                     kDrawnWidths * stroke.width_mm * authoring::kMetresPerMillimetre});
  }
  return lines;
}

// The character's skin, with all that its patches share.
class PatchMaker {
 public:
  // `size`: width and height of the texels of `surface`.
  PatchMaker(const Character& character, const BakeSurface& surface, int size,
             std::span<const BakePose> poses, std::span<const BakeStroke> strokes)
      : character_(character), surface_(surface), size_(size), poses_(poses), strokes_(strokes) {}

  [[nodiscard]] FoldPatch Make(const wrinkle::Region& region,
                               const wrinkle::WrinkleMap& map) const {
    const Picture& mask = *FindPicture(character_, region.mask.texture);
    const std::vector<Tensor2> strain = Strain(region.name, map.name);
    const std::vector<DrawnLine> lines = LinesOf(surface_.surface(), strokes_, map.name);
    FoldPatch patch;
    patch.wavelength = WavelengthOf(region.name);
    for (const SurfaceTexel& texel : surface_.texels()) {
      const glm::vec2 uv = (glm::vec2(texel.x, texel.y) + 0.5f) / static_cast<float>(size_);
      if (character::ChannelAt(mask, uv, region.mask.channel) < kLeastRegionMask) continue;
      FoldPlace place = PlaceAt(texel, uv, map);
      SetStrain(texel, strain, &place);
      place.drawn = std::ranges::any_of(lines, [&](const DrawnLine& drawn) {
        return drawn.line.FindNearest(texel.position).distance < drawn.reach;
      });
      patch.places.push_back(place);
    }
    return patch;
  }

 private:
  // Per vertex, in its axes.
  [[nodiscard]] std::vector<Tensor2> Strain(const std::string& region,
                                            const std::string& map) const {
    const authoring::BakeMaterial skin = authoring::BakeOptions().skin;
    const std::size_t vertices = surface_.surface().positions().size();
    authoring::CompressionSum sum(vertices);
    for (const BakePose& pose : poses_) {
      if (pose.map != map || pose.region != region) continue;
      const auto field =
          surface_.solver().Solve(pose.skin_matrices, pose.shape_weights, skin.max_compression);
      sum.Add(field.tensors, std::vector<float>(vertices, pose.weight));
    }
    return sum.Take();
  }

  // The place without its strain.
  [[nodiscard]] FoldPlace PlaceAt(const SurfaceTexel& texel, const glm::vec2& uv,
                                  const wrinkle::WrinkleMap& map) const {
    const Picture& normals = *FindPicture(character_, map.normal);
    const auto normal = [&](int c) { return 2.0f * character::ChannelAt(normals, uv, c) - 1.0f; };
    FoldPlace place;
    place.position = kMillimetres * texel.position;
    place.normal = texel.normal;
    const float side =
        kMillimetres * surface_.surface().Interpolate(surface_.texel_metres(), PlaceOf(texel));
    place.area = side * side;
    // The normal's x / z is minus the slope.
    place.slope = (normal(0) * texel.tangent + normal(1) * texel.bitangent) / -normal(2);
    if (const Picture* heights = FindPicture(character_, map.height)) {
      place.height = map.height_mm * (2.0f * character::ChannelAt(*heights, uv, 0) - 1.0f);
    }
    return place;
  }

  void SetStrain(const SurfaceTexel& texel, std::span<const Tensor2> strain,
                 FoldPlace* place) const {
    const authoring::Principal2 principal =
        authoring::PrincipalOf(surface_.surface().Interpolate(strain, PlaceOf(texel)));
    const wrinkle::SurfaceAxes& axes = surface_.surface().triangles()[texel.triangle].axes;
    place->compression = std::max(principal.large, 0.0f);
    place->crossing = std::max(principal.small, 0.0f);
    place->direction = axes.x * principal.direction.x + axes.y * principal.direction.y;
  }

  const Character& character_;
  const BakeSurface& surface_;
  int size_;
  std::span<const BakePose> poses_;
  std::span<const BakeStroke> strokes_;
};

// The skin map of a feed with a normal picture, or null.
const wrinkle::WrinkleMap* SkinMapOf(const Character& character, const wrinkle::Feed& feed) {
  const auto& maps = character.rig.wrinkle_maps;
  const auto map = std::ranges::find(maps, feed.map, &wrinkle::WrinkleMap::name);
  if (map == maps.end() || authoring::GoesOnCloth(character, *map)) return nullptr;
  return FindPicture(character, map->normal) == nullptr ? nullptr : &*map;
}

}  // namespace

Result<std::vector<std::pair<std::string, FoldPatch>>> SkinPatches(
    const Character& character, std::span<const BakeStroke> strokes) {
  const auto poses = authoring::CollectBakePoses(character);
  FURROW_RETURN_IF_ERROR(poses);
  std::vector<std::pair<std::string, FoldPatch>> patches;
  std::unique_ptr<BakeSurface> surface;
  int size = 0;
  for (const wrinkle::Region& region : character.rig.regions) {
    if (FindPicture(character, region.mask.texture) == nullptr) continue;
    for (const wrinkle::Feed& feed : region.feeds) {
      const wrinkle::WrinkleMap* map = SkinMapOf(character, feed);
      if (map == nullptr) continue;
      const int width = FindPicture(character, map->normal)->width;
      if (width != size) {
        authoring::BakeProgress progress({});
        authoring::BakeOptions options;
        options.size = size = width;
        auto made = BakeSurface::Create(character, false, options, &progress);
        FURROW_RETURN_IF_ERROR(made);
        surface = std::move(*made);
      }
      const PatchMaker maker(character, *surface, size, poses->poses, strokes);
      patches.emplace_back(region.name + "." + map->name, maker.Make(region, *map));
    }
  }
  return patches;
}

}  // namespace furrow::observer
