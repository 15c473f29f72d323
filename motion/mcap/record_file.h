// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "motion/mcap/records.h"

namespace furrow::motion::mcap {

// A record of a file, header included.
struct Record {
  Opcode opcode = Opcode::kHeader;
  std::uint64_t offset = 0;  // in the file
  std::uint64_t length = 0;  // of the header and the content

  [[nodiscard]] std::uint64_t content_offset() const { return offset + kRecordHeaderBytes; }
  [[nodiscard]] std::uint64_t content_length() const { return length - kRecordHeaderBytes; }
};

// The bytes of an MCAP file, on the disk or in memory. Every read is checked against the size of
// the file and a limit.
class RecordFile {
 public:
  // `most_bytes`: the limit of a read. Errors: kNotFound, kInvalidArgument (NotAFile()), kIo.
  [[nodiscard]] static Result<RecordFile> Open(const std::filesystem::path& path,
                                               std::uint64_t most_bytes);
  // The same for bytes that outlive the object. `name`: in messages.
  RecordFile(std::span<const std::uint8_t> bytes, std::string name, std::uint64_t most_bytes);
  ~RecordFile();
  RecordFile(RecordFile&& other) noexcept;
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  RecordFile& operator=(RecordFile&&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  // Errors: kParse (the file ends before), kLimit, kIo.
  [[nodiscard]] Result<std::vector<std::uint8_t>> ReadAt(std::uint64_t offset,
                                                         std::uint64_t size) const;
  // The record that begins at `offset`; none if the file ends before the record does.
  [[nodiscard]] std::optional<Record> RecordAt(std::uint64_t offset) const;
  // The content of a record. Errors: those of ReadAt().
  [[nodiscard]] Result<std::vector<std::uint8_t>> ReadContent(const Record& record) const {
    return ReadAt(record.content_offset(), record.content_length());
  }

 private:
  RecordFile(int file, std::string name, std::uint64_t size, std::uint64_t most_bytes);

  int file_ = -1;  // -1: the bytes are in `memory_`
  std::span<const std::uint8_t> memory_;
  std::string name_;
  std::uint64_t size_ = 0;
  std::uint64_t most_bytes_ = 0;
};

}  // namespace furrow::motion::mcap
