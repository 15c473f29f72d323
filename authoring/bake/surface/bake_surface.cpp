// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/bake_surface.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::character::bake {
namespace {

constexpr float kMetres = 0.001f;  // a millimetre

bool HasKind(const Character& character, Material::Kind kind) {
  return std::any_of(character.meshes.begin(), character.meshes.end(), [&](const Mesh& mesh) {
    return mesh.material >= 0 &&
           character.materials[static_cast<std::size_t>(mesh.material)].kind == kind;
  });
}

Material::Kind KindOf(const Character& character, const Mesh& mesh) {
  if (mesh.material < 0) return Material::Kind::kOther;
  return character.materials[static_cast<std::size_t>(mesh.material)].kind;
}

bool Belongs(const Character& character, const Mesh& mesh, bool cloth) {
  switch (KindOf(character, mesh)) {
    case Material::Kind::kSkin: return !cloth;
    case Material::Kind::kCloth: return cloth;
    case Material::Kind::kEye:
    case Material::Kind::kHair: return false;
    case Material::Kind::kOther: break;
  }
  return !cloth && !HasKind(character, Material::Kind::kSkin);
}

float UvArea(const Vertex& a, const Vertex& b, const Vertex& c) {
  const glm::vec2 p = b.uv - a.uv, q = c.uv - a.uv;
  return 0.5f * std::abs(p.x * q.y - p.y * q.x);
}

}  // namespace

std::vector<int> MeshesOn(const Character& character, bool cloth) {
  std::vector<int> meshes;
  for (std::size_t i = 0; i < character.meshes.size(); ++i) {
    if (Belongs(character, character.meshes[i], cloth)) meshes.push_back(static_cast<int>(i));
  }
  return meshes;
}

bool GoesOnCloth(const Character& character, const wrinkle::WrinkleMap& map) {
  switch (map.surface) {
    case wrinkle::WrinkleMap::Surface::kSkin: return false;
    case wrinkle::WrinkleMap::Surface::kCloth: return true;
    case wrinkle::WrinkleMap::Surface::kAny: break;
  }
  return !HasKind(character, Material::Kind::kSkin) && HasKind(character, Material::Kind::kCloth);
}

Result<std::unique_ptr<BakeSurface>> BakeSurface::Create(const Character& character, bool cloth,
                                                         const BakeOptions& options, Pace* pace) {
  const std::string kind = cloth ? "cloth" : "skin";
  std::vector<const Mesh*> meshes;
  float area = 0.0f;
  for (const int index : MeshesOn(character, cloth)) {
    const Mesh& mesh = character.meshes[static_cast<std::size_t>(index)];
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
  if (!(area > 1e-9f)) {
    return Status(StatusCode::kInvalidArgument, "the " + kind + " has no UVs", character.name,
                  "unwrap the mesh: wrinkle maps lie in its UV atlas");
  }
  const float smoothing = MaterialOf(options, cloth).smoothing_mm * kMetres;
  auto made = std::unique_ptr<BakeSurface>(new BakeSurface(meshes, smoothing, options.size, pace));
  if (pace->stopped()) return Pace::Cancelled();
  const auto triangles = made->surface_.triangles();
  const bool extent = std::any_of(triangles.begin(), triangles.end(),
                                  [](const auto& t) { return t.strain.has_value(); });
  if (!extent || made->texels_.empty()) {
    return Status(StatusCode::kInvalidArgument, "no triangle of the " + kind + " has any extent",
                  character.name);
  }
  return made;
}

BakeSurface::BakeSurface(std::span<const Mesh* const> meshes, float smoothing, int size, Pace* pace)
    : surface_(meshes),
      solver_(surface_, smoothing, pace),
      texels_(paint::RasterizeUv(surface_.mesh(), size, size, &overlaps_)),
      texel_metres_(TexelSides(size)) {}

std::vector<float> BakeSurface::TexelSides(int size) const {
  const Mesh& mesh = surface_.mesh();
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

std::vector<float> BakeSurface::MaskOf(const Character& character,
                                       const wrinkle::Region& region) const {
  if (region.mask.kind != wrinkle::Mask::Kind::kTexture) return {};
  const int index = character.FindRigPicture(region.mask.texture);
  if (index < 0) return {};
  const Picture& picture = character.pictures[static_cast<std::size_t>(index)];
  std::vector<float> mask;
  mask.reserve(surface_.positions().size());
  for (std::size_t v = 0; v < surface_.positions().size(); ++v) {
    mask.push_back(ChannelAt(picture, surface_.SourceOf(v).uv, region.mask.channel));
  }
  return mask;
}

}  // namespace furrow::character::bake
