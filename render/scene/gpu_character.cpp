// SPDX-License-Identifier: Apache-2.0
#include "render/scene/gpu_character.h"

#include <algorithm>
#include <bit>

#include "base/status.h"
#include "render/gl/mipmaps.h"

namespace furrow::render {
namespace {

using character::Character;
using character::Material;
using character::Picture;
using character::Vertex;

// Scale of the specular lobe. Skin reflects 2.8% at normal incidence, the tear film 2%. The tear
// film is smooth, so its highlight is a small bright point.
float SpecularOf(Material::Kind kind) {
  switch (kind) {
    case Material::Kind::kSkin: return 0.028f;
    case Material::Kind::kEye: return 0.04f;
    case Material::Kind::kHair: return 0.03f;
    case Material::Kind::kCloth: return 0.012f;
    case Material::Kind::kOther: return 0.03f;
    case Material::Kind::kShade: return 0.0f;
  }
  return 0.03f;
}

// Drawing order. Materials that hide others come first, so that hidden fragments are not shaded:
// cloth, skin, and then the inside of the head. Hair comes after the skin that it lies on: it has
// many layers, and skin then hides those at the back of the head. Shades come last, because they
// darken what is already drawn.
int LayerOf(Material::Kind kind) {
  switch (kind) {
    case Material::Kind::kCloth: return 0;
    case Material::Kind::kSkin: return 1;
    case Material::Kind::kHair: return 2;
    case Material::Kind::kEye:
    case Material::Kind::kOther: return 3;
    case Material::Kind::kShade: return 4;
  }
  return 3;
}

// Base colour below which a surface counts as a painted hollow. Only skin has painted
// hollows; dark eyes and hair keep their gloss.
float CavityAlbedoOf(Material::Kind kind) { return kind == Material::Kind::kSkin ? 0.02f : 0.0f; }

// An eye's surface is the smooth tear film, whatever its texture says.
float RoughnessOf(const Material& material) {
  return material.kind == Material::Kind::kEye ? std::min(material.roughness, 0.3f)
                                               : material.roughness;
}

// Levels of a full chain: down to 1 x 1.
int NumMips(int width, int height) {
  return std::bit_width(static_cast<unsigned>(std::max(width, height)));
}

void SetFiltering(const gl::Texture& texture, GLenum wrap) {
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
}

// Characters come from files. The GPU would read out of bounds on indices that are not checked
// here.
Status CheckMesh(const character::Mesh& mesh, const Character& character) {
  const auto fail = [&](const char* what) {
    return Status(StatusCode::kInvalidArgument, what, "mesh '" + mesh.name + "'");
  };
  if (mesh.material < 0 || mesh.material >= static_cast<int>(character.materials.size())) {
    return fail("has no material");
  }
  if (mesh.indices.size() % 3 != 0) return fail("is not made of triangles");
  for (const std::uint32_t index : mesh.indices) {
    if (index >= mesh.vertices.size()) return fail("has a vertex index out of range");
  }
  for (const character::MorphTarget& target : mesh.morph_targets) {
    if (target.shape < 0 || target.shape >= static_cast<int>(character.shapes.size())) {
      return fail("has a morph target with a shape out of range");
    }
    for (const character::MorphDelta& delta : target.deltas) {
      if (delta.vertex >= mesh.vertices.size()) {
        return fail("has a morph target with a vertex out of range");
      }
    }
  }
  // Every joint is checked, even with a skin weight of 0, because the shader reads its matrix.
  for (const Vertex& vertex : mesh.vertices) {
    for (const std::uint16_t joint : vertex.joints) {
      if (joint >= character.skeleton.num_joints()) return fail("refers to a joint out of range");
    }
  }
  return {};
}

// Each picture must hold exactly as many samples as its size says, in one of its three formats,
// before the driver reads them.
Status CheckPicture(const Picture& picture) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const std::size_t samples =
      static_cast<std::size_t>(picture.width) * picture.height * picture.channels;
  const std::string where = "picture '" + picture.name + "'";
  if (picture.width < 1 || picture.height < 1 || picture.channels < 1 ||
      picture.pixels.size() + picture.pixels16.size() + picture.pixels_float.size() != samples) {
    return {StatusCode::kInvalidArgument,
            "the number of pixels does not match the size of " + std::to_string(picture.width) +
                " x " + std::to_string(picture.height),
            where};
  }
  if (std::max(picture.width, picture.height) > limit) {
    return {StatusCode::kLimit,
            "its size of " + std::to_string(picture.width) + " x " +
                std::to_string(picture.height) + " exceeds the driver's limit of " +
                std::to_string(limit) + " pixels per side",
            where};
  }
  return {};
}

// 8-bit RGBA by nearest texel. Used only for masks whose size differs from that of the other masks.
std::vector<std::uint8_t> ResizeRgba8(const Picture& picture, int width, int height) {
  const std::vector<std::uint8_t> rgba = ToRgba8(picture);
  if (picture.width == width && picture.height == height) return rgba;
  std::vector<std::uint8_t> result(static_cast<std::size_t>(width) * height * 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int sx = x * picture.width / width;
      const int sy = y * picture.height / height;
      const auto* from = &rgba[(static_cast<std::size_t>(sy) * picture.width + sx) * 4];
      std::copy_n(from, 4, &result[(static_cast<std::size_t>(y) * width + x) * 4]);
    }
  }
  return result;
}

