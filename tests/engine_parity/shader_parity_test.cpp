// SPDX-License-Identifier: Apache-2.0
// The shaders that `furrow export` writes, against those of the renderer. Both draw the wrinkled
// tangent-space normals of the default character over its UV square, half as large as the textures,
// so that mip levels take part. HLSL is compiled by glslangValidator and translated by spirv-cross.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <regex>
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
// The largest root mean square difference, in steps of 255. Pictures of engines may differ by 3.
constexpr double kMaxRmse = 1.0;
// The folds must change the normals by more, or the comparison proves nothing.
constexpr double kMinChange = 2.0;

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

// What Unity's ShaderLibrary provides: the macros of Direct3D 11, and UnpackNormal() of its
// Packing.hlsl for maps with x in red or alpha and y in green.
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

constexpr char kUnrealMain[] = R"(
struct Targets { float4 normal : SV_Target0; float4 look : SV_Target1; };
Targets main(float4 place : SV_Position) {
  Targets to;
  float2 uv = place.xy / SIDE;
  float3 base = FurrowUnpack(BaseNormalMap.Sample(BaseNormalMapSampler, uv).rg);
  float3 colour;
  float cavity;
  float3 normal = Node(uv, base, colour, cavity);
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
  std::map<std::string, gl::Texture> textures;  // by file, once they are used
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
    const auto binding =
        wrinkle::RigBinding::Create(character_->rig, character_->skeleton, {}, lenient);
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
        "CROWD 0",
        "NORMAL_BLEND 0",
        "WRINKLE_TEXTURE 1",
        "WRINKLE_DYNAMIC 0",
        "WRINKLE_LOOKS 1"};
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
                        kFormats[picture->channels - 1],
                        wide ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, data);
    glGenerateTextureMipmap(texture.name());
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    return texture;
  }

  // The texture of a sampler: "furrowNormal1" and spirv-cross'
  // "SPIRV_Cross_CombinedNormal1Normal1Sampler" are the normal map 1.
  static std::string FileOf(const std::string& name, const authoring::ExportPlan::Material& entry,
                            const Exported& exported, bool* srgb) {
    static const std::regex kKinds("(BaseNormal|Normal|Colour|Cavity|Mask)([0-9]*)");
    std::smatch match;
    if (!std::regex_search(name, match, kKinds)) {
      ADD_FAILURE() << "unknown sampler " << name;
      return "textures/masks_0.png";
    }
    *srgb = false;
    if (match[1] == "BaseNormal") return "textures/material_" + entry.name + "_normal.png";
    if (match[1] == "Mask") return "textures/masks_" + match[2].str() + ".png";
    const auto map = static_cast<std::size_t>(std::stoi(match[2].str()));
    const std::string stem = "textures/" + plan_->maps[map].name;
    if (match[1] == "Normal") return stem + "_normal.png";
    if (match[1] == "Cavity") return stem + "_cavity.png";
    // GLSL converts by itself.
    *srgb = !exported.files.contains("shaders/furrow_wrinkles.glsl");
    return stem + "_colour.png";
  }

  // Binds the textures of a port and draws it. `set_weights` receives the program.
  static Images DrawPort(const std::string& fragment, Exported& exported,
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
    GLuint unit = 0;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
      char name[256] = {};
      GLint size = 0;
      GLenum type = 0;
      glGetActiveUniform(program->name(), i, sizeof name, nullptr, &size, &type, name);
      if (type != GL_SAMPLER_2D) continue;
      bool srgb = false;
      const std::string file = FileOf(name, entry, exported, &srgb);
      if (!exported.textures.contains(file)) {
        exported.textures[file] = LoadTexture(exported, file, srgb);
      }
      glProgramUniform1i(program->name(), glGetUniformLocation(program->name(), name),
                         static_cast<GLint>(unit));
      glBindTextureUnit(unit++, exported.textures[file].name());
    }
    set_weights(program->name());
    return Draw(*program);
  }

  // HLSL to GLSL. `source` lies in the folder of the export's shaders, beside the files that it
  // includes.
  static std::string Translate(const Exported& exported, const std::string& source) {
    const fs::path shaders = exported.folder / "shaders";
    EXPECT_TRUE(WriteFileAtomically(shaders / "port.hlsl", source, Flush::kNone).ok());
    const ProcessLimits limits;
    const std::string hlsl = (shaders / "port.hlsl").string();
    const std::string spirv = (shaders / "port.spv").string();
    const std::vector<std::string> compile = {
        "-D", "-V", "-S", "frag", "-e", "main", "-I" + shaders.string(), "-o", spirv, hlsl};
    const auto compiled = RunLimited("/usr/bin/glslangValidator", compile, "", limits);
    EXPECT_TRUE(compiled.ok()) << compiled.status().ToString();
    const std::vector<std::string> translate = {"--version", "450", "--no-es", spirv};
    const auto glsl = RunLimited("/usr/bin/spirv-cross", translate, "", limits);
    EXPECT_TRUE(glsl.ok()) << glsl.status().ToString();
    if (!glsl.ok()) return {};
    return glsl->substr(glsl->find('\n') + 1);  // BuildProgram() writes the version
  }

  // A Custom node with the code that README.md gives for a material, its inputs as global names.
  static std::string UnrealSource(const Exported& exported,
                                  const authoring::ExportPlan::Material& entry) {
    const std::string& readme = exported.files.at("README.md");
    const std::size_t start = readme.find("return Furrow_" + entry.name + "(");
    EXPECT_NE(start, std::string::npos);
    const std::string code = readme.substr(start, readme.find("```", start) - start);
    std::string inputs;
    static const std::regex kTextures("(\\w+), (\\w+Sampler)");
    for (std::sregex_iterator it(code.begin(), code.end(), kTextures), end; it != end; ++it) {
      inputs += "Texture2D " + (*it)[1].str() + ";\nSamplerState " + (*it)[2].str() + ";\n";
    }
    const std::size_t packs = (entry.weights.size() + 3) / 4;
    inputs += "float4 FurrowPacks[" + std::to_string(packs) + "];\n";
    for (std::size_t i = 0; i < packs; ++i) {
      const std::string number = std::to_string(i);
      inputs += "#define Weights" + number + " FurrowPacks[" + number + "]\n";
    }
    return "#include \"Furrow_" + entry.name + ".ush\"\n#define SIDE " + std::to_string(kSide) +
           ".0\nTexture2D BaseNormalMap;\nSamplerState BaseNormalMapSampler;\n" + inputs +
           "float3 Node(float2 UV, float3 BaseNormal, out float3 Colour, out float Cavity) {\n" +
           code + "}\n" + kUnrealMain;
  }

  // The root mean square difference of two pictures over `channels` of four, in steps of 255.
  static double Rmse(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                     std::size_t channels) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double difference = i % 4 < channels ? double{a[i]} - double{b[i]} : 0.0;
      sum += difference * difference;
    }
    return std::sqrt(sum / (static_cast<double>(a.size()) * static_cast<double>(channels) / 4.0));
  }

  static void Compare(const Images& expected, const Images& actual, const Images& neutral,
                      const std::string& what) {
    ASSERT_EQ(expected.normal.size(), actual.normal.size());
    const double normal = Rmse(expected.normal, actual.normal, 3);
    const double look = 2.0 * Rmse(expected.look, actual.look, 4);
    const double change = Rmse(expected.normal, neutral.normal, 3);
    const double tint = 2.0 * Rmse(expected.look, neutral.look, 4);
    std::printf(
        "%s: normals differ by %.2f/255, looks by %.2f/255 (the folds change them by %.1f and "
        "%.1f)\n",
        what.c_str(), normal, look, change, tint);
    EXPECT_LE(normal, kMaxRmse) << what;
    EXPECT_LE(look, kMaxRmse) << what;
    EXPECT_GT(change, kMinChange) << what;
    EXPECT_GT(tint, kMinChange) << what;
  }

  // Draws all materials with all sets of weights.
  template <class DrawMaterial>
  static void CompareAll(const std::string& port, const DrawMaterial& draw) {
    ASSERT_GE(plan_->materials.size(), 2u);
    for (const authoring::ExportPlan::Material& entry : plan_->materials) {
      const Images neutral = DrawReference(entry, std::vector<float>(plan_->weights.size(), 0.0f));
      int number = 0;
      for (const std::vector<float>& weights : WeightSets()) {
        Compare(DrawReference(entry, weights), draw(entry, weights), neutral,
                port + ", " + entry.name + ", weights " + std::to_string(++number));
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
                                 exported->files.at("shaders/furrow_" + entry.name + ".glsl") +
                                 kGlslMain;
    return DrawPort(fragment, *exported, entry, [&](GLuint program) {
      glProgramUniform1fv(program, glGetUniformLocation(program, "furrowWeights"),
                          static_cast<GLsizei>(weights.size()), weights.data());
    });
  });
}

// What WebGL 2 compiles; the code is the same as that of the test above.
TEST_F(ShaderParity, ThreeIsGlslEs) {
  const auto exported = Export(Engine::kThree);
  for (const authoring::ExportPlan::Material& entry : plan_->materials) {
    const std::string source = "#version 300 es\nprecision highp float;\n#define SIDE 64\n" +
                               exported->files.at("shaders/furrow_wrinkles.glsl") +
                               exported->files.at("shaders/furrow_" + entry.name + ".glsl") +
                               kGlslMain;
    const std::string path = (exported->folder / "port.frag").string();
    ASSERT_TRUE(WriteFileAtomically(path, source, Flush::kNone).ok());
    const auto compiled =
        RunLimited("/usr/bin/glslangValidator", std::vector<std::string>{path}, "");
    EXPECT_TRUE(compiled.ok()) << compiled.status().ToString();
  }
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
    if (glsl.empty()) glsl = Translate(*exported, UnrealSource(*exported, entry));
    std::vector<float> packed;  // the material's weights, in its order
    for (const int weight : entry.weights)
      packed.push_back(weights[static_cast<std::size_t>(weight)]);
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
