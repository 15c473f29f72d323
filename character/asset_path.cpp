// SPDX-License-Identifier: Apache-2.0
#include "character/asset_path.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace furrow::character {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNameBytes = 1024;

std::vector<fs::path> AssetFolders(const fs::path& folder) {
  std::vector<fs::path> folders = {folder.empty() ? fs::path(".") : folder};
  const char* variable = std::getenv("FURROW_ASSET_PATH");
  std::string_view rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    if (colon > 0) folders.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  return folders;
}

Status SystemError(std::string what, const fs::path& path) {
  return {StatusCode::kIo, std::move(what) + ": " + std::strerror(errno), path.string()};
}

// Everything on the disk, or an error: fclose() may be the first to learn that the disk is full.
bool WriteAll(std::FILE* file, std::string_view bytes) {
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool flushed = std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  const bool closed = std::fclose(file) == 0;
  return written && flushed && closed;
}

// A file beside the one that it will be; removed with the object where it was not moved there.
class Temporary {
 public:
  Temporary() = default;
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (!name_.empty()) unlink(name_.c_str());
  }

  Status Write(const FileToWrite& file) {
    std::error_code error;
    if (fs::is_directory(file.path, error)) {
      return {StatusCode::kIo, "cannot write: a folder is in the way", file.path.string()};
    }
    std::string name = file.path.string() + ".XXXXXX";
    const int descriptor = mkstemp(name.data());
    if (descriptor < 0) return SystemError("cannot create a file there", file.path);
    name_ = std::move(name);
    // mkstemp() is private to its owner; give the file the mode of any other.
    const mode_t mask = umask(0);
    umask(mask);
    const bool mode_set = fchmod(descriptor, 0666 & ~mask) == 0;
    std::FILE* stream = fdopen(descriptor, "wb");
    if (stream == nullptr) close(descriptor);
    const bool ok = stream != nullptr && WriteAll(stream, file.bytes) && mode_set;
    return ok ? Status() : SystemError("cannot write", file.path);
  }

  Status MoveTo(const fs::path& path) {
    if (std::rename(name_.c_str(), path.c_str()) != 0) return SystemError("cannot write", path);
    name_.clear();
    return {};
  }

 private:
  std::string name_;
};

}  // namespace

Status CheckAssetName(std::string_view name) {
  const auto refuse = [&](const char* why) {
    return Status(StatusCode::kInvalidArgument, "file name '" + std::string(name) + "' " + why, {},
                  "name a file beside the rig or in a folder of FURROW_ASSET_PATH");
  };
  if (name.empty()) return refuse("is empty");
  if (name.size() > kMaxNameBytes) {
    return {StatusCode::kLimit, "a file name is longer than " + std::to_string(kMaxNameBytes)};
  }
  if (name.front() == '/') return refuse("is absolute");
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      return {StatusCode::kInvalidArgument, "a file name holds a control byte"};
    }
    if (c == '\\' || c == ':') return refuse("holds a backslash or a colon");
  }
  for (const fs::path& part : fs::path(name)) {
    if (part == "..") return refuse("holds '..'");
  }
  return {};
}

Result<fs::path> FindAsset(std::string_view name, const fs::path& folder) {
  if (Status status = CheckAssetName(name); !status.ok()) return status;
  std::string tried;
  for (const fs::path& candidate : AssetFolders(folder)) {
    const fs::path path = candidate / name;
    std::error_code error;
    if (fs::is_regular_file(path, error)) return path;
    tried += (tried.empty() ? "" : ", ") + candidate.string();
  }
  return Status(StatusCode::kNotFound, "no file '" + std::string(name) + "' in " + tried, {},
                "put it beside the rig or add its folder to FURROW_ASSET_PATH");
}

Result<std::string> ReadFile(const fs::path& path, std::size_t max_bytes) {
  std::error_code error;
  const fs::file_status kind = fs::status(path, error);
  if (kind.type() == fs::file_type::not_found) {
    return Status(StatusCode::kNotFound, "no such file", path.string());
  }
  if (error) return Status(StatusCode::kIo, error.message(), path.string());
  if (kind.type() != fs::file_type::regular) {
    return Status(StatusCode::kIo, "not a regular file", path.string());
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return Status(StatusCode::kIo, error.message(), path.string());
  if (size > max_bytes) {
    return Status(StatusCode::kLimit,
                  "the file has " + std::to_string(size) + " bytes, at most " +
                      std::to_string(max_bytes) + " are read",
                  path.string());
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return SystemError("cannot open", path);
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    return Status(StatusCode::kIo, "the file became shorter while it was read", path.string());
  }
  return bytes;
}

Status WriteFileAtomically(const fs::path& path, std::string_view bytes) {
  const FileToWrite file{path, bytes};
  return WriteFilesAtomically({&file, 1});
}

Status WriteFilesAtomically(std::span<const FileToWrite> files) {
  std::vector<Temporary> written(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (Status s = written[i].Write(files[i]); !s.ok()) return s;
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (Status s = written[i].MoveTo(files[i].path); !s.ok()) return s;
  }
  return {};
}

}  // namespace furrow::character
