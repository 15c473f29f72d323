// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace furrow::character {

// A folder in MakeHuman's layout with a head of 24 x 16 quads, a helper cube for each eye, the face
// joints that landmarks need, and a cap to wear: as small as an import can be. Removed on
// destruction.
class ToyFolder {
 public:
  ToyFolder();
  ~ToyFolder();
  ToyFolder(const ToyFolder&) = delete;
  ToyFolder& operator=(const ToyFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path rig() const { return path_ / "toy.rig.json"; }
  // Relative to the folder.
  void Write(const std::string& file, const std::string& text) const;
  [[nodiscard]] std::string Read(const std::string& file) const;
  void Remove(const std::string& file) const;

 private:
  std::filesystem::path path_;
};

}  // namespace furrow::character
