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

furrow::Status MakeOne(const std::string& out, std::string rigs, const CharacterOptions& options) {
  if (rigs.empty()) {
    auto shipped = furrow::FindDataFile("rigs");
    FURROW_RETURN_IF_ERROR(shipped);
    rigs = shipped->string();
  }
  return furrow::authoring::WriteCharacter(rigs, options, out);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes characters by code");
  std::string rigs, share, out;
  CharacterOptions options;
  app.add_option("RIGS", rigs, "Folder of rig files; default: the one that ships");
  app.add_option("SHARE", share, "Folder for all that ships: characters, rigs, recordings");
  app.add_option("--out", out, "FILE.glb of one character; FILE.rig.json is written beside it");
  app.add_option("--sex", options.face.sex, "-1 a woman, 0 neither, 1 a man")
      ->check(CLI::Range(-1.0f, 1.0f))
      ->capture_default_str();
  app.add_option("--age", options.face.age, "Years; sets form, skin, hair and depth of wrinkles")
      ->check(CLI::Range(18.0f, 90.0f))
      ->capture_default_str();
  app.add_option("--grey", options.face.grey, "Share of grey hair, 0 to 1; default: by age")
      ->check(CLI::Range(0.0f, 1.0f));
  app.add_option("--level", options.level, "Detail of the head: 0 (about 3,000 triangles) to 2")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  app.add_option("--texture-size", options.texture_size, "Texels, square")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (out.empty() == share.empty()) {
    std::fprintf(stderr, "furrow-make-character: either --out FILE.glb, or RIGS SHARE\n");
    return 2;
  }
  const furrow::Status status =
      share.empty() ? MakeOne(out, rigs, options) : furrow::authoring::WriteShare(rigs, share);
  if (status.ok()) return 0;
  std::fprintf(stderr, "furrow-make-character: %s\n", status.ToString().c_str());
  return 1;
}
