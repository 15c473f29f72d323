// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/npz.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <unzip.h>

#include "base/text.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxNameBytes = 1024;
constexpr uLong kEncrypted = 1;  // flag of an entry

}  // namespace

// The file that minizip reads: its functions for files act on the bytes in memory.
struct NpzArchive::Memory {
  std::string bytes;
  std::uint64_t position = 0;
  unzFile archive = nullptr;

  ~Memory() {
    if (archive != nullptr) unzClose(archive);
  }

  static Memory* Of(voidpf stream) { return static_cast<Memory*>(stream); }

  static voidpf Open(voidpf memory, const void*, int) { return memory; }
  static uLong Read(voidpf, voidpf stream, void* to, uLong size) {
    Memory* memory = Of(stream);
    const std::uint64_t left = memory->bytes.size() - memory->position;
    const std::uint64_t count = std::min<std::uint64_t>(size, left);
    std::memcpy(to, memory->bytes.data() + memory->position, count);
    memory->position += count;
    return static_cast<uLong>(count);
  }
  static uLong Write(voidpf, voidpf, const void*, uLong) { return 0; }
  static ZPOS64_T Tell(voidpf, voidpf stream) { return Of(stream)->position; }
  static long Seek(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
    Memory* memory = Of(stream);
    const std::uint64_t size = memory->bytes.size();
    std::uint64_t base = 0;
    if (origin == ZLIB_FILEFUNC_SEEK_CUR) base = memory->position;
    if (origin == ZLIB_FILEFUNC_SEEK_END) base = size;
    if (offset > size - base) return -1;
    memory->position = base + offset;
    return 0;
  }
  static int Close(voidpf, voidpf) { return 0; }
  static int Error(voidpf, voidpf) { return 0; }
};

NpzArchive::NpzArchive(std::unique_ptr<Memory> memory, std::string source)
    : memory_(std::move(memory)), source_(std::move(source)) {}
NpzArchive::NpzArchive(NpzArchive&&) noexcept = default;
NpzArchive& NpzArchive::operator=(NpzArchive&&) noexcept = default;
NpzArchive::~NpzArchive() = default;

Result<NpzArchive> NpzArchive::Open(std::string bytes, std::string source) {
  if (bytes.size() > kMaxBytes)
    return Status(StatusCode::kLimit, "the archive is larger than 256 MiB", std::move(source));
  auto memory = std::make_unique<Memory>();
  memory->bytes = std::move(bytes);
  zlib_filefunc64_def functions{Memory::Open, Memory::Read,  Memory::Write, Memory::Tell,
                                Memory::Seek, Memory::Close, Memory::Error, memory.get()};
  memory->archive = unzOpen2_64(nullptr, &functions);
  if (memory->archive == nullptr)
    return Status(StatusCode::kParse, "is not a ZIP archive, or is cut off", std::move(source));
  NpzArchive archive(std::move(memory), std::move(source));
  FURROW_RETURN_IF_ERROR(archive.ListEntries());
  return archive;
}

Status NpzArchive::ListEntries() {
  const unzFile archive = memory_->archive;
  unz_global_info64 info{};
  if (unzGetGlobalInfo64(archive, &info) != UNZ_OK)
    return {StatusCode::kParse, "the table of contents is damaged", source_};
  if (info.number_entry > kMaxEntries)
    return {StatusCode::kLimit, "the archive has more than 100000 entries", source_};
  std::array<char, kMaxNameBytes + 1> name{};
  for (std::uint64_t i = 0; i < info.number_entry; ++i) {
    const int moved = i == 0 ? unzGoToFirstFile(archive) : unzGoToNextFile(archive);
    unz_file_info64 entry{};
    unz64_file_pos position{};
    if (moved != UNZ_OK ||
        unzGetCurrentFileInfo64(archive, &entry, name.data(), kMaxNameBytes, nullptr, 0, nullptr,
                                0) != UNZ_OK ||
        unzGetFilePos64(archive, &position) != UNZ_OK)
      return {StatusCode::kParse, "the table of contents is damaged", source_};
    if (entry.size_filename > kMaxNameBytes)
      return {StatusCode::kLimit, "the name of an entry is longer than 1024 bytes", source_};
    std::string text(name.data(), entry.size_filename);
    std::replace(text.begin(), text.end(), '\\', '/');
    places_.try_emplace(std::move(text),
                        Place{position.pos_in_zip_directory, position.num_of_file});
  }
  return {};
}

void NpzArchive::ForEachName(const std::function<void(const std::string&)>& visit) const {
  for (const auto& [name, place] : places_) visit(name);
}

bool NpzArchive::Has(const std::string& name) const { return places_.contains(name); }

Result<std::string> NpzArchive::Read(const std::string& name) const {
  const std::string where = source_ + ": " + CutText(name, 200);
  const auto found = places_.find(name);
  if (found == places_.end())
    return Status(StatusCode::kNotFound, "the archive has no such entry", where);
  unz64_file_pos position{found->second.offset, found->second.index};
  if (unzGoToFilePos64(memory_->archive, &position) != UNZ_OK)
    return Status(StatusCode::kParse, "the entry is damaged", where);
  Result<std::string> bytes = ReadCurrent();
  return bytes.ok() ? std::move(bytes) : bytes.status().At(where);
}

Result<std::string> NpzArchive::ReadCurrent() const {
  const unzFile archive = memory_->archive;
  unz_file_info64 entry{};
  if (unzGetCurrentFileInfo64(archive, &entry, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    return Status(StatusCode::kParse, "the entry is damaged");
  if ((entry.flag & kEncrypted) != 0)
    return Status(StatusCode::kUnsupported, "the entry is encrypted");
  if (entry.compression_method != 0 && entry.compression_method != Z_DEFLATED)
    return Status(StatusCode::kUnsupported, "the entry's compression is not Deflate");
  if (entry.uncompressed_size > kMaxEntryBytes)
    return Status(StatusCode::kLimit, "the entry is larger than 8 MiB");
  if (unzOpenCurrentFile(archive) != UNZ_OK)
    return Status(StatusCode::kParse, "the entry is damaged");
  std::string bytes(static_cast<std::size_t>(entry.uncompressed_size), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const int count = unzReadCurrentFile(archive, bytes.data() + done,
                                         static_cast<unsigned>(bytes.size() - done));
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  // Closing compares the checksum.
  const bool intact = unzCloseCurrentFile(archive) == UNZ_OK;
  if (!intact || done != bytes.size())
    return Status(StatusCode::kParse, "the entry is damaged or cut off");
  return bytes;
}

}  // namespace furrow::authoring
