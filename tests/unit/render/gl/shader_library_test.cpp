// SPDX-License-Identifier: Apache-2.0
#include "render/gl/shader_library.h"

#include <string>

#include <gtest/gtest.h>

#include "render/gl/egl_context.h"
#include "render/passes/scene_draw.h"
#include "render/settings/named_settings.h"

namespace furrow::render {
namespace {

class ShaderLibraryTest : public testing::Test {
 protected:
  void SetUp() override {
    auto context = EglContext::Create("");
    ASSERT_TRUE(context.ok()) << context.status().ToString();
    context_ = std::move(*context);
  }
  std::unique_ptr<EglContext> context_;
  ShaderLibrary library_;
};

constexpr View kViews[] = {View::kFinal,       View::kNormal,  View::kMaskDynamic,
                           View::kMaskTexture, View::kWeights, View::kWireframe};

// The table of configurations in shaders/README.md: every view with every switch.
TEST_F(ShaderLibraryTest, EverySceneConfigurationCompiles) {
  for (const View view : kViews) {
    for (int bits = 0; bits < 128; ++bits) {
      SceneShader shader;
      shader.view = view;
      shader.normal_blend = static_cast<NormalBlend>(bits & 1);
      shader.wrinkle_texture = (bits & 2) != 0;
      shader.wrinkle_dynamic = (bits & 4) != 0;
      shader.base_colour_map = (bits & 8) != 0;
      shader.base_normal_map = (bits & 16) != 0;
      shader.roughness_map = (bits & 32) != 0;
      shader.alpha_test = (bits & 64) != 0;
      shader.active_maps = shader.wrinkle_texture || shader.wrinkle_dynamic ? 2 : 0;
      shader.mask_layers = 2;
      const Result<GLuint> program = library_.Get(shader);
      ASSERT_TRUE(program.ok()) << ViewName(view) << " " << bits << "\n"
                                << program.status().ToString();
    }
  }
}

TEST_F(ShaderLibraryTest, EmissionCompilesInEveryWayOfDrawing) {
  for (const bool with_map : {false, true}) {
    SceneShader shader;
    shader.emits = true;
    shader.emission_map = with_map;
    EXPECT_TRUE(library_.Get(shader).ok()) << "plain";
    shader.shading = Shading::kSkin;
    EXPECT_TRUE(library_.Get(shader).ok()) << "skin";
    shader.unlit = shader.emission_target = shader.motion = true;
    EXPECT_TRUE(library_.Get(shader).ok()) << "facets";
    shader.shade = true;
    EXPECT_TRUE(library_.Get(shader).ok()) << "shade over facets";
  }
  SceneShader dark;
  dark.shading = Shading::kSkin;
  dark.unlit = dark.emission_target = true;
  EXPECT_TRUE(library_.Get(dark).ok()) << "a dark material of a character that shines";
}

TEST_F(ShaderLibraryTest, AnyNumberOfMasksAndMapsCompiles) {
  for (const int mask_layers : {1, 3, 8}) {
    for (const int map_slots : {1, 2, 4}) {
      SceneShader shader;
      shader.wrinkle_texture = true;
      shader.wrinkle_dynamic = true;
      shader.mask_layers = mask_layers;
      shader.map_slots = map_slots;
      shader.active_maps = 4 * map_slots;
      const Result<GLuint> program = library_.Get(shader);
      ASSERT_TRUE(program.ok()) << program.status().ToString();
    }
  }
}

// Every switch of the skin pipeline's scene shader, one at a time, for every material and view.
TEST_F(ShaderLibraryTest, EverySkinConfigurationCompiles) {
  using Kind = character::Material::Kind;
  for (const Kind kind : {Kind::kSkin, Kind::kCloth, Kind::kEye, Kind::kHair, Kind::kOther}) {
    for (const View view : {View::kFinal, View::kShadow, View::kSpecular, View::kTranslucency,
                            View::kAlbedo, View::kMaterial}) {
      for (int bit = 0; bit < 8; ++bit) {
        SceneShader shader;
        shader.shading = Shading::kSkin;
        shader.view = view;
        shader.material = kind;
        shader.shadow_filter = static_cast<ShadowFilter>(bit < 3 ? bit : 1);
        shader.shadow_lamps = bit == 0 ? 0 : 3;
        shader.shadow_taps = bit == 0 ? 1 : 8;
        shader.translucency = bit >= 3 && kind == Kind::kSkin;
        shader.preintegrated = bit == 4 && kind == Kind::kSkin;
        shader.gems = shader.beckmann_table = bit == 5;
        shader.mask_bits = bit == 7 ? 1u : ~0u;
        shader.conserve_energy = bit != 6;
        shader.wrinkle_texture = shader.wrinkle_dynamic = bit == 7;
        shader.widen = shader.wrinkle_looks = shader.thickness_map = bit == 7;
        shader.active_maps = bit == 7 ? 2 : 0;
        const Result<GLuint> program = library_.Get(shader);
        ASSERT_TRUE(program.ok()) << ViewName(view) << " " << bit << "\n"
                                  << program.status().ToString();
      }
    }
  }
}

// A shade has one target, or those of a scene pass.
TEST_F(ShaderLibraryTest, ShadesCompileForEveryTarget) {
  for (const Shading shading : {Shading::kDiffuse, Shading::kSkin}) {
    for (const bool unlit : {false, true}) {
      SceneShader shader;
      shader.motion = unlit && shading == Shading::kSkin;
      shader.shade = true;
      shader.material = character::Material::Kind::kShade;
      shader.shading = shading;
      shader.unlit = unlit && shading == Shading::kSkin;
      shader.base_colour_map = true;
      const Result<GLuint> program = library_.Get(shader);
      ASSERT_TRUE(program.ok()) << program.status().ToString();
    }
  }
}

// The facets of every material, and the shader that lights them.
TEST_F(ShaderLibraryTest, EveryFacetConfigurationCompiles) {
  using Kind = character::Material::Kind;
  for (int bits = 0; bits < 32; ++bits) {
    SceneShader shader;
    shader.shading = Shading::kSkin;
    shader.unlit = true;
    shader.motion = (bits & 16) != 0;
    shader.material = bits % 2 == 0 ? Kind::kSkin : Kind::kCloth;
    shader.widen = (bits & 2) != 0;
    shader.wrinkle_looks = shader.wrinkle_texture = (bits & 4) != 0;
    shader.thickness_map = (bits & 8) != 0;
    shader.active_maps = shader.wrinkle_texture ? 2 : 0;
    const Result<GLuint> program = library_.Get(shader);
    ASSERT_TRUE(program.ok()) << bits << "\n" << program.status().ToString();
  }
  for (const char* setting :
       {"view=final", "view=shadow", "view=specular", "view=translucency", "view=albedo",
        "view=material", "shadow.filter=off", "shadow.filter=pcss", "shadow.taps=1",
        "translucency.enabled=off", "subsurface.method=preintegrated", "specular.table=on",
        "specular.mode=gems", "specular.conserve_energy=off"}) {
    Settings settings;
    ASSERT_TRUE(SetSetting(setting, &settings).ok());
    for (const int bits : {0, 1, 2, 3, 4, 7}) {
      std::vector<std::string> defines = Defines(SceneDraw::LightShader(settings));
      defines.insert(defines.end(), {"OCCLUSION " + std::to_string(bits & 1),
                                     "EMISSION " + std::to_string(bits >> 1 & 1),
                                     "SHADOWS_BEFORE " + std::to_string(bits >> 2), "SCALE 2"});
      const Result<GLuint> program = library_.GetFullscreen("skin/light.frag.glsl", defines);
      ASSERT_TRUE(program.ok()) << setting << "\n" << program.status().ToString();
    }
  }
}

TEST_F(ShaderLibraryTest, EveryDisplacedConfigurationCompiles) {
  for (int bits = 0; bits < 64; ++bits) {
    SceneShader shader;
    shader.displaced = true;
    shader.crowd = (bits & 32) != 0;
    shader.wrinkle_texture = (bits & 1) != 0;
    shader.wrinkle_dynamic = (bits & 2) != 0;
    shader.shadow = (bits & 4) != 0;
    shader.alpha_test = (bits & 8) != 0;
    shader.shading = (bits & 16) != 0 ? Shading::kSkin : Shading::kDiffuse;
    shader.active_maps = 4;
    shader.mask_layers = 3;
    shader.map_slots = 4;
    const Result<GLuint> program = library_.Get(shader);
    ASSERT_TRUE(program.ok()) << bits << "\n" << program.status().ToString();
  }
}

TEST_F(ShaderLibraryTest, TheDepthOfCutOutsCompiles) {
  SceneShader shader;
  shader.shadow = shader.alpha_test = true;
  const Result<GLuint> program = library_.Get(shader);
  ASSERT_TRUE(program.ok()) << program.status().ToString();
}

TEST_F(ShaderLibraryTest, EveryCrowdConfigurationCompiles) {
  for (int bits = 0; bits < 16; ++bits) {
    SceneShader shader;
    shader.crowd = true;
    shader.wrinkle_texture = (bits & 1) != 0;
    shader.wrinkle_dynamic = (bits & 2) != 0;
    shader.view = (bits & 4) != 0 ? View::kWeights : View::kFinal;
    shader.shading = (bits & 8) != 0 ? Shading::kSkin : Shading::kDiffuse;
    shader.active_maps = 2;
    shader.mask_layers = 2;
    const Result<GLuint> program = library_.Get(shader);
    ASSERT_TRUE(program.ok()) << bits << "\n" << program.status().ToString();
  }
}

TEST_F(ShaderLibraryTest, EveryPoseConfigurationCompiles) {
  for (int bits = 0; bits < 8; ++bits) {
    for (const int map_slots : {1, 10}) {
      const PoseShader shader{.num_joints = 163,
                              .dynamic = (bits & 1) != 0,
                              .displaced = (bits & 2) != 0,
                              .map_slots = map_slots,
                              .gradients = (bits & 4) != 0};
      const Result<GLuint> program = library_.Get(shader);
      ASSERT_TRUE(program.ok()) << bits << "\n" << program.status().ToString();
    }
  }
}

TEST_F(ShaderLibraryTest, EveryFullscreenConfigurationCompiles) {
  const std::pair<const char*, std::vector<std::string>> shaders[] = {
      {"post/composite.frag.glsl", {"SAMPLES 4", "SHOW 0", "TONE_MAP 0", "BLOOM 0", "BOTTOM_UP 0"}},
      {"post/composite.frag.glsl", {"SAMPLES 1", "SHOW 1", "TONE_MAP 0", "BLOOM 0", "BOTTOM_UP 0"}},
      {"post/composite.frag.glsl", {"SAMPLES 1", "SHOW 2", "TONE_MAP 0", "BLOOM 1", "BOTTOM_UP 1"}},
      {"post/composite.frag.glsl", {"SAMPLES 4", "SHOW 2", "TONE_MAP 1", "BLOOM 0", "BOTTOM_UP 0"}},
      {"scene/resolve.frag.glsl", {"SAMPLES 2"}},
      {"skin/separable.frag.glsl", {}},
      {"skin/combine.frag.glsl", {}},
      {"skin/gaussian_sum.frag.glsl", {}},
      {"skin/burley.frag.glsl", {}},
      {"occlusion/gtao.frag.glsl", {"SCALE 1", "SAMPLES 4"}},
      {"occlusion/gtao.frag.glsl", {"SCALE 2", "SAMPLES 64"}},
      {"occlusion/ssao.frag.glsl", {"SCALE 2", "SAMPLES 12"}},
      {"occlusion/occlusion_blur.frag.glsl", {"SCALE 1"}},
      {"occlusion/occlusion_blur.frag.glsl", {"SCALE 2"}},
      {"occlusion/occlude.frag.glsl", {"SCALE 1"}},
      {"occlusion/occlude.frag.glsl", {"SCALE 2"}},
      {"post/bloom.frag.glsl", {"BRIGHT 0"}},
      {"post/bloom.frag.glsl", {"BRIGHT 1"}},
      {"post/show.frag.glsl", {"SHOWN 0"}},
      {"post/show.frag.glsl", {"SHOWN 1"}},
      {"post/show.frag.glsl", {"SHOWN 2"}},
      {"post/fxaa.frag.glsl", {}},
      {"temporal/neighbours.frag.glsl", {"HAS_FORMER 0"}},
      {"temporal/neighbours.frag.glsl", {"HAS_FORMER 1"}},
      {"temporal/surround.frag.glsl", {}},
      {"temporal/accumulate.frag.glsl", {}},
  };
  for (const auto& [fragment, defines] : shaders) {
    const Result<GLuint> program = library_.GetFullscreen(fragment, defines);
    ASSERT_TRUE(program.ok()) << program.status().ToString();
  }
  for (const bool alpha_test : {false, true}) {
    const Result<GLuint> program = library_.GetShadow(alpha_test);
    ASSERT_TRUE(program.ok()) << program.status().ToString();
  }
}

TEST_F(ShaderLibraryTest, AProgramIsCompiledOnce) {
  EXPECT_EQ(*library_.Get(SceneShader{}), *library_.Get(SceneShader{}));
}

// Every viewer may ask for settings of its own.
TEST_F(ShaderLibraryTest, KeepsTheProgramsThatWereUsedLast) {
  const auto get = [&](int variant) {
    const Result<GLuint> program =
        library_.GetFullscreen("skin/combine.frag.glsl", {"VARIANT " + std::to_string(variant)});
    EXPECT_TRUE(program.ok()) << program.status().ToString();
    return program.ok() ? *program : 0;
  };
  constexpr int kLimit = static_cast<int>(ShaderLibrary::kMaxPrograms);
  GLuint always = 0;
  for (int variant = 0; variant < 2 * kLimit; ++variant) {
    library_.BeginFrame();
    const GLuint kept = get(-1);
    if (variant > 0) ASSERT_EQ(kept, always) << "used in every picture";
    always = kept;
    (void)get(variant);
    ASSERT_LE(library_.num_programs(), ShaderLibrary::kMaxPrograms + 1)
        << "one more until the next";
  }
  // A picture that needs more than all others together keeps what it needs.
  library_.BeginFrame();
  for (int variant = 0; variant < 2 * kLimit; ++variant) (void)get(variant);
  library_.BeginFrame();
  EXPECT_EQ(library_.num_programs(), std::size_t{2 * kLimit});
  library_.BeginFrame();
  library_.BeginFrame();
  EXPECT_LE(library_.num_programs(), ShaderLibrary::kMaxPrograms);
}

}  // namespace
}  // namespace furrow::render
