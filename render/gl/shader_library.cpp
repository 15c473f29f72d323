// SPDX-License-Identifier: Apache-2.0
#include "render/gl/shader_library.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "render/gl/shader_loader.h"
#include "render/gl/shader_program.h"
#include "render/skin/subsurface_kernel.h"

namespace furrow::render {
// Defines every switch, even those that a program does not use: #if silently treats an undefined
// name as 0.
std::vector<std::string> Defines(const SceneShader& shader) {
  using Kind = character::Material::Kind;
  std::vector<std::string> defines = {
      Define("VIEW", static_cast<int>(shader.view)),
      Define("NORMAL_BLEND", static_cast<int>(shader.normal_blend)),
      Define("WRINKLE_TEXTURE", shader.wrinkle_texture),
      Define("WRINKLE_DYNAMIC", shader.wrinkle_dynamic),
      Define("HAS_BASE_COLOUR", shader.base_colour_map),
      Define("HAS_BASE_NORMAL", shader.base_normal_map),
      Define("HAS_ROUGHNESS", shader.roughness_map),
      Define("ALPHA_TEST", shader.alpha_test),
      Define("EMITS", shader.emits),
      Define("HAS_EMISSION", shader.emission_map),
      Define("EMISSION_TARGET", shader.emission_target),
      Define("ACTIVE_MAPS", shader.active_maps),
      Define("MASK_LAYERS", shader.mask_layers),
      Define("MASK_BITS", static_cast<int>(shader.mask_bits)),
      Define("MAP_SLOTS", shader.map_slots),
      Define("MATERIAL_SKIN", static_cast<int>(Kind::kSkin)),
      Define("MATERIAL_CLOTH", static_cast<int>(Kind::kCloth)),
      Define("MATERIAL_EYE", static_cast<int>(Kind::kEye)),
      Define("MATERIAL_HAIR", static_cast<int>(Kind::kHair)),
      Define("MATERIAL_OTHER", static_cast<int>(Kind::kOther)),
      Define("MATERIAL_SHADE", static_cast<int>(Kind::kShade)),
      Define("MATERIAL", static_cast<int>(shader.material)),
      Define("MATERIALS", shader.any_material),
      Define("SHADOW_FILTER", static_cast<int>(shader.shadow_filter)),
      Define("SHADOW_TAPS", shader.shadow_taps),
      Define("SHADOW_LAMPS", shader.shadow_lamps),
      Define("TRANSLUCENCY", shader.translucency),
      Define("PREINTEGRATED", shader.preintegrated),
      Define("SPECULAR_GEMS", shader.gems),
      Define("BECKMANN_TABLE", shader.beckmann_table),
      Define("CONSERVE", shader.conserve_energy),
      Define("WIDEN", shader.widen),
      Define("WRINKLE_LOOKS", shader.wrinkle_looks),
      Define("HAS_THICKNESS", shader.thickness_map),
      Define("DISPLACED", shader.displaced),
      Define("SHADOW", shader.shadow),
      Define("CROWD", shader.crowd),
      Define("MOTION", shader.motion),
      Define("STRETCH", shader.stretch),
      Define("SKIN_TARGETS", shader.shading == Shading::kSkin),
      Define("FACETS", shader.unlit),
      Define("COMPOSED_LOOKS", shader.composed_looks),
      "BECKMANN_SIZE float(" + std::to_string(kBeckmannTableSize) + ")",
      "ALBEDO_SIZE float(" + std::to_string(kAlbedoTableSize) + ")",
      "RING_SIZE float(" + std::to_string(kPreintegratedTableSize) + ")",
      "MAX_CURVATURE " + std::to_string(kMaxCurvature),
  };
  for (int view = 0; view < kNumViews; ++view) {
    std::string name = "VIEW_" + std::string(ViewName(static_cast<View>(view)));
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
    defines.push_back(Define(name, view));
  }
  return defines;
}

std::vector<std::string> Defines(const PoseShader& shader) {
  return {Define("NUM_JOINTS", shader.num_joints),   Define("WRINKLE_DYNAMIC", shader.dynamic),
          Define("DISPLACED", shader.displaced),     Define("MAP_SLOTS", shader.map_slots),
          Define("MORPH_PARTS", shader.morph_parts), Define("GRADIENTS", shader.gradients)};
}

void ShaderLibrary::BeginFrame() {
  ++frame_;
  if (num_programs() <= kMaxPrograms) return;
  std::vector<std::uint64_t> ages;  // frames since the last use
  const auto for_each_map = [this](const auto& visit) {
    visit(&scene_);
    visit(&pose_);
    visit(&named_);
  };
  for_each_map([&](const auto* programs) {
    for (const auto& [key, entry] : *programs) ages.push_back(frame_ - entry.used);
  });
  const auto limit = ages.begin() + kMaxPrograms;
  std::nth_element(ages.begin(), limit, ages.end());
  // Programs of one picture have one age and go together, so this may leave fewer than the limit.
  const std::uint64_t too_old = std::max<std::uint64_t>(*limit, 2);
  for_each_map([&](auto* programs) {
    std::erase_if(*programs,
                  [&](const auto& item) { return frame_ - item.second.used >= too_old; });
  });
}

template <class Key, class Build>
Result<GLuint> ShaderLibrary::Find(std::map<Key, Entry>* programs, Key key, Build build) {
  auto found = programs->find(key);
  if (found == programs->end()) {
    Result<gl::Program> program = build();
    FURROW_RETURN_IF_ERROR(program);
    found = programs->emplace(std::move(key), Entry{*std::move(program)}).first;
  }
  found->second.used = frame_;
  return found->second.program.name();
}

Result<GLuint> ShaderLibrary::Get(const SceneShader& shader) {
  return Find(&scene_, shader, [&] {
    ProgramFiles files{"scene/scene.vert.glsl", "scene/scene.frag.glsl"};
    if (shader.shading == Shading::kSkin) files.fragment = "skin/skin.frag.glsl";
    if (shader.unlit) files.fragment = "scene/surface.frag.glsl";
    if (shader.shade) files.fragment = "scene/shade.frag.glsl";
    if (shader.shadow) files.fragment = "shadow/shadow.frag.glsl";
    if (shader.displaced) {
      files.tess_control = "scene/displace.tesc.glsl";
      files.tess_evaluation = "scene/displace.tese.glsl";
    }
    return BuildProgram(files, Defines(shader), EmbeddedShaders());
  });
}

Result<GLuint> ShaderLibrary::Get(const PoseShader& shader) {
  return Find(&pose_, shader, [&] {
    return BuildProgram({"scene/pose.vert.glsl"}, Defines(shader), EmbeddedShaders());
  });
}

Result<GLuint> ShaderLibrary::GetShadow(bool alpha_test) {
  return GetNamed("shadow/shadow.vert.glsl", "shadow/shadow.frag.glsl",
                  {Define("ALPHA_TEST", alpha_test)});
}

Result<GLuint> ShaderLibrary::GetFullscreen(std::string_view fragment,
                                            const std::vector<std::string>& defines) {
  return GetNamed("common/fullscreen.vert.glsl", fragment, defines);
}

Result<GLuint> ShaderLibrary::GetNamed(std::string_view vertex, std::string_view fragment,
                                       const std::vector<std::string>& defines) {
  // Callers pair each fragment shader with one vertex shader, so the vertex shader is not part of
  // the key.
  std::string key(fragment);
  for (const std::string& define : defines) key += ";" + define;
  return Find(&named_, std::move(key), [&] {
    return BuildProgram({vertex, fragment}, defines, EmbeddedShaders());
  });
}

}  // namespace furrow::render
