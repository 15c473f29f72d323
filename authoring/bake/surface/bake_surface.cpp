// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/bake_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "authoring/bake/surface/uv_check.h"

namespace furrow::authoring {
namespace {

bool HasKind(const character::Character& character, character::Material::Kind kind) {
  return std::any_of(
      character.meshes.begin(), character.meshes.end(), [&](const character::Mesh& mesh) {
        return mesh.material >= 0 &&
               character.materials[static_cast<std::size_t>(mesh.material)].kind == kind;
      });
}

character::Material::Kind KindOf(const character::Character& character,
                                 const character::Mesh& mesh) {
  if (mesh.material < 0) return character::Material::Kind::kOther;
  return character.materials[static_cast<std::size_t>(mesh.material)].kind;
}

// Unmarked materials count as skin if no material is marked as skin, as in the renderer.
bool Belongs(const character::Character& character, const character::Mesh& mesh, bool cloth) {
  if (mesh.material >= 0 &&
      !character.materials[static_cast<std::size_t>(mesh.material)].wrinkles) {
    return false;
  }
  switch (KindOf(character, mesh)) {
    case character::Material::Kind::kSkin: return !cloth;
    case character::Material::Kind::kCloth: return cloth;
    case character::Material::Kind::kEye:
    case character::Material::Kind::kHair:
    case character::Material::Kind::kShade: return false;
    case character::Material::Kind::kOther: break;
  }
  return !cloth && !HasKind(character, character::Material::Kind::kSkin);
}

float UvArea(const character::Vertex& a, const character::Vertex& b, const character::Vertex& c) {
  const glm::vec2 p = b.uv - a.uv, q = c.uv - a.uv;
  return 0.5f * std::abs(p.x * q.y - p.y * q.x);
}

// Where UVs overlap, the half at the larger x (the left half of a character that faces +Z) owns the
// texels. Mirrored halves then show the folds of one half, and not patches of both.
std::vector<SurfaceTexel> Rasterize(const character::Mesh& mesh, int size, std::int64_t* overlaps) {
  std::vector<SurfaceTexel> texels = RasterizeSurface(mesh, size, size, overlaps);
  const auto tolerable = kTolerableUvOverlap * static_cast<float>(texels.size());
  if (static_cast<float>(*overlaps) <= tolerable) return texels;
  std::vector<std::uint32_t> order(mesh.indices.size() / 3);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_partition(order.begin(), order.end(), [&](std::uint32_t t) {
    float x = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) x += mesh.vertices[mesh.indices[3 * t + k]].position.x;
    return x >= 0.0f;
  });
  character::Mesh ordered;
  ordered.vertices = mesh.vertices;
  for (const std::uint32_t t : order) {
    for (std::size_t k = 0; k < 3; ++k) ordered.indices.push_back(mesh.indices[3 * t + k]);
  }
  texels = RasterizeSurface(ordered, size, size);
  for (SurfaceTexel& texel : texels) texel.triangle = order[texel.triangle];
  return texels;
}

}  // namespace

std::vector<int> MeshesOn(const character::Character& character, bool cloth) {
  std::vector<int> meshes;
  for (std::size_t i = 0; i < character.meshes.size(); ++i) {
    if (Belongs(character, character.meshes[i], cloth)) meshes.push_back(static_cast<int>(i));
  }
  return meshes;
}

bool GoesOnCloth(const character::Character& character, const wrinkle::WrinkleMap& map) {
  switch (map.surface) {
    case wrinkle::WrinkleMap::Surface::kSkin: return false;
    case wrinkle::WrinkleMap::Surface::kCloth: return true;
    case wrinkle::WrinkleMap::Surface::kAny: break;
  }
  return !HasKind(character, character::Material::Kind::kSkin) &&
         HasKind(character, character::Material::Kind::kCloth);
}

bool FoldsCloth(const character::Character& character, const wrinkle::Feed& feed) {
  const auto& maps = character.rig.wrinkle_maps;
  const auto map = std::ranges::find(maps, feed.map, &wrinkle::WrinkleMap::name);
  return map != maps.end() && GoesOnCloth(character, *map);
}

