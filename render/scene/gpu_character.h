// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "character/character.h"
#include "render/gl/gl_objects.h"
#include "render/mesh/gpu_mesh.h"
#include "render/wrinkles/derivative_map.h"
#include "render/wrinkles/mask_regions.h"
#include "render/wrinkles/wrinkle_heights.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// Limit of the summed morph targets of one mesh for one subject.
inline constexpr std::size_t kMaxMorphBytes = std::size_t{1} << 26;

// Mirrors the Material block of shaders/scene/surface_frag.glsl (std140).
struct MaterialBlock {
  glm::vec4 base_colour;
  float roughness;
  float specular;
  float alpha_cutoff;
  float cavity_albedo;
  float thickness;
  float padding[3];
  glm::vec2 texture_scale;
  glm::vec2 texture_offset;
  glm::vec4 emission;  // a: not used
};
static_assert(sizeof(MaterialBlock) == 80);

// The block of a material with the look of a pose; see character::LookOf().
[[nodiscard]] MaterialBlock MakeMaterialBlock(const character::Material& material,
                                              const character::MaterialLook& look);

// A material on the GPU. The textures belong to the GpuCharacter.
struct GpuMaterial {
  character::Material source;
  std::vector<character::MaterialBind> binds;  // how shapes change it; see MaterialBlocks
  gl::Buffer block;                            // MaterialBlock without binds
  GLuint base_colour = 0;                      // texture names; 0: none
  GLuint derivatives = 0;                      // slopes of the normal map
  GLuint roughness = 0;
  GLuint emission = 0;
  GLuint thickness = 0;
  character::Material::Kind kind = character::Material::Kind::kOther;
  WrinkleGroup group = WrinkleGroup::kNone;
  float cavity_albedo = 0.0f;  // linear; base colours with less green are painted hollows
  bool alpha_test = false;
  bool double_sided = false;
  bool emits = false;            // sends out light, or a bind makes it do so
  bool own_texture_uvs = false;  // its textures have other UVs than wrinkle maps, or may have
};

// A character's meshes, materials and textures on the GPU. Normal maps become derivative maps in
// half floats, whose mip levels are averaged from the derivatives. Masks and wrinkle maps become
// one texture array each. All functions need a current context. Returned names stay the
// character's.
class GpuCharacter {
 public:
  // Uploads `character` and keeps no reference to it. Errors: kInvalidArgument (a mesh or material
  // refers to something that does not exist), kLimit (more layers or larger textures than the
  // driver supports; kMaxMorphBytes).
  [[nodiscard]] static Result<std::unique_ptr<GpuCharacter>> Create(
      const character::Character& character);

  [[nodiscard]] std::span<const GpuMesh> meshes() const { return meshes_; }
  [[nodiscard]] const GpuMaterial& material(int index) const { return materials_[index]; }
  [[nodiscard]] int num_materials() const { return static_cast<int>(materials_.size()); }
  // True if some material sends out light.
  [[nodiscard]] bool emits() const { return emits_; }
  // Texture array of the rig's masks, one layer per picture.
  [[nodiscard]] GLuint masks() const { return masks_.name(); }
  // The regions of the surface where the painted masks are above 0.
  [[nodiscard]] std::span<const MaskRegion> mask_regions() const { return mask_regions_; }
  // Texture array of the wrinkle maps' slopes; layers: WrinkleLayout::map_layers.
  [[nodiscard]] GLuint wrinkle_derivatives() const { return wrinkle_derivatives_.name(); }
  // Texture array of the wrinkle maps' colour and cavity, one layer per map that has them; 0: none.
  [[nodiscard]] GLuint wrinkle_looks() const { return wrinkle_looks_.name(); }
  [[nodiscard]] const WrinkleLayout& layout() const { return layout_; }
  // Heights of the wrinkle maps, in the order of WrinkleLayout::height_layers.
  [[nodiscard]] const WrinkleHeights& heights() const { return heights_; }
  // Upper bound, in metres, of the way of any vertex from the rest pose by morph targets. `shapes`:
  // weights of the character's shapes.
  [[nodiscard]] float MorphReach(std::span<const float> shapes) const;
  // Returns the index in GpuMesh::levels of the coarsest level of mesh `mesh` with an error of at
  // most `metres`. Computes the mesh's levels the first time that a level above 0 may be used.
  [[nodiscard]] int Level(std::size_t mesh, float metres);
  // Variants of mesh `mesh` (MakeUnindexed(), MakePatches()), created on first use.
  [[nodiscard]] const GpuMesh& Unindexed(std::size_t mesh);
  [[nodiscard]] const GpuPatches& Patches(std::size_t mesh);

 private:
  GpuCharacter() = default;
  [[nodiscard]] Status AddMaterials(const character::Character& character);
  [[nodiscard]] Status AddMeshes(const character::Character& character);
  [[nodiscard]] Status AddMasks(const character::Character& character);
  [[nodiscard]] Status AddWrinkleMaps(const character::Character& character);
  void AddWrinkleLooks(const character::Character& character);
  GLuint ColourTexture(const character::Character& character, int picture, bool srgb);
  GLuint DerivativeTexture(const character::Character& character, int picture);

  std::vector<GpuMesh> meshes_;
  std::map<std::size_t, GpuMesh> unindexed_;
  std::map<std::size_t, GpuPatches> patches_;
  std::vector<GpuMaterial> materials_;
  bool emits_ = false;
  std::map<std::pair<int, bool>, gl::Texture> colour_textures_;  // (picture, is it sRGB)
  std::map<int, gl::Texture> derivative_textures_;
  gl::Texture masks_;
  std::vector<MaskRegion> mask_regions_;
  gl::Texture wrinkle_derivatives_;
  gl::Texture wrinkle_looks_;
  WrinkleHeights heights_;
  WrinkleLayout layout_;
};

}  // namespace furrow::render
