// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "motion/mcap/byte_io.h"
#include "motion/mcap/records.h"

namespace furrow::motion::mcap {

struct WriterOptions {
  std::string profile = "furrow";
  std::uint64_t chunk_bytes = 1u << 20;  // a chunk ends when its messages reach this size
  int zstd_level = 3;                    // [1, 19]
};

// Writes an MCAP file as it goes: chunked, zstd, indexed, with every checksum of the format.
//
// - The file grows in place, a whole record at a time: whatever happens, everything up to the last
//   chunk that was ended is readable. Every chunk states the schemas and channels it uses.
// - A write that fails (a full disk) cuts the file back to its last whole record and is reported
//   once; everything after it returns the same error, and Close() leaves a readable file.
// - Messages should come in the order of their log times; readers cope when they do not.
class Writer {
 public:
  // Errors: kIo (the path; a file that is there already is not overwritten).
  [[nodiscard]] static Result<std::unique_ptr<Writer>> Create(const std::filesystem::path& path,
                                                              const WriterOptions& options = {});
  ~Writer();  // closes the file as it is; Close() completes it
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // Ids count from 1.
  [[nodiscard]] std::uint16_t AddSchema(std::string_view name, std::string_view encoding,
                                        std::span<const std::uint8_t> data);
  [[nodiscard]] std::uint16_t AddChannel(std::string_view topic, std::string_view message_encoding,
                                         std::uint16_t schema_id,
                                         const std::map<std::string, std::string>& metadata = {});

  // `message.channel_id` is one that AddChannel() gave.
  [[nodiscard]] Status Write(const Message& message);
  // Ends the chunk under way and hands it to the operating system.
  [[nodiscard]] Status FlushChunk();
  [[nodiscard]] Status Attach(std::string_view name, std::string_view media_type,
                              std::uint64_t time, std::span<const std::uint8_t> data);
  [[nodiscard]] Status WriteMetadata(const Metadata& metadata);
  // The last chunk, the summary and the footer.
  [[nodiscard]] Status Close();

  // In the file, without the chunk under way.
  [[nodiscard]] std::uint64_t bytes_written() const { return offset_; }
  // That Write() took; those of a chunk whose writing failed are not in the file.
  [[nodiscard]] std::uint64_t num_messages() const { return num_messages_; }

 private:
  struct MetadataInfo {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };
  struct ChannelIndex {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;  // log time, offset in the chunk
    std::uint64_t count = 0;                                       // in chunks that are written
  };

  Writer(int file, std::filesystem::path path, const WriterOptions& options);
  [[nodiscard]] Status Append(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Status AppendRecord(Opcode opcode, const ByteWriter& content);
  void DeclareInChunk(const Channel& channel);
  void CountChunk();
  void BeginChunk();
  [[nodiscard]] ByteWriter IndexChunk(const ChunkInfo& chunk);
  [[nodiscard]] ByteWriter Statistics() const;
  [[nodiscard]] Status WriteSummary();

  int file_ = -1;
  std::filesystem::path path_;
  WriterOptions options_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;  // of the whole file up to here
  Status failure_;
  bool closed_ = false;

  std::vector<Schema> schemas_;    // id i + 1
  std::vector<Channel> channels_;  // id i + 1
  std::vector<ChannelIndex> index_;
  ByteWriter chunk_;
  ChunkInfo chunk_info_;
  std::uint64_t chunk_messages_ = 0;
  std::set<std::uint16_t> declared_;  // channels of the chunk under way
  std::set<std::uint16_t> declared_schemas_;
  std::uint64_t num_messages_ = 0;      // given to Write()
  std::uint64_t written_messages_ = 0;  // in chunks that are written, as are the times
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
  std::vector<ByteWriter> chunk_index_;
  std::vector<AttachmentInfo> attachments_;
  std::vector<MetadataInfo> metadata_;
};

}  // namespace furrow::motion::mcap