Result<std::unique_ptr<BakeSurface>> BakeSurface::Create(const character::Character& character,
                                                         bool cloth, const BakeOptions& options,
                                                         BakeProgress* progress) {
  const std::string kind = cloth ? "cloth" : "skin";
  std::vector<const character::Mesh*> meshes;
  float area = 0.0f;
  for (const int index : MeshesOn(character, cloth)) {
    const character::Mesh& mesh = character.meshes[static_cast<std::size_t>(index)];
    meshes.push_back(&mesh);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      area += UvArea(mesh.vertices[mesh.indices[i]], mesh.vertices[mesh.indices[i + 1]],
                     mesh.vertices[mesh.indices[i + 2]]);
    }
  }
  if (meshes.empty()) {
    return Status(StatusCode::kInvalidArgument, "no mesh is " + kind, character.name,
                  "name a material '" + kind + "' or change the map's surface in the rig");
  }
  // Also true for NaN.
  if (!(area > 1e-9f)) {
    return Status(StatusCode::kInvalidArgument, "the " + kind + " has no UVs", character.name,
                  "unwrap the mesh; wrinkle maps use its UV atlas");
  }
  const float smoothing = MaterialOf(options, cloth).smoothing_mm * kMetresPerMillimetre;
  auto made =
      std::unique_ptr<BakeSurface>(new BakeSurface(meshes, smoothing, options.size, progress));
  if (progress->cancelled()) return BakeProgress::CancelledStatus();
  const auto triangles = made->surface_.triangles();
  const bool extent = std::any_of(triangles.begin(), triangles.end(),
                                  [](const auto& t) { return t.strain.has_value(); });
  if (!extent || made->texels_.empty()) {
    return Status(StatusCode::kInvalidArgument, "no triangle of the " + kind + " has any area",
                  character.name, "check that the mesh and its UVs are not collapsed to a point");
  }
  if (cloth) {
    const float edge = made->ClothEdge();
    made->fine_mesh_ = std::make_unique<FineMesh>(made->surface_, edge);
    made->relief_mesh_ = std::make_unique<FineMesh>(made->surface_, 0.5f * edge);
  }
  return made;
}

// Short enough for the narrowest folds of the fabrics. Where that would take too many triangles,
// because a model is huge or in other units than metres, edges are longer and folds wider.
float BakeSurface::ClothEdge() const {
  constexpr float kEdge = 0.007f;  // metres
  constexpr float kMostTriangles = 4e5f;
  float area = 0.0f;
  for (const Surface::Triangle& triangle : surface_.triangles()) area += triangle.area;
  return std::max(kEdge, std::sqrt(2.0f * area / kMostTriangles));
}

BakeSurface::BakeSurface(std::span<const character::Mesh* const> meshes, float smoothing, int size,
                         BakeProgress* progress)
    : surface_(meshes),
      solver_(surface_, smoothing, progress),
      texels_(Rasterize(surface_.mesh(), size, &overlaps_)),
      texel_metres_(TexelSides(size)) {}

// The root of the ratio of areas around a vertex, on the surface and in the atlas. 0 without UVs.
std::vector<float> BakeSurface::TexelSides(int size) const {
  const character::Mesh& mesh = surface_.mesh();
  const auto uv_area = [&](std::size_t t) {
    return UvArea(mesh.vertices[mesh.indices[3 * t]], mesh.vertices[mesh.indices[3 * t + 1]],
                  mesh.vertices[mesh.indices[3 * t + 2]]);
  };
  std::vector<float> sides;
  sides.reserve(surface_.positions().size());
  for (std::size_t v = 0; v < surface_.positions().size(); ++v) {
    float area = 0.0f, uv = 0.0f;
    for (const std::uint32_t t : surface_.Around(v)) {
      area += surface_.triangles()[t].area;
      uv += uv_area(t);
    }
    sides.push_back(uv > 1e-12f ? std::sqrt(area / uv) / static_cast<float>(size) : 0.0f);
  }
  return sides;
}

std::vector<float> BakeSurface::MaskOf(const character::Character& character,
                                       const wrinkle::Region& region) const {
  if (region.mask.kind != wrinkle::Mask::Kind::kTexture) return {};
  const int index = character.FindRigPicture(region.mask.texture);
  if (index < 0) return {};
  const character::Picture& picture = character.pictures[static_cast<std::size_t>(index)];
  std::vector<float> mask;
  mask.reserve(surface_.positions().size());
  for (std::size_t v = 0; v < surface_.positions().size(); ++v) {
    mask.push_back(character::ChannelAt(picture, surface_.SourceOf(v).uv, region.mask.channel));
  }
  return mask;
}

}  // namespace furrow::authoring
