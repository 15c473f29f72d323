// SPDX-License-Identifier: Apache-2.0
// The shaders that `furrow export` writes, against those of the renderer. Both draw the wrinkled
// tangent-space normals of the default character over its UV square, half as large as the textures, so that
// mip levels take part. HLSL is compiled by glslangValidator and translated by spirv-cross.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "authoring/export/export_package.h"
#include "authoring/export/export_plan.h"
#include "base/files.h"
#include "base/process/limited_process.h"
#include "character/package/package.h"
#include "character/pictures/picture_file.h"
#include "render/gl/egl_context.h"
#include "render/gl/shader_loader.h"
#include "render/gl/shader_program.h"
#include "render/scene/gpu_character.h"
#include "render/wrinkles/wrinkle_table.h"
#include "tests/temporary_folder.h"
#include "wrinkle/solver/solver.h"

namespace furrow::render {
namespace {

namespace fs = std::filesystem;
using authoring::Engine;

constexpr int kSide = 1024;  // pixels
// The largest root mean square difference, in steps of 255.
constexpr double kMaxRmse = 3.0;

constexpr char kReference[] = R"(
#include "wrinkles/wrinkles_frag.glsl"
layout(binding = 1) uniform sampler2D u_base_derivatives;
layout(location = 0) out vec4 f_normal;
layout(location = 1) out vec4 f_look;
void main() {
  vec2 uv = gl_FragCoord.xy / float(SIDE);
  vec4 masks[MASK_LAYERS];
  vec4 dynamicMasks[MAP_SLOTS];
  for (int i = 0; i < MAP_SLOTS; ++i) dynamicMasks[i] = vec4(0.0);
  for (int i = 0; i < MASK_LAYERS; ++i) masks[i] = texture(u_masks, vec3(uv, float(i)));
  float variance = 0.0;
  vec2 base = slopeOf(texture(u_base_derivatives, uv)).xy;
  f_normal = vec4(0.5 * wrinkledNormal(base, uv, masks, dynamicMasks, variance) + 0.5, 1.0);
  f_look = 0.5 * wrinkleLook(uv, masks, dynamicMasks, vec2(1.0));
}
)";

// The main functions of the ports. Looks are halved, so that factors above 1 fit.
constexpr char kGlslMain[] = R"(
layout(location = 0) out vec4 f_normal;
layout(location = 1) out vec4 f_look;
void main() {
  vec3 normal;
  vec4 look;
  furrowWrinkles(gl_FragCoord.xy / float(SIDE), normal, look);
  f_normal = vec4(0.5 * normal + 0.5, 1.0);
  f_look = 0.5 * look;
}
)";

// What Unity's ShaderLibrary provides: the macros of Direct3D 11, and UnpackNormal() of its Packing.hlsl for
// maps with x in red or alpha and y in green.
constexpr char kUnityHead[] = R"(
#define TEXTURE2D(name) Texture2D name
#define SAMPLER(name) SamplerState name
#define SAMPLE_TEXTURE2D(name, state, uv) name.Sample(state, uv)
float3 UnpackNormal(float4 packed) {
  packed.a *= packed.r;
  float3 n;
  n.xy = packed.ag * 2.0 - 1.0;
  n.z = max(1.0e-16, sqrt(1.0 - saturate(dot(n.xy, n.xy))));
  return n;
}
)";
constexpr char kUnityMain[] = R"(
struct Targets { float4 normal : SV_Target0; float4 look : SV_Target1; };
Targets main(float4 place : SV_Position) {
  Targets to;
  float3 normal, colour;
  float cavity;
  Furrow_NAME_float(place.xy / SIDE, normal, colour, cavity);
  to.normal = float4(0.5 * normal + 0.5, 1.0);
  to.look = 0.5 * float4(colour, cavity);
  return to;
}
)";

struct Images {
  std::vector<std::uint8_t> normal;  // RGBA
  std::vector<std::uint8_t> look;
};