// All layers of an array have one size, so smaller pictures are resized to the largest.
gl::Texture MakeArray(GLenum format, int width, int height, int layers) {
  gl::Texture texture = gl::MakeTexture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(texture.name(), NumMips(width, height), format, width, height, layers);
  SetFiltering(texture, GL_REPEAT);
  return texture;
}

Status CheckLayers(std::size_t layers, const char* what) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
  if (layers <= static_cast<std::size_t>(limit)) return {};
  return {StatusCode::kLimit,
          std::to_string(layers) + " " + what + " exceed the driver's limit of " +
              std::to_string(limit),
          "wrinkle rig"};
}

// Checks that the list of active maps fits a uniform block, and that the dynamic masks fit the
// attributes and varyings of a vertex.
Status CheckBlock(const WrinkleLayout& layout) {
  const int num_maps = static_cast<int>(layout.map_layers.size());
  GLint block_limit = 0;
  GLint varying_limit = 0;
  GLint attribute_limit = 0;
  glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &block_limit);
  glGetIntegerv(GL_MAX_VARYING_VECTORS, &varying_limit);
  glGetIntegerv(GL_MAX_VERTEX_ATTRIBS, &attribute_limit);
  constexpr int kOthers = 6;  // attributes and varyings that scene.vert.glsl needs besides
  if (WrinkleBlockSize(num_maps, layout.num_mask_layers) <= static_cast<std::size_t>(block_limit) &&
      MapSlots(num_maps) + kOthers <= std::min(varying_limit, attribute_limit)) {
    return {};
  }
  return {StatusCode::kLimit,
          std::to_string(num_maps) + " wrinkle maps and " + std::to_string(layout.num_mask_layers) +
              " mask textures exceed the driver's limits for uniform blocks or vertices",
          "wrinkle rig"};
}

}  // namespace

MaterialBlock MakeMaterialBlock(const Material& material, const character::MaterialLook& look) {
  return {look.base_colour,
          RoughnessOf(material),
          SpecularOf(material.kind),
          material.alpha_cutoff,
          CavityAlbedoOf(material.kind),
          material.thickness,
          {},
          look.texture_scale,
          look.texture_offset,
          glm::vec4(look.emission, 0.0f)};
}

Result<std::unique_ptr<GpuCharacter>> GpuCharacter::Create(const Character& character) {
  std::unique_ptr<GpuCharacter> gpu(new GpuCharacter());
  // Rows of pictures are not padded to four bytes.
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (const Picture& picture : character.pictures) {
    FURROW_RETURN_IF_ERROR(CheckPicture(picture));
  }
  FURROW_RETURN_IF_ERROR(gpu->AddMaterials(character));
  FURROW_RETURN_IF_ERROR(gpu->AddMeshes(character));
  FURROW_RETURN_IF_ERROR(gpu->AddMasks(character));
  FURROW_RETURN_IF_ERROR(gpu->AddWrinkleMaps(character));
  return gpu;
}

