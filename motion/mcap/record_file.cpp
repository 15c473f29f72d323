// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/record_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/files.h"
#include "motion/mcap/byte_io.h"

namespace furrow::motion::mcap {

Result<RecordFile> RecordFile::Open(const std::filesystem::path& path, std::uint64_t most_bytes) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    const int error = errno;
    return Status(error == ENOENT ? StatusCode::kNotFound : StatusCode::kIo,
                  error == ENOENT ? "no such file" : std::strerror(error), path.string());
  }
  RecordFile opened(file, path.string(), 0, most_bytes);
  struct stat about = {};
  if (::fstat(file, &about) != 0) return Status(StatusCode::kIo, std::strerror(errno), path);
  if (!S_ISREG(about.st_mode)) return NotAFile(path, S_ISDIR(about.st_mode));
  opened.size_ = static_cast<std::uint64_t>(about.st_size);
  return opened;
}

RecordFile::RecordFile(std::span<const std::uint8_t> bytes, std::string name,
                       std::uint64_t most_bytes)
    : RecordFile(-1, std::move(name), bytes.size(), most_bytes) {
  memory_ = bytes;
}

RecordFile::RecordFile(int file, std::string name, std::uint64_t size, std::uint64_t most_bytes)
    : file_(file), name_(std::move(name)), size_(size), most_bytes_(most_bytes) {}

RecordFile::RecordFile(RecordFile&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      memory_(other.memory_),
      name_(std::move(other.name_)),
      size_(other.size_),
      most_bytes_(other.most_bytes_) {}

RecordFile::~RecordFile() {
  if (file_ >= 0) ::close(file_);
}

Result<std::vector<std::uint8_t>> RecordFile::ReadAt(std::uint64_t offset,
                                                     std::uint64_t size) const {
  if (offset > size_ || size > size_ - offset)
    return Status(StatusCode::kParse, "the file ends too early", name_);
  if (size > most_bytes_)
    return Status(StatusCode::kLimit,
                  "a record has " + std::to_string(size) + " bytes, the limit is " +
                      std::to_string(most_bytes_),
                  name_);
  if (file_ < 0) {
    const auto part =
        memory_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
    return std::vector<std::uint8_t>(part.begin(), part.end());
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  std::size_t done = 0;
  // pread() may return fewer bytes. It needs no file position, so const functions can read.
  while (done < bytes.size()) {
    const ssize_t got =
        ::pread(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      return Status(StatusCode::kIo, got == 0 ? "the file became shorter" : std::strerror(errno),
                    name_);
    }
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::optional<Record> RecordFile::RecordAt(std::uint64_t offset) const {
  const auto head = ReadAt(offset, kRecordHeaderBytes);
  if (!head.ok()) return std::nullopt;
  ByteReader fields(*head);
  const auto opcode = static_cast<Opcode>(fields.Get<std::uint8_t>());
  const auto content_length = fields.Get<std::uint64_t>();
  if (content_length > size_ - offset - kRecordHeaderBytes) return std::nullopt;
  return Record{opcode, offset, kRecordHeaderBytes + content_length};
}

}  // namespace furrow::motion::mcap
