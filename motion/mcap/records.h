// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

// The records of an MCAP file (mcap.dev/spec, version 0) that programs use. Times are nanoseconds
// since the Unix epoch.
namespace furrow::motion::mcap {

struct Schema {
  std::uint16_t id = 0;            // not 0
  std::string name;                // "furrow.protocol.wire.Pose"
  std::string encoding;            // "flatbuffer"
  std::vector<std::uint8_t> data;  // FlatBuffers: the binary schema (.bfbs)
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  // 0: none
  std::string topic;
  std::string message_encoding;
  std::map<std::string, std::string> metadata;
};

// A message. `data` refers to the memory of the reader or caller and is valid during the call that
// passes it.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      // when it was recorded
  std::uint64_t publish_time = 0;  // when it was created
  std::span<const std::uint8_t> data;
};

// A file inside the MCAP file.
struct AttachmentInfo {
  std::string name;
  std::string media_type;
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  std::uint64_t size = 0;    // bytes of its data
  std::uint64_t offset = 0;  // of its record in the file
  std::uint64_t length = 0;  // of its record
};

struct ChunkInfo {
  std::uint64_t start_time = 0;  // of its messages
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;  // of its record in the file
  std::uint64_t length = 0;  // of its record
  std::uint64_t compressed_bytes = 0;
  std::uint64_t uncompressed_bytes = 0;
  std::string compression;  // "zstd", "lz4" or none
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;
};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::uint8_t kMagic[8] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::uint64_t kRecordHeaderBytes = 9;  // opcode, length

}  // namespace furrow::motion::mcap