Status GpuCharacter::AddMaterials(const Character& character) {
  const int num_pictures = static_cast<int>(character.pictures.size());
  for (const Material& source : character.materials) {
    for (const int picture :
         {source.base_colour_texture, source.normal_texture, source.roughness_texture,
          source.emission_texture, source.thickness_texture}) {
      if (picture >= num_pictures) {
        return {StatusCode::kInvalidArgument,
                "refers to picture " + std::to_string(picture) + " (the character has " +
                    std::to_string(num_pictures) + ")",
                "material '" + source.name + "'"};
      }
    }
    const MaterialBlock block = MakeMaterialBlock(source, character::LookOf(source, {}, {}));
    GpuMaterial material;
    material.source = source;
    material.block = gl::MakeStaticBuffer(&block, sizeof(block));
    material.base_colour = ColourTexture(character, source.base_colour_texture, true);
    material.roughness = ColourTexture(character, source.roughness_texture, false);
    material.emission = ColourTexture(character, source.emission_texture, true);
    material.thickness = ColourTexture(character, source.thickness_texture, false);
    material.derivatives = DerivativeTexture(character, source.normal_texture);
    material.emits = source.emission != glm::vec3(0.0f);
    material.kind = source.kind;
    material.group = GroupOf(character, source);
    // In units of the texture: the shader multiplies the texture by the material's base colour.
    material.cavity_albedo = block.cavity_albedo / std::max(source.base_colour.g, 1e-3f);
    material.alpha_test = source.alpha_cutoff > 0.0f;
    material.double_sided = source.double_sided;
    material.own_texture_uvs =
        source.texture_scale != glm::vec2(1.0f) || source.texture_offset != glm::vec2(0.0f);
    materials_.push_back(std::move(material));
  }
  for (const character::MaterialBind& bind : character.material_binds) {
    if (bind.material >= materials_.size() || bind.shape >= character.shapes.size()) {
      return {StatusCode::kInvalidArgument, "refers to a shape or material that does not exist",
              "material binds"};
    }
    GpuMaterial& material = materials_[bind.material];
    material.binds.push_back(bind);
    material.emits = material.emits || bind.emission != glm::vec3(0.0f);
    material.own_texture_uvs = material.own_texture_uvs || bind.moves_uvs();
  }
  emits_ = std::ranges::any_of(materials_, &GpuMaterial::emits);
  return {};
}

// Uploads the meshes in drawing order (LayerOf()).
Status GpuCharacter::AddMeshes(const Character& character) {
  std::vector<const character::Mesh*> order;
  for (const character::Mesh& source : character.meshes) {
    FURROW_RETURN_IF_ERROR(CheckMesh(source, character));
    order.push_back(&source);
  }
  std::ranges::stable_sort(order, {}, [&](const character::Mesh* mesh) {
    return LayerOf(character.materials[static_cast<std::size_t>(mesh->material)].kind);
  });
  for (const character::Mesh* original : order) {
    // Cards of hair lie on one another, and each shade darkens what is drawn.
    const GpuMaterial& material = materials_[static_cast<std::size_t>(original->material)];
    const bool is_solid = !material.alpha_test && material.kind != Material::Kind::kShade;
    ClusteredMesh clustered = MakeClusters(*original, character.inverse_bind_matrices,
                                           is_solid ? Sorting::kByPlace : Sorting::kNone);
    const character::Mesh* source = &clustered.mesh;
    meshes_.push_back(MakeGpuMesh(*source, character.inverse_bind_matrices));
    meshes_.back().clusters = std::move(clustered.clusters);
    // Cloth does not follow its joints' weights as closely: its folds are maps.
    if (materials_[source->material].kind == Material::Kind::kSkin) {
      AddGradients(*source, &meshes_.back());
    }
    if (meshes_.back().morphs.num_floats() * sizeof(float) > kMaxMorphBytes) {
      return {StatusCode::kLimit,
              "its morph targets move " + std::to_string(meshes_.back().morphs.num_rows() - 1) +
                  " vertices, which need more than the limit of " +
                  std::to_string(kMaxMorphBytes >> 20) + " MiB",
              "mesh '" + source->name + "'"};
    }
  }
  return {};
}

