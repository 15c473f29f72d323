// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "authoring/import/makehuman/formats/mhm.h"
#include "authoring/import/makehuman/formats/mhmat.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// A material of a data folder, and the folder that its pictures are relative to.
struct FoundMaterial {
  MhMaterial material;
  std::filesystem::path file;
};

// The parts and materials of one or several data folders. MakeHuman has two: that of the program
// and that of its user, who downloads clothes into the latter.
class AssetLibrary {
 public:
  // `folders`: the data folders; the first that has an asset wins. Folders that do not exist are
  // empty.
  explicit AssetLibrary(std::vector<std::filesystem::path> folders)
      : folders_(std::move(folders)) {}

  // The .mhclo file of a part: the one with its UUID, else the one with its name or file name
  // (upper and lower case are equal). nullopt if no folder has it. The first call for a kind reads
  // the first 16 KiB of every .mhclo file of that kind.
  [[nodiscard]] std::optional<std::filesystem::path> FindPart(const MhmSave::Part& part);

  // Reads the material `path` of a save or of a .mhclo file: relative to `beside` (the folder of
  // the part; may be empty), else to the data folders. Errors: kNotFound, kInvalidArgument (a path
  // that leaves the data folders), those of ParseMhmat().
  [[nodiscard]] Result<FoundMaterial> LoadMaterial(const std::string& path,
                                                   const std::filesystem::path& beside) const;

  // Reads a picture that a material names. `name` becomes Picture::name. Errors: as above,
  // kUnsupported (a Git LFS pointer), and those of LoadPicture().
  [[nodiscard]] Result<character::Picture> LoadMaterialPicture(const FoundMaterial& material,
                                                               const std::string& picture,
                                                               const std::string& name) const;

 private:
  struct Entry {
    std::filesystem::path file;
    std::string uuid;  // lower case
    std::string name;  // lower case
  };

  const std::vector<Entry>& EntriesOf(const std::string& kind);
  [[nodiscard]] Result<std::filesystem::path> Locate(const std::string& path,
                                                     const std::filesystem::path& beside) const;

  std::vector<std::filesystem::path> folders_;
  std::map<std::string, std::vector<Entry>> entries_;  // by kind
};

}  // namespace furrow::authoring
