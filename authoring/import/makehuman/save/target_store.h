// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <set>

#include "authoring/import/makehuman/formats/mhtarget.h"
#include "authoring/import/makehuman/formats/npz.h"
#include "authoring/import/makehuman/save/target_library.h"
#include "base/status.h"

namespace furrow::authoring {

// The targets of a data folder of MakeHuman: the .target files below "targets", as in MakeHuman's
// source, and those that "targets.npz" packs, as in installed programs. A file takes precedence
// over the archive's copy of it.
class TargetStore {
 public:
  // Lists the targets of `folder`. Symbolic links to folders are not followed. Errors: kNotFound
  // (the folder has no targets), kLimit (more than 50,000 targets), kIo, kUnsupported (the archive
  // is a Git LFS pointer), and those of NpzArchive::Open().
  [[nodiscard]] static Result<TargetStore> Open(const std::filesystem::path& folder);

  [[nodiscard]] const TargetLibrary& library() const { return library_; }
  // Reads a target of the library. `num_base_vertices`: see ParseMhTarget(). Errors name the file:
  // those of ParseMhTarget(), or of NpzArchive::Read() and ParseMhTargetArrays(); kIo.
  [[nodiscard]] Result<MhTarget> Read(const std::filesystem::path& target,
                                      std::size_t num_base_vertices) const;

 private:
  [[nodiscard]] Status ListFiles();
  [[nodiscard]] Status OpenArchive(const std::filesystem::path& file);

  std::filesystem::path targets_;
  std::set<std::filesystem::path> files_;   // below targets_, with the extension
  std::set<std::filesystem::path> packed_;  // the same for targets that the archive alone has
  std::optional<NpzArchive> archive_;
  TargetLibrary library_;
};

}  // namespace furrow::authoring
