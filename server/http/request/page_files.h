// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::server {

// One file of the web page.
struct PageFile {
  std::string_view type;  // "text/html; charset=utf-8"
  std::string bytes;
  std::string gzip;        // `bytes` compressed; empty if that is not smaller
  std::string etag;        // with quotation marks
  bool immutable = false;  // the name contains a hash of the content
};

// The character for browsers that draw it themselves.
inline constexpr char kCharacterPath[] = "/character.glb";

// The page as the picture alone, for frames of other pages.
inline constexpr char kEmbedPath[] = "/embed";

// The files of the web page, read and compressed once. Requests never access the file system.
class PageFiles {
 public:
  static constexpr std::uintmax_t kMaxBytes = 64u << 20;  // of all files together

  // Reads every regular file under `folder` as "/<path>"; "/" and kEmbedPath are index.html.
  // Errors: kNotFound (no folder or no index.html), kIo, kLimit.
  [[nodiscard]] static Result<PageFiles> Load(const std::filesystem::path& folder);

  // Adds one more file as `name` ("/character.glb"). Errors: kIo, kLimit (more than `most` bytes).
  [[nodiscard]] Status Add(std::string name, const std::filesystem::path& file,
                           std::uintmax_t most);

  // The file at `path` ("/app.js"), owned by this object; null if there is none.
  [[nodiscard]] const PageFile* Find(std::string_view path) const;

 private:
  std::map<std::string, PageFile, std::less<>> files_;
};

}  // namespace furrow::server
