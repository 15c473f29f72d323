// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
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
  bool shadow = false;           // depth only: of displaced geometry for a shadow map, or of a
                                 // cut-out in the scene
  bool composed_looks = false;   // the base colour already includes the wrinkles' colour and cavity
  bool shade = false;            // a shell that only darkens what lies behind it
  bool stretch = false;          // the mesh is posed with PoseShader::gradients
  bool crowd = false;            // several subjects, each with its own wrinkle weights
  bool motion = false;           // `unlit` stores the motion since the former picture, too

  friend auto operator<=>(const SceneShader&, const SceneShader&) = default;
};

// The switches as "NAME VALUE" lines for ExpandShader().
[[nodiscard]] std::vector<std::string> Defines(const SceneShader& shader);
[[nodiscard]] std::vector<std::string> Defines(const PoseShader& shader);

// Width and height, in texels, of the look-up tables in LookupTables.
inline constexpr int kBeckmannTableSize = 512;
inline constexpr int kAlbedoTableSize = 32;
inline constexpr int kPreintegratedTableSize = 48;

// Compiles programs on first use and keeps them. Viewers choose the settings of their pictures, and
// each combination needs programs of its own, so the library keeps the kMaxPrograms that were used
// last. It owns the programs; their names are valid until the next BeginFrame(). Needs a current
// context. Errors of all Get...(): those of BuildProgram().
class ShaderLibrary {
 public:
  // A picture needs 10 to 20 programs; one takes about 3 MiB with Mesa's software renderer.
  static constexpr std::size_t kMaxPrograms = 96;

  // Call it before the first pass of a picture: removes what was used longest ago. What the last
  // picture used stays, however much that is.
  void BeginFrame();
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
  [[nodiscard]] std::size_t num_programs() const {
    return scene_.size() + pose_.size() + named_.size();
  }

 private:
  struct Entry {
    gl::Program program;
    std::uint64_t used = 0;  // the last frame
  };
  // The program of `key`, which `build` makes if it is missing.
  template <class Key, class Build>
  Result<GLuint> Find(std::map<Key, Entry>* programs, Key key, Build build);
  [[nodiscard]] Result<GLuint> GetNamed(std::string_view vertex, std::string_view fragment,
                                        const std::vector<std::string>& defines);

  std::uint64_t frame_ = 0;
  std::map<SceneShader, Entry> scene_;
  std::map<PoseShader, Entry> pose_;
  std::map<std::string, Entry> named_;  // by file and defines
};

}  // namespace furrow::render
