// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// The content of MakeHuman's .mhm file: what its user chose for one person. The file refers to
// targets, proxies and materials of MakeHuman's data folder and contains no geometry.
struct MhmSave {
  struct Modifier {
    std::string name;    // "macrodetails/Age", "nose/nose-hump-decr|incr"
    float value = 0.0f;  // in [-1, 1]
  };
  // A mesh that is fitted to the person.
  struct Part {
    std::string kind;  // a folder of the data folder: "eyes", "hair", "clothes", ...
    std::string name;
    std::string uuid;  // may be empty
  };
  // The material of a part, if it is not the one that the part's own file names.
  struct PartMaterial {
    std::string name;  // of the part
    std::string uuid;  // of the part; may be empty
    std::string path;  // a .mhmat file, relative to the part or to the data folder
  };

  std::string name;     // may be empty
  std::string version;  // "v1.2.0"; may be empty
  std::vector<Modifier> modifiers;
  std::vector<Part> parts;
  std::vector<PartMaterial> materials;
  std::string skin_material;          // a .mhmat file, relative to the data folder; may be empty
  std::string skeleton;               // a file of rigs/; may be empty
  bool clothes_hide_faces = true;     // clothes hide the body under them
  std::vector<std::string> warnings;  // lines without effect, values that were clamped
};

// Limits of .mhm files. Real files are smaller than 32 KiB.
inline constexpr std::size_t kMaxMhmBytes = std::size_t{1} << 20;
inline constexpr std::size_t kMaxMhmModifiers = 4096;
inline constexpr std::size_t kMaxMhmParts = 256;

// What to do about a skeleton or a topology that the import does not take.
inline constexpr std::string_view kToKeepIt =
    "to keep it, export the person from MakeHuman as FBX or Collada and import that file";

// Parses a .mhm file. `source`: the file name in errors. A repeated modifier replaces the earlier
// one. Values outside [-1, 1] are clamped, as MakeHuman does. Lines of unknown kinds are skipped
// with a warning; camera, tags, subdivide and background have no effect and no warning.
//
// Errors name "source:line": kParse (no number, a line that ends too early), kNonFinite, kLimit (a
// file, list or name that is too large), kSchema (no line of a save at all).
[[nodiscard]] Result<MhmSave> ParseMhm(std::string_view text, std::string_view source);

}  // namespace furrow::authoring