float GpuCharacter::MorphReach(std::span<const float> shapes) const {
  float reach = 0.0f;
  for (const GpuMesh& mesh : meshes_) reach = std::max(reach, mesh.morphs.Reach(shapes));
  return reach;
}

// Simplification takes long and is put off until it is certain to have an effect.
int GpuCharacter::Level(std::size_t index, float metres) {
  constexpr float kMinShare = 0.01f;  // of the mean edge; no edge collapses for less
  GpuMesh& mesh = meshes_[index];
  if (!(metres > kMinShare * mesh.mean_edge)) return 0;
  if (mesh.levels.empty()) {
    const bool is_hair = material(mesh.material).kind == Material::Kind::kHair;
    AddLevels(&mesh, is_hair ? Borders::kSimplify : Borders::kKeep);
  }
  // Errors ascend from level to level; take the coarsest one that is good enough.
  int level = static_cast<int>(mesh.levels.size()) - 1;
  while (level > 0 && mesh.levels[static_cast<std::size_t>(level)].error > metres) --level;
  return level;
}

const GpuMesh& GpuCharacter::Unindexed(std::size_t mesh) {
  if (!unindexed_.contains(mesh)) unindexed_.emplace(mesh, MakeUnindexed(meshes_[mesh]));
  return unindexed_.at(mesh);
}

const GpuPatches& GpuCharacter::Patches(std::size_t mesh) {
  if (!patches_.contains(mesh)) patches_.emplace(mesh, MakePatches(meshes_[mesh]));
  return patches_.at(mesh);
}

// Textures are shared by all materials that use a picture. A picture that is used as colour and as
// data gets two, because only colour is decoded from sRGB.
GLuint GpuCharacter::ColourTexture(const Character& character, int picture, bool srgb) {
  if (picture < 0) return 0;
  gl::Texture& texture = colour_textures_[{picture, srgb}];
  if (texture) return texture.name();
  const Picture& source = character.pictures[static_cast<std::size_t>(picture)];
  texture = gl::MakeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), NumMips(source.width, source.height),
                     srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, source.width, source.height);
  gl::UploadWithMips({.texture = texture.name(), .width = source.width, .height = source.height},
                     ToRgba8(source), srgb ? gl::MipSpace::kSrgb : gl::MipSpace::kLinear);
  SetFiltering(texture, GL_REPEAT);
  return texture.name();
}

GLuint GpuCharacter::DerivativeTexture(const Character& character, int picture) {
  if (picture < 0) return 0;
  gl::Texture& texture = derivative_textures_[picture];
  if (texture) return texture.name();
  const DerivativeMap map =
      DerivativesFromNormalMap(character.pictures[static_cast<std::size_t>(picture)]);
  texture = gl::MakeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), NumMips(map.width, map.height), GL_RGBA16F, map.width,
                     map.height);
  gl::UploadWithMips({.texture = texture.name(), .width = map.width, .height = map.height},
                     WithMoments(map), 4);
  SetFiltering(texture, GL_REPEAT);
  return texture.name();
}

