// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
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

// Calls `use(opcode, content)` for every record of `bytes` until it returns false. Returns false
// then, and if the lengths of the records are wrong.
template <class Use>
[[nodiscard]] bool ForEachRecord(std::span<const std::uint8_t> bytes, const Use& use) {
  ByteReader records(bytes);
  while (records.ok() && !records.at_end()) {
    // A record: u8 opcode, u64 length, then `length` bytes.
    const auto opcode = static_cast<Opcode>(records.Get<std::uint8_t>());
    const ByteReader content(records.GetBytes(records.Get<std::uint64_t>()));
    if (!records.ok() || !use(opcode, content)) return false;
  }
  return records.ok();
}

// The contents of a file except its messages. Functions that add a record return false if it is
// damaged or exceeds a limit; `content` is that of the record.
class Index {
 public:
  explicit Index(const ReaderLimits& limits) : limits_(limits) {}

  [[nodiscard]] const ReaderLimits& limits() const { return limits_; }
  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  [[nodiscard]] const std::vector<ChunkInfo>& chunks() const { return chunks_; }
  [[nodiscard]] const std::vector<AttachmentInfo>& attachments() const { return attachments_; }
  [[nodiscard]] const std::vector<Metadata>& metadata() const { return metadata_; }

  // Chunks and the summary repeat declarations: the first one counts, and repetitions cost nothing.
  [[nodiscard]] bool AddSchema(ByteReader content);
  [[nodiscard]] bool AddChannel(ByteReader content);
  // Adds the schemas and channels among the records of a chunk. Errors: kParse.
  [[nodiscard]] Status AddDeclarations(std::span<const std::uint8_t> records);
  [[nodiscard]] bool AddMetadata(ByteReader content);
  // True if metadata of that many bytes may still be added.
  [[nodiscard]] bool HasRoomFor(std::uint64_t bytes) const {
    return bytes <= limits_.kept_bytes - kept_bytes_;
  }
  [[nodiscard]] bool AddAttachment(AttachmentInfo info);
  [[nodiscard]] bool AddChunk(ChunkInfo info);
  // Adds a message outside of chunks: a record of `length` bytes at `offset`. Messages that follow
  // each other become runs of up to 1 MiB, as uncompressed chunks are.
  [[nodiscard]] bool AddLooseMessage(ByteReader content, std::uint64_t offset,
                                     std::uint64_t length);

 private:
  // Counts bytes towards ReaderLimits::kept_bytes. False if they exceed it.
  [[nodiscard]] bool Keep(std::uint64_t bytes);

  ReaderLimits limits_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<ChunkInfo> chunks_;
  std::vector<AttachmentInfo> attachments_;
  std::vector<Metadata> metadata_;
  std::uint64_t kept_bytes_ = 0;
};

}  // namespace furrow::motion::mcap
