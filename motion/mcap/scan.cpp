// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/scan.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "motion/mcap/chunk.h"

namespace furrow::motion::mcap {
namespace {

// The fields before a chunk's data, without the name of its compression.
constexpr std::uint64_t kChunkHeadBytes = 64;
constexpr std::uint64_t kAttachmentHeadBytes = 64u << 10;  // enough for the names of an attachment

class Scanner {
 public:
  Scanner(const RecordFile& file, Index* index, Warnings* warnings)
      : file_(file), index_(*index), warnings_(*warnings) {}

  [[nodiscard]] Status Visit(const Record& record) {
    switch (record.opcode) {
      case Opcode::kChunk: return AddChunk(record);
      case Opcode::kAttachment: return AddAttachment(record);
      case Opcode::kSchema:
      case Opcode::kChannel:
      case Opcode::kMetadata:
      case Opcode::kMessage: return AddWhole(record);
      default: return {};
    }
  }

 private:
  // A chunk counts if it can be decompressed, which also adds its channels.
  Status AddChunk(const Record& record) {
    const auto head = ReadHead(record, kChunkHeadBytes);
    FURROW_RETURN_IF_ERROR(head);
    ByteReader fields(*head);
    ChunkInfo info;
    info.start_time = fields.Get<std::uint64_t>();
    info.end_time = fields.Get<std::uint64_t>();
    info.uncompressed_bytes = fields.Get<std::uint64_t>();
    (void)fields.Get<std::uint32_t>();  // the checksum, which LoadChunk() verifies
    info.compression = fields.GetText();
    info.offset = record.offset;
    info.length = record.length;
    const auto records = LoadChunk(file_, info, &index_);
    if (records.status().code() == StatusCode::kIo) return records.status();
    if (!records.ok()) {
      warnings_.Add(record.offset, "a chunk is skipped: " + records.status().what());
    } else if (!index_.AddChunk(std::move(info))) {
      warnings_.Add(record.offset,
                    "a chunk is skipped: its times are wrong or there are too many chunks");
    }
    return {};
  }

  Status AddAttachment(const Record& record) {
    const auto head = ReadHead(record, kAttachmentHeadBytes);
    FURROW_RETURN_IF_ERROR(head);
    ByteReader fields(*head);
    AttachmentInfo info;
    info.log_time = fields.Get<std::uint64_t>();
    info.create_time = fields.Get<std::uint64_t>();
    info.name = fields.GetText();
    info.media_type = fields.GetText();
    info.size = fields.Get<std::uint64_t>();
    info.offset = record.offset;
    info.length = record.length;
    const bool good = fields.ok() && info.size <= record.content_length();
    if (!good || !index_.AddAttachment(std::move(info)))
      warnings_.Add(record.offset, "a damaged attachment is skipped");
    return {};
  }

  Status AddWhole(const Record& record) {
    const auto bytes = file_.ReadContent(record);
    FURROW_RETURN_IF_ERROR(bytes);
    if (!Add(record, ByteReader(*bytes)))
      warnings_.Add(record.offset, "a record is skipped: it is damaged or exceeds a limit");
    return {};
  }

  bool Add(const Record& record, const ByteReader& content) {
    switch (record.opcode) {
      case Opcode::kSchema: return index_.AddSchema(content);
      case Opcode::kChannel: return index_.AddChannel(content);
      case Opcode::kMetadata: return index_.AddMetadata(content);
      default: return index_.AddLooseMessage(content, record.offset, record.length);
    }
  }

  [[nodiscard]] Result<std::vector<std::uint8_t>> ReadHead(const Record& record,
                                                           std::uint64_t most) const {
    return file_.ReadAt(record.content_offset(), std::min(record.content_length(), most));
  }

  const RecordFile& file_;
  Index& index_;
  Warnings& warnings_;
};

}  // namespace

Status Scan(const RecordFile& file, bool is_whole, Index* index, Warnings* warnings) {
  Scanner scanner(file, index, warnings);
  std::uint64_t offset = sizeof kMagic;
  bool ended = false;
  while (!ended && offset < file.size()) {
    const auto record = file.RecordAt(offset);
    if (!record) {
      warnings->Add(offset, "the file ends within a record; its writer died or its disk was full");
      return {};
    }
    ended = record->opcode == Opcode::kDataEnd || record->opcode == Opcode::kFooter;
    if (!ended) {
      FURROW_RETURN_IF_ERROR(scanner.Visit(*record));
    }
    offset += record->length;
  }
  if (ended && is_whole) return {};
  warnings->Add(offset, ended ? "the index after the data is cut off or damaged; all data was read"
                              : "the file has no index; its writer died");
  return {};
}

}  // namespace furrow::motion::mcap