Status GpuCharacter::AddMasks(const Character& character) {
  std::vector<const Picture*> pictures;
  int width = 1;
  int height = 1;
  for (const wrinkle::Region& region : character.rig.regions) {
    const std::string& name = region.mask.texture;
    if (region.mask.kind != wrinkle::Mask::Kind::kTexture || layout_.MaskLayer(name) >= 0) continue;
    const int index = character.FindRigPicture(name);
    if (index < 0) continue;  // not drawn; see Character::missing_rig_pictures
    pictures.push_back(&character.pictures[static_cast<std::size_t>(index)]);
    width = std::max(width, pictures.back()->width);
    height = std::max(height, pictures.back()->height);
    layout_.masks.push_back({name, static_cast<int>(layout_.masks.size())});
  }
  FURROW_RETURN_IF_ERROR(CheckLayers(pictures.size(), "mask textures"));
  layout_.num_mask_layers = std::max(1, static_cast<int>(pictures.size()));
  masks_ = MakeArray(GL_RGBA8, width, height, layout_.num_mask_layers);
  for (std::size_t layer = 0; layer < pictures.size(); ++layer) {
    gl::UploadWithMips({masks_.name(), static_cast<int>(layer), width, height},
                       ResizeRgba8(*pictures[layer], width, height), gl::MipSpace::kLinear);
    AddMaskRegions(character, *pictures[layer], static_cast<int>(layer), &mask_regions_);
  }
  glTextureParameteri(masks_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  return {};
}

Status GpuCharacter::AddWrinkleMaps(const Character& character) {
  std::vector<DerivativeMap> maps;
  int width = 1;
  int height = 1;
  for (const wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) {
    const bool derivative = !map.derivative.empty();
    const int index = character.FindRigPicture(derivative ? map.derivative : map.normal);
    layout_.map_layers.push_back(index < 0 ? -1 : static_cast<int>(maps.size()));
    if (index < 0) continue;  // no relief; see Character::missing_rig_pictures
    const Picture& picture = character.pictures[static_cast<std::size_t>(index)];
    maps.push_back(derivative ? DerivativesFromDerivativeMap(picture, map.derivative_scale)
                              : DerivativesFromNormalMap(picture));
    width = std::max(width, picture.width);
    height = std::max(height, picture.height);
  }
  FURROW_RETURN_IF_ERROR(CheckLayers(maps.size(), "wrinkle maps"));
  FURROW_RETURN_IF_ERROR(CheckBlock(layout_));
  const int layers = std::max(1, static_cast<int>(maps.size()));
  wrinkle_derivatives_ = MakeArray(GL_RGBA16F, width, height, layers);
  // Moments are taken after resampling, so that they describe the texels that are stored.
  for (std::size_t layer = 0; layer < maps.size(); ++layer) {
    gl::UploadWithMips({wrinkle_derivatives_.name(), static_cast<int>(layer), width, height},
                       WithMoments(Resample(maps[layer], width, height)), 4);
  }
  AddWrinkleLooks(character);
  heights_ = MakeWrinkleHeights(character);
  layout_.height_layers = heights_.layers;
  return {};
}

// One layer per wrinkle map: colour in rgb, cavity in alpha, white where the map has none.
void GpuCharacter::AddWrinkleLooks(const Character& character) {
  const auto find = [&](const std::string& name) {
    const int index = name.empty() ? -1 : character.FindRigPicture(name);
    return index < 0 ? nullptr : &character.pictures[static_cast<std::size_t>(index)];
  };
  bool any = false;
  int width = 1;
  int height = 1;
  for (const wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) {
    for (const Picture* picture : {find(map.colour), find(map.cavity)}) {
      if (picture == nullptr) continue;
      any = true;
      width = std::max(width, picture->width);
      height = std::max(height, picture->height);
    }
  }
  if (!any) return;
  const int layers = static_cast<int>(character.rig.wrinkle_maps.size());
  wrinkle_looks_ = MakeArray(GL_SRGB8_ALPHA8, width, height, layers);
  for (int layer = 0; layer < layers; ++layer) {
    const wrinkle::WrinkleMap& map = character.rig.wrinkle_maps[static_cast<std::size_t>(layer)];
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width) * height * 4, 255);
    if (const Picture* colour = find(map.colour)) rgba = ResizeRgba8(*colour, width, height);
    const Picture* cavity = find(map.cavity);
    const std::vector<std::uint8_t> cavity_albedo =
        cavity == nullptr ? std::vector<std::uint8_t>() : ResizeRgba8(*cavity, width, height);
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      rgba[i + 3] = cavity_albedo.empty() ? 255 : cavity_albedo[i];
    }
    gl::UploadWithMips({wrinkle_looks_.name(), layer, width, height}, std::move(rgba),
                       gl::MipSpace::kSrgb);
  }
}

}  // namespace furrow::render
