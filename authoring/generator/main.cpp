// SPDX-License-Identifier: Apache-2.0
//
// furrow-make-character: writes share/furrow during the build of Furrow, or a single character.
#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "authoring/generator/default_character.h"
#include "base/data_dir.h"
#include "base/status.h"

namespace {

using furrow::authoring::CharacterOptions;
using furrow::authoring::FaceKind;

// Writes one character with the rigs of the folder `rigs`; empty: the shipped folder.
furrow::Status MakeOne(std::string rigs, const std::string& out, const std::string& elder,
                       const CharacterOptions& options) {
  if (rigs.empty()) {
    auto shipped = furrow::FindDataFile("rigs");
    FURROW_RETURN_IF_ERROR(shipped);
    rigs = shipped->string();
  }
  return elder.empty() ? furrow::authoring::WriteCharacter(rigs, options, out)
                       : furrow::authoring::WriteElder(rigs, elder);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Generates characters");
  std::string rigs, share, elder, out;
  std::string face = "joints";
  CharacterOptions options;
  app.add_option("RIGS", rigs, "Folder of rig files (default: the shipped folder)");
  app.add_option("SHARE", share, "Output folder for the default character, rigs and recordings");
  app.add_option("--elder", elder, "Output FILE.glb of the elder; also writes FILE.rig.json");
  app.add_option("--out", out, "Output FILE.glb of one character; also writes FILE.rig.json");
  app.add_option("--face", face,
                 "What moves the face: joints, or blend-shapes (ARKit's 52, as morph targets)")
      ->check(CLI::IsMember({"joints", "blend-shapes"}))
      ->capture_default_str();
  app.add_option("--sex", options.face.sex,
                 "Sex: -1 female, 0 neutral, 1 male; values in between blend")
      ->check(CLI::Range(-1.0f, 1.0f))
      ->capture_default_str();
  app.add_option("--age", options.face.age,
                 "Age in years; affects shape, skin, hair and depth of wrinkles")
      ->check(CLI::Range(18.0f, 90.0f))
      ->capture_default_str();
  app.add_option("--grey", options.face.grey,
                 "Fraction of grey hair, 0 to 1 (default: derived from the age)")
      ->check(CLI::Range(0.0f, 1.0f));
  app.add_option("--level", options.level,
                 "Level of detail of the head, 0 (about 3,000 triangles) to 2")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  app.add_option("--texture-size", options.texture_size, "Width and height of textures, texels")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.face_kind = face == "joints" ? FaceKind::kJoints : FaceKind::kBlendShapes;
  if (out.empty() + share.empty() + elder.empty() != 2) {
    std::fprintf(stderr,
                 "furrow-make-character: give one of --out FILE.glb, --elder FILE.glb, and RIGS "
                 "with SHARE\n");
    return 2;
  }
  const furrow::Status status = share.empty() ? MakeOne(rigs, out, elder, options)
                                              : furrow::authoring::WriteShare(rigs, share);
  if (status.ok()) return 0;
  std::fprintf(stderr, "furrow-make-character: %s\n", status.ToString().c_str());
  return 1;
}
