// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/summary.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "motion/mcap/compression.h"

namespace furrow::motion::mcap {
namespace {

constexpr std::uint64_t kFooterBytes = kRecordHeaderBytes + 20;

// Adds what the records of a summary say to an index.
class SummaryReader {
 public:
  SummaryReader(const RecordFile& file, Index* index) : file_(file), index_(*index) {}

  [[nodiscard]] Summary Read(std::span<const std::uint8_t> summary) {
    const bool whole = ForEachRecord(
        summary, [this](Opcode opcode, const ByteReader& content) { return Add(opcode, content); });
    if (!whole || !ExtentsAreApart()) return Summary::kDamaged;
    // No index lists messages outside chunks. Only the statistics reveal that there are none.
    const bool lists_messages = has_statistics_ && (num_messages_ == 0 || !index_.chunks().empty());
    return lists_messages ? Summary::kRead : Summary::kNone;
  }

 private:
  // A range of the file that the summary refers to.
  struct Extent {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };

  bool Add(Opcode opcode, ByteReader content) {
    switch (opcode) {
      case Opcode::kSchema: return index_.AddSchema(content);
      case Opcode::kChannel: return index_.AddChannel(content);
      case Opcode::kChunkIndex: return AddChunkIndex(content);
      case Opcode::kAttachmentIndex: return AddAttachmentIndex(content);
      case Opcode::kMetadataIndex: return AddMetadataIndex(content);
      case Opcode::kStatistics:
        has_statistics_ = true;
        num_messages_ = content.Get<std::uint64_t>();
        return true;
      default: return true;
    }
  }

  // Positions and sizes are claims; LoadChunk() compares them with the chunk itself.
  bool AddChunkIndex(ByteReader content) {
    ChunkInfo info;
    info.start_time = content.Get<std::uint64_t>();
    info.end_time = content.Get<std::uint64_t>();
    info.offset = content.Get<std::uint64_t>();
    info.length = content.Get<std::uint64_t>();
    (void)content.GetBytes(content.Get<std::uint32_t>());  // offsets of the message indexes
    (void)content.Get<std::uint64_t>();                    // their length
    info.compression = content.GetText();
    info.compressed_bytes = content.Get<std::uint64_t>();
    info.uncompressed_bytes = content.Get<std::uint64_t>();
    return content.ok() && AddExtent(info.offset, info.length) && index_.AddChunk(std::move(info));
  }

  bool AddAttachmentIndex(ByteReader content) {
    AttachmentInfo info;
    info.offset = content.Get<std::uint64_t>();
    info.length = content.Get<std::uint64_t>();
    info.log_time = content.Get<std::uint64_t>();
    info.create_time = content.Get<std::uint64_t>();
    info.size = content.Get<std::uint64_t>();
    info.name = content.GetText();
    info.media_type = content.GetText();
    return content.ok() && AddExtent(info.offset, info.length) &&
           index_.AddAttachment(std::move(info));
  }

  bool AddMetadataIndex(ByteReader content) {
    const auto record = file_.RecordAt(content.Get<std::uint64_t>());
    if (!content.ok() || !record || record->opcode != Opcode::kMetadata ||
        !index_.HasRoomFor(record->content_length()) ||
        !AddExtent(record->offset, record->length)) {
      return false;
    }
    const auto bytes = file_.ReadContent(*record);
    return bytes.ok() && index_.AddMetadata(ByteReader(*bytes));
  }

  // False if the range is outside the file or too short for a record.
  bool AddExtent(std::uint64_t offset, std::uint64_t length) {
    if (offset > file_.size() || length > file_.size() - offset || length <= kRecordHeaderBytes)
      return false;
    extents_.push_back({offset, length});
    return true;
  }

  bool ExtentsAreApart() {
    std::ranges::sort(extents_, {}, &Extent::offset);
    const auto overlap = [](const Extent& a, const Extent& b) {
      return a.offset + a.length > b.offset;
    };
    return std::ranges::adjacent_find(extents_, overlap) == extents_.end();
  }

  const RecordFile& file_;
  Index& index_;
  std::vector<Extent> extents_;
  bool has_statistics_ = false;
  std::uint64_t num_messages_ = 0;
};

}  // namespace

Summary ReadSummary(const RecordFile& file, Index* index, Warnings* warnings) {
  constexpr std::uint64_t kTail = kFooterBytes + sizeof kMagic;
  // The end of a complete file: a footer of fixed size, then the magic bytes again.
  if (file.size() < sizeof kMagic + kTail) return Summary::kDamaged;
  const std::uint64_t footer_at = file.size() - kTail;
  const auto tail = file.ReadAt(footer_at, kTail);
  if (!tail.ok() || !std::equal(tail->end() - sizeof kMagic, tail->end(), kMagic))
    return Summary::kDamaged;
  ByteReader footer(*tail);
  if (footer.Get<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kFooter) ||
      footer.Get<std::uint64_t>() != kFooterBytes - kRecordHeaderBytes) {
    return Summary::kDamaged;
  }
  const auto start = footer.Get<std::uint64_t>();
  (void)footer.Get<std::uint64_t>();  // start of the summary offsets, which are not needed
  const auto crc = footer.Get<std::uint32_t>();
  if (start == 0) return Summary::kNone;  // as the format defines it
  if (start < sizeof kMagic || start > footer_at) return Summary::kDamaged;
  const auto summary = file.ReadAt(start, footer_at - start);
  if (!summary.ok()) return Summary::kDamaged;
  const std::span<const std::uint8_t> covered(tail->data(), kFooterBytes - sizeof crc);
  // 0 means that the writer stated no checksum.
  if (crc != 0 && Crc32(covered, Crc32(*summary)) != crc) {
    warnings->Add(start, "the summary is damaged; the whole file was scanned instead");
    return Summary::kDamaged;
  }
  return SummaryReader(file, index).Read(*summary);
}

}  // namespace furrow::motion::mcap
