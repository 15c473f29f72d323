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

// Writes an MCAP file incrementally: chunked, compressed with zstd, indexed, with every checksum of
// the format.
//
// - The file grows by whole records. After a crash, everything up to the last finished chunk is
//   readable, because every chunk declares the schemas and channels that it uses.
// - If a write fails (a full disk), the file is cut back to its last whole record. All later calls
//   return the same error, and Close() still leaves a readable file.
// - Messages should come in order of log time. Readers also accept other orders.
class Writer {
 public:
  // Errors: kIo (also if the file exists: a recording never overwrites a file).
  [[nodiscard]] static Result<std::unique_ptr<Writer>> Create(const std::filesystem::path& path,
                                                              const WriterOptions& options = {});
  ~Writer();  // closes the file without a summary, unlike Close()
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // Both return the new id. Ids count from 1.
  [[nodiscard]] std::uint16_t AddSchema(std::string_view name, std::string_view encoding,
                                        std::span<const std::uint8_t> data);
  [[nodiscard]] std::uint16_t AddChannel(std::string_view topic, std::string_view message_encoding,
                                         std::uint16_t schema_id,
                                         const std::map<std::string, std::string>& metadata = {});

  // Adds a message to the current chunk. Errors: kInvalidArgument (message.channel_id is not an id
  // that AddChannel() returned), kIo. Without memory, throws std::bad_alloc, and only this message
  // is lost.
  [[nodiscard]] Status Write(const Message& message);
  // False if the file is not at its path any more: it was removed or renamed, and what is written
  // is lost or elsewhere.
  [[nodiscard]] bool is_at_its_path() const;
  // Finishes the current chunk and passes it to the operating system.
  [[nodiscard]] Status FlushChunk();
  // Writes a file into the MCAP file. `time`: log and creation time, ns since the Unix epoch.
  [[nodiscard]] Status Attach(std::string_view name, std::string_view media_type,
                              std::uint64_t time, std::span<const std::uint8_t> data);
  [[nodiscard]] Status WriteMetadata(const Metadata& metadata);
  // Writes the last chunk, the summary and the footer, and flushes the file to disk.
  [[nodiscard]] Status Close();

  // Bytes in the file, without the current chunk.
  [[nodiscard]] std::uint64_t bytes_written() const { return offset_; }
  // Messages that Write() accepted. The messages of a chunk that failed are not in the file.
  [[nodiscard]] std::uint64_t num_messages() const { return num_messages_; }

 private:
  struct MetadataInfo {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };
  // A channel, kept until the file ends. A long take of short sessions has many.
  struct ChannelInfo {
    ByteWriter record;
    std::uint16_t schema_id = 0;
    std::uint64_t num_messages = 0;  // in written chunks
  };
  // A message of the current chunk.
  struct MessagePlace {
    std::uint16_t channel_id = 0;
    std::uint64_t log_time = 0;
    std::uint64_t offset = 0;  // in the chunk
  };

  Writer(int file, std::filesystem::path path, const WriterOptions& options);
  [[nodiscard]] Status Append(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Status AppendRecord(Opcode opcode, const ByteWriter& content);
  // Without memory, throws std::bad_alloc and leaves a torn record at the end of the chunk.
  void AppendToChunk(const Message& message);
  void DeclareInChunk(std::uint16_t channel_id);
  void CountChunk();
  void BeginChunk();
  [[nodiscard]] ByteWriter IndexChunk(const ChunkInfo& chunk);
  [[nodiscard]] ByteWriter Statistics() const;
  [[nodiscard]] Status WriteSummary();

  int file_ = -1;
  std::filesystem::path path_;
  WriterOptions options_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;  // of the file so far
  Status failure_;
  bool closed_ = false;

  std::vector<Schema> schemas_;        // id i + 1
  std::vector<ChannelInfo> channels_;  // id i + 1
  ByteWriter chunk_;
  ChunkInfo chunk_info_;
  std::vector<MessagePlace> places_;  // of the current chunk's messages
  std::set<std::uint16_t> declared_;  // channels of the current chunk
  std::set<std::uint16_t> declared_schemas_;
  std::uint64_t num_messages_ = 0;      // accepted by Write()
  std::uint64_t written_messages_ = 0;  // in written chunks, like the times below
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
  std::vector<ByteWriter> chunk_index_;
  std::vector<AttachmentInfo> attachments_;
  std::vector<MetadataInfo> metadata_;
};

}  // namespace furrow::motion::mcap
