// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "motion/mcap/byte_io.h"
#include "motion/mcap/records.h"

namespace furrow::motion::mcap {

// The value of ChunkInfo::compression for a run of messages that are not in a chunk.
inline constexpr const char* kLooseMessages = "-";

// Limits on what a file can make a reader allocate.
struct ReaderLimits {
  std::uint64_t record_bytes = 256u << 20;  // of one record, and of one decompressed chunk
  std::uint64_t loaded_bytes = 1u << 30;    // of all chunks that overlap in time
  std::uint64_t kept_bytes = 32u << 20;     // of all schemas, channels and metadata
  std::size_t records = 1u << 20;           // of chunks, and of attachments
};

// Reads MCAP files of any writer. Treats every file as hostile.
//
// - A file without a summary, or with a damaged one, is scanned from the start. Every complete
// chunk
//   counts, and warnings() reports what was lost. A summary that refers to the same bytes twice
//   counts as damaged.
// - MCAP's summary, its statistics and its chunks are optional. A file that ends as its writer
//   intended is complete without them, and it is scanned without a warning.
// - Checksums are verified if the writer stated them. Damaged chunks, and records beyond
//   ReaderLimits::kept_bytes and ::records, are skipped with a warning.
class Reader {
 public:
  // Errors: kNotFound, kIo, kParse (not an MCAP file), kLimit.
  [[nodiscard]] static Result<std::unique_ptr<Reader>> Open(const std::filesystem::path& path,
                                                            const ReaderLimits& limits = {});
  // The same for the bytes of a file, which must outlive the reader. `name`: in messages.
  [[nodiscard]] static Result<std::unique_ptr<Reader>> OpenBytes(
      std::span<const std::uint8_t> bytes, const std::string& name,
      const ReaderLimits& limits = {});
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] const std::string& profile() const { return profile_; }
  [[nodiscard]] const std::string& library() const { return library_; }
  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  [[nodiscard]] const std::vector<ChunkInfo>& chunks() const { return chunks_; }
  [[nodiscard]] const std::vector<AttachmentInfo>& attachments() const { return attachments_; }
  [[nodiscard]] const std::vector<Metadata>& metadata() const { return metadata_; }
  // False if the file was cut off, or if its summary is damaged.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  struct Range {
    std::uint64_t from = 0;  // log times, inclusive
    std::uint64_t to = std::numeric_limits<std::uint64_t>::max();
  };
  // Calls `visit` for every message of the range until it returns false. Messages come in order of
  // log time; messages with equal times come in order of the file. Errors: kIo, kLimit (chunks that
  // overlap in time exceed ReaderLimits::loaded_bytes).
  [[nodiscard]] Status ForEach(const Range& range,
                               const std::function<bool(const Message&)>& visit);

  // Reads the data of an entry of attachments(). Errors: kIo, kParse (wrong checksum), kLimit.
  [[nodiscard]] Result<std::vector<std::uint8_t>> ReadAttachment(const AttachmentInfo& info) const;

 private:
  struct Record {
    Opcode opcode = Opcode::kHeader;
    std::uint64_t offset = 0;  // of the record
    std::uint64_t length = 0;  // of its content
  };
  // A range of the file that the summary refers to.
  struct Extent {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };
  class Run;
  Reader(int file, std::filesystem::path path, const ReaderLimits& limits);
  [[nodiscard]] Status Open();
  // kNone: the file is whole, but the summary lists too little to find its messages.
  enum class Summary { kRead, kNone, kDamaged };
  [[nodiscard]] Summary ReadSummary();
  [[nodiscard]] Summary ReadSummaryRecords(std::span<const std::uint8_t> summary);
  [[nodiscard]] bool AddSummaryRecord(Opcode opcode, ByteReader content);
  // Records a range that the summary refers to. False if it is outside the file or too short for a
  // record.
  [[nodiscard]] bool AddExtent(std::uint64_t offset, std::uint64_t length);
  [[nodiscard]] bool ExtentsAreApart();
  // `is_whole`: the file ends with a footer, so nothing is missing after the data.
  [[nodiscard]] Status Scan(bool is_whole);
  [[nodiscard]] Status ScanRecord(const Record& record);
  void ForgetIndex();

  [[nodiscard]] Result<std::vector<std::uint8_t>> ReadAt(std::uint64_t offset,
                                                         std::uint64_t size) const;
  // The record at `offset`; none if the file ends before the record does.
  [[nodiscard]] std::optional<Record> RecordAt(std::uint64_t offset) const;
  [[nodiscard]] bool AddSchema(ByteReader content);
  [[nodiscard]] bool AddChannel(ByteReader content);
  [[nodiscard]] bool AddMetadata(ByteReader content);
  [[nodiscard]] bool AddChunkIndex(ByteReader content);
  [[nodiscard]] bool AddAttachmentIndex(ByteReader content);
  [[nodiscard]] bool AddMetadataIndex(ByteReader content);
  [[nodiscard]] bool AddAttachment(std::span<const std::uint8_t> head, const Record& record);
  [[nodiscard]] Status AddScannedChunk(ByteReader head, const Record& record);
  [[nodiscard]] bool AddLooseMessage(ByteReader content, const Record& record);
  // Counts bytes towards ReaderLimits::kept_bytes. False if they exceed it.
  [[nodiscard]] bool Keep(std::uint64_t bytes);
  // The decompressed records of a chunk. Adds the chunk's schemas and channels.
  [[nodiscard]] Result<std::vector<std::uint8_t>> LoadChunk(const ChunkInfo& info);
  [[nodiscard]] Status AddDeclarations(std::span<const std::uint8_t> records);
  // The messages of a chunk in `range`; null if the chunk is skipped. `held` is the number of bytes
  // that other loaded chunks occupy. Errors: kIo, kLimit (loaded_bytes).
  [[nodiscard]] Result<std::unique_ptr<Run>> LoadRun(const ChunkInfo& info, const Range& range,
                                                     std::uint64_t held);
  void Warn(std::uint64_t offset, std::string_view what);

  int file_ = -1;  // -1: the file is in `memory_`
  std::span<const std::uint8_t> memory_;
  std::filesystem::path path_;
  ReaderLimits limits_;
  std::uint64_t file_bytes_ = 0;
  std::string profile_;
  std::string library_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<ChunkInfo> chunks_;
  std::vector<AttachmentInfo> attachments_;
  std::vector<Metadata> metadata_;
  std::vector<Extent> extents_;  // while the summary is read
  std::uint64_t kept_bytes_ = 0;
  std::vector<std::string> warnings_;
  bool complete_ = false;
};

}  // namespace furrow::motion::mcap
