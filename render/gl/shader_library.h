// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "render/gl/gl_objects.h"
#include "render/settings/settings.h"

namespace furrow::render {

// Compile-time switches of scene/pose.vert.glsl.
struct PoseShader {
  int num_joints = 0;      // of the character's skeleton
  bool dynamic = false;    // write the dynamic masks of each vertex
  bool displaced = false;  // write the share of the heights by which each vertex is moved
  int map_slots = 1;       // MapSlots() of the rig's wrinkle maps
  int morph_parts = 0;     // MeshMorphs::num_parts(); 0: no morph target moves the mesh
  bool gradients = false;  // normals follow the posed surface (WeightGradients())

  friend auto operator<=>(const PoseShader&, const PoseShader&) = default;
};

// Compile-time switches of the shaders in scene/ and skin/ that draw meshes. Everything that is
// constant within a draw is a switch and not a branch, because llvmpipe runs both sides of a
// branch.
struct SceneShader {
  View view = View::kFinal;
  Shading shading = Shading::kDiffuse;
  NormalBlend normal_blend = NormalBlend::kPartialDerivative;
  bool wrinkle_texture = false;  // some active map is masked by textures
  bool wrinkle_dynamic = false;  // some active map is masked by the joints' influences
  bool base_colour_map = false;
  bool base_normal_map = false;
  bool roughness_map = false;
  bool alpha_test = false;
  bool emits = false;         // the material sends out light
  bool emission_map = false;  // times a texture
  int active_maps = 0;        // active wrinkle maps on this surface
  int mask_layers = 1;
  std::uint32_t mask_bits = ~0u;  // mask layers with regions of this surface
  int map_slots = 1;              // MapSlots(): vec4s of dynamic masks per vertex
  // The following are used by the skin pipeline only.
  character::Material::Kind material = character::Material::Kind::kSkin;
  ShadowFilter shadow_filter = ShadowFilter::kOff;
  int shadow_taps = 1;
  int shadow_lamps = 0;
  bool translucency = false;
  bool preintegrated = false;
  bool gems = false;
  bool beckmann_table = false;
  bool widen = false;
  bool wrinkle_looks = false;
  bool thickness_map = false;
  bool conserve_energy = true;
  bool any_material = false;  // each pixel has its own material; `material` is ignored
  // Store only the surface's properties; skin/light.frag.glsl lights them later.
  bool unlit = false;
  bool emission_target = false;  // `unlit` stores emission, too
  bool displaced = false;        // tessellated and moved by heights
  bool shadow = false;           // displaced geometry for a shadow map: depth only
  bool composed_looks = false;   // the base colour already includes the wrinkles' colour and cavity
  bool shade = false;            // a shell that only darkens what lies behind it
  bool stretch = false;          // the mesh is posed with PoseShader::gradients
  bool crowd = false;            // several subjects, each with its own wrinkle weights

  friend auto operator<=>(const SceneShader&, const SceneShader&) = default;
};

// The switches as "NAME VALUE" lines for ExpandShader().
[[nodiscard]] std::vector<std::string> Defines(const SceneShader& shader);
[[nodiscard]] std::vector<std::string> Defines(const PoseShader& shader);

// Width and height, in texels, of the look-up tables in LookupTables.
inline constexpr int kBeckmannTableSize = 512;
inline constexpr int kAlbedoTableSize = 32;
inline constexpr int kPreintegratedTableSize = 48;

// Compiles programs on first use and keeps them. The library owns the programs; their names are
// valid as long as it is. Needs a current context. Errors of all Get...(): those of BuildProgram().
class ShaderLibrary {
 public:
  [[nodiscard]] Result<GLuint> Get(const SceneShader& shader);
  // Vertex stage only, for transform feedback.
  [[nodiscard]] Result<GLuint> Get(const PoseShader& shader);
  // The program that draws depth into shadow maps (shadow/shadow.{vert,frag}.glsl). `alpha_test`:
  // leave out texels below the material's alpha cutoff.
  [[nodiscard]] Result<GLuint> GetShadow(bool alpha_test);
  // The program of a pass that covers the whole picture. `fragment`: path below shaders/, such as
  // "skin/combine.frag.glsl". `defines`: "NAME VALUE".
  [[nodiscard]] Result<GLuint> GetFullscreen(std::string_view fragment,
                                             const std::vector<std::string>& defines);
  [[nodiscard]] int num_programs() const {
    return static_cast<int>(scene_.size() + pose_.size() + named_.size());
  }

 private:
  [[nodiscard]] Result<GLuint> GetNamed(std::string_view vertex, std::string_view fragment,
                                        const std::vector<std::string>& defines);

  std::map<SceneShader, gl::Program> scene_;
  std::map<PoseShader, gl::Program> pose_;
  std::map<std::string, gl::Program> named_;  // by file and defines
};

}  // namespace furrow::render
