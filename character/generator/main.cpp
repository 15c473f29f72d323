// SPDX-License-Identifier: Apache-2.0
//
// furrow-make-character RIGS SHARE: makes the data of share/furrow while Furrow is built. RIGS is
// the folder of rig files (default.json among them), SHARE the folder to write.
#include <cstdio>

#include "character/generator/default_character.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: furrow-make-character RIGS SHARE\n");
    return 2;
  }
  const furrow::Status status = furrow::character::generator::WriteShare(argv[1], argv[2]);
  if (status.ok()) return 0;
  std::fprintf(stderr, "furrow-make-character: %s\n", status.ToString().c_str());
  return 1;
}
