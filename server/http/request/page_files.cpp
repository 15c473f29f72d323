// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/page_files.h"

#include <array>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>

#include "base/files.h"
#include "base/status.h"

namespace furrow::server {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".txt", "text/plain; charset=utf-8"},
    {".glb", "model/gltf-binary"},
}};

std::string_view TypeOf(const fs::path& path) {
  const std::string extension = path.extension().string();
  for (const auto& [known, type] : kTypes) {
    if (known == extension) return type;
  }
  return "application/octet-stream";
}

// Empty if compression does not make the file smaller.
std::string Gzip(const std::string& bytes) {
  z_stream stream{};
  // The largest window, plus 16 for a gzip header (zlib.h, deflateInit2).
  constexpr int kGzipFormat = 15 + 16;
  if (deflateInit2(&stream, 9, Z_DEFLATED, kGzipFormat, 8, Z_DEFAULT_STRATEGY) != Z_OK) return {};
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const bool done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return done && out.size() < bytes.size() ? out : std::string();
}

PageFile MakeFile(const fs::path& name, std::string bytes) {
  PageFile file;
  file.type = TypeOf(name);
  file.gzip = Gzip(bytes);
  // A checksum finds changes; an ETag need not resist an attacker.
  file.etag = fmt::format(
      "\"{:08x}-{:x}\"",
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())),
      bytes.size());
  // The build names the files there after their content.
  file.immutable = name.native().starts_with("/assets/");
  file.bytes = std::move(bytes);
  return file;
}

}  // namespace

Result<PageFiles> PageFiles::Load(const fs::path& folder) {
  std::error_code error;
  PageFiles page;
  std::uintmax_t total = 0;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    // Only what the folder holds can be requested, so a path such as "/../x" finds nothing.
    if (!entry->is_regular_file()) continue;
    // All files stay in memory. The limit catches a --page that names the wrong folder.
    total += entry->file_size();
    if (total > kMaxBytes)
      return Status(StatusCode::kLimit, "the files of the page exceed 64 MiB", folder);
    Result<std::string> bytes = ReadFile(entry->path(), kMaxBytes);
    FURROW_RETURN_IF_ERROR(bytes);
    const std::string name = "/" + fs::relative(entry->path(), folder).generic_string();
    page.files_.emplace(name, MakeFile(name, *std::move(bytes)));
  }
  if (page.Find("/") == nullptr) {
    return Status(StatusCode::kNotFound, "the web page is not installed", folder,
                  "build the target furrow-web, which needs nodejs and npm");
  }
  return page;
}

Status PageFiles::Add(std::string name, const fs::path& file, std::uintmax_t most) {
  Result<std::string> bytes = ReadFile(file, most);
  FURROW_RETURN_IF_ERROR(bytes);
  PageFile made = MakeFile(name, *std::move(bytes));
  files_.insert_or_assign(std::move(name), std::move(made));
  return {};
}

const PageFile* PageFiles::Find(std::string_view path) const {
  const bool is_page = path == "/" || path == kEmbedPath;
  const auto file = files_.find(is_page ? "/index.html" : path);
  return file == files_.end() ? nullptr : &file->second;
}

}  // namespace furrow::server
