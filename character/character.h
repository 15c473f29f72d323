// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/status.h"
#include "character/picture.h"
#include "rig/source_notes.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// glTF's metallic-roughness material, as far as it is drawn, and what it is made of.
struct Material {
  enum class Kind { kSkin, kCloth, kEye, kHair, kOther };
  std::string name;
  Kind kind = Kind::kOther;
  glm::vec4 base_colour{1.0f};   // linear
  int base_colour_texture = -1;  // index into Character::pictures; sRGB
  int normal_texture = -1;       // tangent space, green up (glTF)
  float roughness = 0.6f;
  int roughness_texture = -1;  // green channel
  // Flesh that light passes through, metres (KHR_materials_volume): 0 where none is stated. With a
  // texture, the factor of its green channel.
  float thickness = 0.0f;
  int thickness_texture = -1;
  bool double_sided = false;
  float alpha_cutoff = 0.0f;  // 0: opaque
};

struct Vertex {
  glm::vec3 position{0.0f};                          // model space, rest pose, metres
  glm::vec3 normal{0.0f, 0.0f, 1.0f};                // unit
  glm::vec4 tangent{1.0f, 0.0f, 0.0f, 1.0f};         // w: handedness of the bitangent (glTF)
  glm::vec2 uv{0.0f};                                // v down (glTF)
  std::uint16_t joints[4] = {0, 0, 0, 0};            // into Character::skeleton
  float skin_weights[4] = {1.0f, 0.0f, 0.0f, 0.0f};  // sum to 1
};

struct Mesh {
  std::string name;
  int material = -1;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from outside
};

// What is drawn and how it wrinkles: a .glb and a wrinkle rig, both verified.
struct Character {
  std::string name;
  wrinkle::Skeleton skeleton;
  std::vector<glm::mat4> inverse_bind_matrices;  // one a joint of the skeleton
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Picture> pictures;
  wrinkle::Rig rig;
  std::filesystem::path folder;  // where the rig's own files are looked up first
  // The rig's masks and wrinkle maps, loaded: name in the rig -> index into pictures.
  std::vector<std::pair<std::string, int>> rig_pictures;
  // Pictures that the rig names and nobody has: what needs them is not drawn (weights do not care).
  std::vector<std::string> missing_rig_pictures;
  // Where the reader deviated from the glTF file: "nodes[3].matrix: the matrix has shear, ...".
  std::vector<std::string> warnings;

  [[nodiscard]] int FindRigPicture(std::string_view name) const;  // -1 when there is none
};

// Reads a .glb/.gltf and its rig (`rig` empty: "<stem>.rig.json" beside it, when it is there).
//
// - `poses` reads the rig's reference poses that name a file (see rig_file.h).
// - Everything in the file is hostile until checked: sizes before allocation, indices, finite
//   numbers, skin weights (the strongest four, renormalised), a skeleton that is a tree. Errors
//   name the file and the field ("face.glb: meshes[0].primitives[0].attributes.JOINTS_0").
// - Missing normals and tangents are computed. Pictures named by the rig are loaded: embedded ones
//   by name, files by FindAsset(); a mask that cannot be found is an error.
[[nodiscard]] Result<Character> LoadCharacter(const std::filesystem::path& glb,
                                              const std::filesystem::path& rig = {},
                                              const wrinkle::PoseSource& poses = {});

// As LoadCharacter() without a rig, from bytes in memory; `where` of errors is the field alone, and
// the character's name may be empty. `folder`: where a .gltf's own files are.
[[nodiscard]] Result<Character> ParseCharacter(std::string_view bytes,
                                               const std::filesystem::path& folder,
                                               const ReadOptions& options = {});

// Gives a character another rig, whose files are looked up in `folder` first, and loads its
// pictures.
[[nodiscard]] Status AttachRig(wrinkle::Rig rig, const std::filesystem::path& folder,
                               Character* character);

// Every picture that a rig names, masks first, each once.
[[nodiscard]] std::vector<std::string> RigPictureNames(const wrinkle::Rig& rig);

// Skeleton, skin, meshes and textures as the bytes of one .glb.
[[nodiscard]] Result<std::string> CharacterGlb(const Character& character);

// Writes them (atomically: a temporary file, then a rename).
[[nodiscard]] Status SaveCharacterGlb(const Character& character, const std::filesystem::path& glb);

}  // namespace furrow::character