// Files of an export in memory and, for the compilers, in a folder.
struct Exported {
  std::map<std::string, std::string> files;
  TemporaryFolder folder;
};

class ShaderParity : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto context = EglContext::Create("");
    ASSERT_TRUE(context.ok()) << context.status().ToString();
    context_ = std::move(*context);
    const fs::path share = fs::path(FURROW_BINARY_DIR) / "share" / "furrow";
    auto character = character::LoadCharacter(share / "default.glb");
    ASSERT_TRUE(character.ok()) << character.status().ToString();
    character_ = std::make_unique<character::Character>(std::move(*character));
    auto plan = authoring::PlanExport(*character_);
    ASSERT_TRUE(plan.ok()) << plan.status().ToString();
    plan_ = std::make_unique<authoring::ExportPlan>(std::move(*plan));
    auto gpu = GpuCharacter::Create(*character_);
    ASSERT_TRUE(gpu.ok()) << gpu.status().ToString();
    gpu_ = std::move(*gpu);
  }
  static void TearDownTestSuite() {
    gpu_.reset();
    context_.reset();
  }

  void SetUp() override {
    ASSERT_NE(gpu_, nullptr);
    ASSERT_TRUE(context_->MakeCurrent().ok());
  }

  static std::unique_ptr<Exported> Export(Engine engine) {
    auto exported = std::make_unique<Exported>();
    const auto done = authoring::ExportCharacter(
        *character_, {.engine = engine, .bits = {}, .generator = "test", .profiles = {}},
        [&](const std::string& name, std::string_view bytes) {
          exported->files[name] = bytes;
          const fs::path path = exported->folder / name;
          fs::create_directories(path.parent_path());
          return WriteFileAtomically(path, bytes, Flush::kNone);
        });
    EXPECT_TRUE(done.ok()) << done.status().ToString();
    return exported;
  }

  // Three sets of weights: all of one map, all of another, and a mixture.
  static std::vector<std::vector<float>> WeightSets() {
    std::vector<std::vector<float>> sets(3, std::vector<float>(plan_->weights.size(), 0.0f));
    for (std::size_t i = 0; i < plan_->weights.size(); ++i) {
      const authoring::ExportPlan::Weight& weight = plan_->weights[i];
      const bool last = weight.name.ends_with(".squash") || weight.name.ends_with(".folds");
      sets[0][i] = last ? 1.0f : 0.0f;
      sets[1][i] = last ? 0.0f : 1.0f;
      sets[2][i] = static_cast<float>(i * 7 % 11) / 10.0f;
    }
    return sets;
  }

  // Draws a program into two targets.
  static Images Draw(const gl::Program& program) {
    const std::array<gl::Texture, 2> targets = {gl::MakeTexture(GL_TEXTURE_2D),
                                                gl::MakeTexture(GL_TEXTURE_2D)};
    const gl::Framebuffer framebuffer = gl::MakeFramebuffer();
    for (GLuint i = 0; i < 2; ++i) {
      glTextureStorage2D(targets[i].name(), 1, GL_RGBA8, kSide, kSide);
      glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0 + i, targets[i].name(), 0);
    }
    const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(framebuffer.name(), 2, buffers);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, kSide, kSide);
    const gl::VertexArray none = gl::MakeVertexArray();
    glBindVertexArray(none.name());
    glUseProgram(program.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    Images images;
    for (auto* pixels : {&images.normal, &images.look}) {
      pixels->resize(std::size_t{4} * kSide * kSide);
      glReadBuffer(pixels == &images.normal ? GL_COLOR_ATTACHMENT0 : GL_COLOR_ATTACHMENT1);
      glReadPixels(0, 0, kSide, kSide, GL_RGBA, GL_UNSIGNED_BYTE, pixels->data());
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return images;
  }

  static Images DrawReference(const authoring::ExportPlan::Material& entry,
                              const std::vector<float>& weights) {
    auto tables = WrinkleTables::Create(*character_, gpu_->layout());
    EXPECT_TRUE(tables.ok()) << tables.status().ToString();
    wrinkle::BindOptions lenient;
    lenient.allow_missing = true;
    const auto binding = wrinkle::RigBinding::Create(character_->rig, character_->skeleton, {}, lenient);
    EXPECT_TRUE(binding.ok()) << binding.status().ToString();
    const std::vector<float> values(binding->driver_value_names().size(), 0.0f);
    FrameRequest request;
    request.binding = &*binding;
    request.wrinkle_weights = weights;
    request.filtered_values = values;
    EXPECT_TRUE((*tables)->Update(request).ok());
    const WrinkleTable& table =
        (*tables)->table(entry.cloth ? WrinkleGroup::kCloth : WrinkleGroup::kSkin);
    const int num_maps = (*tables)->num_maps();
    std::vector<ShaderFile> files(EmbeddedShaders().begin(), EmbeddedShaders().end());
    files.push_back({"reference.glsl", kReference});
    const std::vector<std::string> defines = {
        Define("SIDE", kSide),
        Define("MASK_LAYERS", gpu_->layout().num_mask_layers),
        Define("MAP_SLOTS", MapSlots(num_maps)),
        Define("ACTIVE_MAPS", PaddedMaps(table.maps.size(), num_maps)),
        "CROWD 0", "NORMAL_BLEND 0", "WRINKLE_TEXTURE 1", "WRINKLE_DYNAMIC 0", "WRINKLE_LOOKS 1"};
    auto program = BuildProgram({"common/fullscreen.vert.glsl", "reference.glsl"}, defines, files);
    EXPECT_TRUE(program.ok()) << program.status().ToString();
    const std::vector<std::uint8_t> block =
        WrinkleBlock(table, WrinklePart::kAll, num_maps, gpu_->layout());
    const gl::Buffer buffer = gl::MakeStaticBuffer(block.data(), block.size());
    glBindBufferBase(GL_UNIFORM_BUFFER, 2, buffer.name());
    glBindTextureUnit(1, gpu_->material(entry.material).derivatives);
    glBindTextureUnit(2, gpu_->masks());
    glBindTextureUnit(3, gpu_->wrinkle_derivatives());
    glBindTextureUnit(10, gpu_->wrinkle_looks());
    return Draw(*program);
  }

  // Loads a texture of an export as an engine does: repeated, with mip levels.
  static gl::Texture LoadTexture(const Exported& exported, const std::string& file, bool srgb) {
    const std::string& bytes = exported.files.at(file);
    const auto picture = character::DecodePicture(
        file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_TRUE(picture.ok()) << picture.status().ToString();
    const bool wide = !picture->pixels16.empty();
    constexpr GLenum kFormats[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    GLenum internal = picture->channels == 4 ? GL_RGBA8 : picture->channels == 3 ? GL_RGB8 : GL_R8;
    if (srgb) internal = GL_SRGB8;
    if (wide) internal = GL_RGBA16;
    gl::Texture texture = gl::MakeTexture(GL_TEXTURE_2D);
    int levels = 1;
    while ((std::max(picture->width, picture->height) >> levels) > 0) ++levels;
    glTextureStorage2D(texture.name(), levels, internal, picture->width, picture->height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const void* const data = wide ? static_cast<const void*>(picture->pixels16.data())
                                  : static_cast<const void*>(picture->pixels.data());
    glTextureSubImage2D(texture.name(), 0, 0, 0, picture->width, picture->height,
                        kFormats[picture->channels - 1], wide ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                        data);
    glGenerateTextureMipmap(texture.name());
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    return texture;
  }

  // Texture of a sampler by the part of its name behind "urrow": "Normal1sampler_..." is the normal map 1.
  static std::string FileOf(std::string name, const authoring::ExportPlan::Material& entry,
                            const Exported& exported, bool* srgb) {
    const std::size_t start = name.find("urrow");
    name = start == std::string::npos ? name : name.substr(start + 5);
    if (const std::size_t combined = name.find("sampler"); combined != std::string::npos) {
      name.resize(combined);
    }
    std::string digits;
    while (!name.empty() && name.back() >= '0' && name.back() <= '9') {
      digits.insert(digits.begin(), name.back());
      name.pop_back();
    }
    *srgb = false;
    if (name == "BaseNormal") return "textures/material_" + entry.name + "_normal.png";
    if (name == "Mask") return "textures/masks_" + digits + ".png";
    const auto map = static_cast<std::size_t>(std::stoi(digits));
    const std::string stem = "textures/" + plan_->maps[map].name;
    if (name == "Normal") return stem + "_normal.png";
    if (name == "Cavity") return stem + "_cavity.png";
    EXPECT_EQ(name, "Colour");
    *srgb = exported.files.count("shaders/FurrowWrinkles.hlsl") +
                exported.files.count("shaders/FurrowWrinkles.ush") >
            0;  // GLSL converts by itself
    return stem + "_colour.png";
  }

  // Binds the textures of a port and draws it. `set_weights` receives the program.
  static Images DrawPort(const std::string& fragment, const Exported& exported,
                         const authoring::ExportPlan::Material& entry,
                         const std::function<void(GLuint)>& set_weights) {
    std::vector<ShaderFile> files(EmbeddedShaders().begin(), EmbeddedShaders().end());
    files.push_back({"port.glsl", fragment});
    const std::vector<std::string> defines = {Define("SIDE", kSide)};
    const auto program = BuildProgram({"common/fullscreen.vert.glsl", "port.glsl"}, defines, files);
    EXPECT_TRUE(program.ok()) << program.status().ToString();
    if (!program.ok()) return {};
    GLint count = 0;
    glGetProgramiv(program->name(), GL_ACTIVE_UNIFORMS, &count);
    std::vector<gl::Texture> textures;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
      char name[256] = {};
      GLint size = 0;
      GLenum type = 0;
      glGetActiveUniform(program->name(), i, sizeof name, nullptr, &size, &type, name);
      if (type != GL_SAMPLER_2D) continue;
      bool srgb = false;
      const std::string file = FileOf(name, entry, exported, &srgb);
      const auto unit = static_cast<GLuint>(textures.size());
      textures.push_back(LoadTexture(exported, file, srgb));
      glProgramUniform1i(program->name(), glGetUniformLocation(program->name(), name),
                         static_cast<GLint>(unit));
      glBindTextureUnit(unit, textures.back().name());
    }
    set_weights(program->name());
    return Draw(*program);
  }

  // HLSL to GLSL. `source` lies in the folder of the export's shaders, beside the files that it includes.
  static std::string Translate(const Exported& exported, const std::string& source) {
    const fs::path shaders = exported.folder / "shaders";
    EXPECT_TRUE(WriteFileAtomically(shaders / "port.hlsl", source, Flush::kNone).ok());
    const ProcessLimits limits;
    const std::string hlsl = (shaders / "port.hlsl").string();
    const std::string spirv = (shaders / "port.spv").string();
    const std::vector<std::string> compile = {"-D", "-V", "-S", "frag", "-e", "main",
                                              "-I" + shaders.string(), "-o", spirv, hlsl};
    const auto compiled = RunLimited("/usr/bin/glslangValidator", compile, "", limits);
    EXPECT_TRUE(compiled.ok()) << compiled.status().ToString();
    const std::vector<std::string> translate = {"--version", "450", "--no-es", spirv};
    const auto glsl = RunLimited("/usr/bin/spirv-cross", translate, "", limits);
    EXPECT_TRUE(glsl.ok()) << glsl.status().ToString();
    if (!glsl.ok()) return {};
    return glsl->substr(glsl->find('\n') + 1);  // BuildProgram() writes the version
  }

  // What a Custom node does: textures and weights in, the call of README.md in the middle.
  static std::string UnrealSource(const authoring::ExportPlan::Material& entry) {
    std::string head = "#define SIDE " + std::to_string(kSide) + ".0\nSamplerState FurrowState;\n";
    std::string call = "  float3 normal = Furrow_" + entry.name + "(uv, base";
    const auto texture = [&](const std::string& name) {
      head += "Texture2D Furrow" + name + ";\n";
      return ", Furrow" + name + ", FurrowState";
    };
    const std::string packs = std::to_string((entry.weights.size() + 3) / 4);
    head += "float4 FurrowPacks[" + packs + "];\n";
    for (std::size_t i = 0; i < (entry.weights.size() + 3) / 4; ++i) {
      call += ", FurrowPacks[" + std::to_string(i) + "]";
    }
    for (const int map : entry.maps) {
      const authoring::ExportPlan::Map& of = plan_->maps[static_cast<std::size_t>(map)];
      const std::string number = std::to_string(map);
      if (of.has_relief()) call += texture("Normal" + number);
      if (of.colour >= 0) call += texture("Colour" + number);
      if (of.cavity >= 0) call += texture("Cavity" + number);
    }
    for (const int mask : entry.masks) call += texture("Mask" + std::to_string(mask));
    std::string base = "float3(0.0, 0.0, 1.0)";
    if (character_->materials[static_cast<std::size_t>(entry.material)].normal_texture >= 0) {
      head += "Texture2D FurrowBaseNormal;\n";
      base = "FurrowUnpack(FurrowBaseNormal.Sample(FurrowState, uv).rg)";
    }
    return head + "#include \"Furrow_" + entry.name + ".ush\"\n" +
           "struct Targets { float4 normal : SV_Target0; float4 look : SV_Target1; };\n"
           "Targets main(float4 place : SV_Position) {\n  Targets to;\n  float2 uv = place.xy / SIDE;\n"
           "  float3 colour;\n  float cavity;\n  float3 base = " +
           base + ";\n" + call +
           ", colour, cavity);\n  to.normal = float4(0.5 * normal + 0.5, 1.0);\n"
           "  to.look = 0.5 * float4(colour, cavity);\n  return to;\n}\n";
  }

  static void Compare(const Images& expected, const Images& actual, const std::string& what) {
    ASSERT_EQ(expected.normal.size(), actual.normal.size());
    double normal = 0.0, look = 0.0, spread = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < expected.normal.size(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto square = [](int difference) { return double{1.0} * difference * difference; };
        normal += square(expected.normal[i + c] - actual.normal[i + c]);
        look += square(expected.look[i + c] - actual.look[i + c]);
        spread += square(expected.normal[i + c] - (c == 2 ? 255 : 128));
        ++count;
      }
    }
    const double rmse = std::sqrt(normal / static_cast<double>(count));
    const double look_rmse = 2.0 * std::sqrt(look / static_cast<double>(count));
    const double folds = std::sqrt(spread / static_cast<double>(count));
    std::printf("%s: normals differ by %.2f/255, colours by %.2f/255 (from flat: %.1f/255)\n",
                what.c_str(), rmse, look_rmse, folds);
    RecordProperty(what, std::to_string(rmse));
    EXPECT_LE(rmse, kMaxRmse) << what;
    EXPECT_LE(look_rmse, kMaxRmse) << what;
    EXPECT_GT(folds, 2.0 * kMaxRmse) << what << ": the pictures are flat and prove nothing";
  }

  // Draws all materials with all sets of weights.
  template <class DrawMaterial>
  static void CompareAll(const std::string& port, const DrawMaterial& draw) {
    ASSERT_GE(plan_->materials.size(), 2u);
    for (const authoring::ExportPlan::Material& entry : plan_->materials) {
      int number = 0;
      for (const std::vector<float>& weights : WeightSets()) {
        Compare(DrawReference(entry, weights), draw(entry, weights),
                port + "_" + entry.name + "_" + std::to_string(++number));
      }
    }
  }

  static std::unique_ptr<EglContext> context_;
  static std::unique_ptr<character::Character> character_;
  static std::unique_ptr<authoring::ExportPlan> plan_;
  static std::unique_ptr<GpuCharacter> gpu_;
};

std::unique_ptr<EglContext> ShaderParity::context_;
std::unique_ptr<character::Character> ShaderParity::character_;
std::unique_ptr<authoring::ExportPlan> ShaderParity::plan_;
std::unique_ptr<GpuCharacter> ShaderParity::gpu_;

std::string Named(std::string text, const std::string& name) {
  const std::size_t at = text.find("NAME");
  return at == std::string::npos ? text : text.replace(at, 4, name);
}

// The block of the uniforms outside any block: an array of floats has a stride of 16 bytes in HLSL.
gl::Buffer GlobalBlock(GLuint program, const std::vector<float>& weights, std::size_t stride) {
  std::vector<float> block(std::max<std::size_t>(weights.size(), 1) * stride, 0.0f);
  for (std::size_t i = 0; i < weights.size(); ++i) block[i * stride] = weights[i];
  gl::Buffer buffer = gl::MakeStaticBuffer(block.data(), block.size() * sizeof(float));
  glUniformBlockBinding(program, 0, 5);
  glBindBufferBase(GL_UNIFORM_BUFFER, 5, buffer.name());
  return buffer;
}

TEST_F(ShaderParity, Glsl) {
  const auto exported = Export(Engine::kGeneric);
  CompareAll("glsl", [&](const auto& entry, const std::vector<float>& weights) {
    const std::string fragment = exported->files.at("shaders/furrow_wrinkles.glsl") +
                                 exported->files.at("shaders/furrow_" + entry.name + ".glsl") + kGlslMain;
    return DrawPort(fragment, *exported, entry, [&](GLuint program) {
      glProgramUniform1fv(program, glGetUniformLocation(program, "furrowWeights"),
                          static_cast<GLsizei>(weights.size()), weights.data());
    });
  });
}

TEST_F(ShaderParity, Unity) {
  const auto exported = Export(Engine::kUnity);
  std::map<std::string, std::string> translated;
  CompareAll("unity", [&](const auto& entry, const std::vector<float>& weights) {
    std::string& glsl = translated[entry.name];
    if (glsl.empty()) {
      glsl = Translate(*exported, "#define SIDE " + std::to_string(kSide) + ".0\n" + kUnityHead +
                                      "#include \"Furrow_" + entry.name + ".hlsl\"\n" +
                                      Named(kUnityMain, entry.name));
    }
    gl::Buffer block;
    return DrawPort(glsl, *exported, entry,
                    [&](GLuint program) { block = GlobalBlock(program, weights, 4); });
  });
}

TEST_F(ShaderParity, Unreal) {
  const auto exported = Export(Engine::kUnreal);
  std::map<std::string, std::string> translated;
  CompareAll("unreal", [&](const auto& entry, const std::vector<float>& weights) {
    std::string& glsl = translated[entry.name];
    if (glsl.empty()) glsl = Translate(*exported, UnrealSource(entry));
    std::vector<float> packed;  // the material's weights, in its order
    for (const int weight : entry.weights) packed.push_back(weights[static_cast<std::size_t>(weight)]);
    packed.resize((packed.size() + 3) / 4 * 4);
    gl::Buffer block;
    Images images = DrawPort(glsl, *exported, entry,
                             [&](GLuint program) { block = GlobalBlock(program, packed, 1); });
    // Green points down there.
    for (std::size_t i = 1; i < images.normal.size(); i += 4) {
      images.normal[i] = static_cast<std::uint8_t>(255 - images.normal[i]);
    }
    return images;
  });
}

}  // namespace
}  // namespace furrow::render
