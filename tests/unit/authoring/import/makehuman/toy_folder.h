// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tests/temporary_folder.h"

namespace furrow::authoring {

// A minimal folder in MakeHuman's layout: a head of 24 x 16 quads, a helper cube for each eye, the
// face joints that landmarks need, and a cap. The destructor removes it.
class ToyFolder {
 public:
  ToyFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  [[nodiscard]] std::filesystem::path rig() const { return folder_ / "toy.rig.json"; }
  // Paths are relative to the folder.
  void Write(const std::string& file, const std::string& text) const;
  [[nodiscard]] std::string Read(const std::string& file) const;
  void Remove(const std::string& file) const;

 private:
  TemporaryFolder folder_;
};

}  // namespace furrow::authoring
