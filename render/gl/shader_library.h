// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "character/character.h"
#include "render/gl/gl_objects.h"
#include "render/gl/shader_loader.h"
#include "render/settings/settings.h"

namespace furrow::render {

// What a program of scene/pose.vert.glsl is compiled for.
struct PoseShader {
  int num_joints = 0;      // of the character's skeleton
  bool dynamic = false;    // with the dynamic masks of each vertex
  bool displaced = false;  // ... and its share of the heights
  int map_slots = 1;       // as of SceneShader

  friend auto operator<=>(const PoseShader&, const PoseShader&) = default;
};

// What a program of scene.{vert,frag}.glsl is compiled for. Everything that is the same for a whole
// draw is settled here and not by branches: llvmpipe runs both sides of a branch.
struct SceneShader {
  View view = View::kFinal;
  Shading shading = Shading::kDiffuse;
  NormalBlend normal_blend = NormalBlend::kPartialDerivative;
  bool wrinkle_texture = false;  // some active map is masked by textures
  bool wrinkle_dynamic = false;  // ... by the joints' influences
  bool base_colour_map = false;
  bool base_normal_map = false;
  bool roughness_map = false;
  bool alpha_test = false;
  int active_maps = 0;  // wrinkle maps at work on this surface
  int mask_layers = 1;
  std::uint32_t mask_bits = ~0u;  // the layers that hold masks of this surface's regions
  int map_slots = 1;              // vec4s of dynamic masks: a quarter of the rig's maps, rounded up
  // Of the skin pipeline alone.
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
  bool any_material = false;  // `material` says nothing: each pixel does
  // Only what light needs to know of the surface; skin/light.frag.glsl comes later.
  bool unlit = false;
  bool displaced = false;       // tessellated, moved by heights
  bool shadow = false;          // displaced, as a lamp sees it: depth alone
  bool composed_looks = false;  // the wrinkles' are in the base colour already
  bool crowd = false;           // several subjects, each with wrinkle weights of its own

  friend auto operator<=>(const SceneShader&, const SceneShader&) = default;
};

// "NAME VALUE" lines for ExpandShader().
[[nodiscard]] std::vector<std::string> Defines(const SceneShader& shader);
[[nodiscard]] std::vector<std::string> Defines(const PoseShader& shader);

// Texels of the sides of the tables that shaders look things up in.
inline constexpr int kBeckmannTableSize = 512;
inline constexpr int kAlbedoTableSize = 32;
inline constexpr int kPreintegratedTableSize = 48;

// Programs, compiled when first asked for and kept. Needs a current context.
//
// Errors: kInternal with the driver's log, its source numbers replaced by file names.
class ShaderLibrary {
 public:
  [[nodiscard]] Result<GLuint> Get(const SceneShader& shader);
  // A vertex stage alone, for transform feedback.
  [[nodiscard]] Result<GLuint> Get(const PoseShader& shader);
  // shadow.{vert,frag}.glsl.
  [[nodiscard]] Result<GLuint> GetShadow(bool alpha_test);
  // A fragment shader that covers the picture: "skin/combine.frag.glsl", ...
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

// Names of files, by stage. Without tessellation, both of its are empty; without a picture, so is
// the fragment's.
struct ProgramFiles {
  std::string_view vertex;
  std::string_view fragment = {};
  std::string_view tess_control = {};
  std::string_view tess_evaluation = {};
};
// Compiles and links shaders of `files`.
[[nodiscard]] Result<gl::Program> BuildProgram(const ProgramFiles& program,
                                               std::span<const std::string> defines,
                                               std::span<const ShaderFile> files);

}  // namespace furrow::render
