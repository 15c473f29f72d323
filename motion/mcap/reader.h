// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "motion/mcap/index.h"
#include "motion/mcap/record_file.h"
#include "motion/mcap/records.h"
#include "motion/mcap/warnings.h"

namespace furrow::motion::mcap {

// Reads MCAP files of any writer. Treats every file as hostile.
//
// - A file without a summary, or with a damaged one, is scanned from the start. Every complete
//   chunk counts, and warnings() reports what was lost.
// - MCAP's summary, its statistics and its chunks are optional. A file that ends as its writer
//   intended is complete without them, and it is scanned without a warning.
// - Checksums are verified if the writer stated them. Damaged chunks, and records beyond
//   ReaderLimits::kept_bytes and ::records, are skipped with a warning.
class Reader {
 public:
  // Errors: kNotFound, kInvalidArgument (a folder or a device), kIo, kParse (not an MCAP file),
  // kLimit.
  [[nodiscard]] static Result<std::unique_ptr<Reader>> Open(const std::filesystem::path& path,
                                                            const ReaderLimits& limits = {});
  // The same for the bytes of a file, which must outlive the reader. `name`: in messages.
  [[nodiscard]] static Result<std::unique_ptr<Reader>> OpenBytes(
      std::span<const std::uint8_t> bytes, const std::string& name,
      const ReaderLimits& limits = {});

  [[nodiscard]] const std::string& profile() const { return profile_; }
  [[nodiscard]] const std::string& library() const { return library_; }
  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const { return index_.schemas(); }
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const {
    return index_.channels();
  }
  [[nodiscard]] const std::vector<ChunkInfo>& chunks() const { return index_.chunks(); }
  [[nodiscard]] const std::vector<AttachmentInfo>& attachments() const {
    return index_.attachments();
  }
  [[nodiscard]] const std::vector<Metadata>& metadata() const { return index_.metadata(); }
  // False if the file was cut off, or if its summary is damaged.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] std::uint64_t file_bytes() const { return file_.size(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_.texts(); }

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
  class Run;
  Reader(RecordFile file, const ReaderLimits& limits);
  [[nodiscard]] static Result<std::unique_ptr<Reader>> Open(RecordFile file,
                                                            const ReaderLimits& limits);
  [[nodiscard]] Status ReadHeader();
  [[nodiscard]] Status ReadIndex();
  // The messages of a chunk in `range`; null if the chunk is skipped. `held` is the number of bytes
  // that other loaded chunks occupy. Errors: kIo, kLimit (loaded_bytes).
  [[nodiscard]] Result<std::unique_ptr<Run>> LoadRun(const ChunkInfo& info, const Range& range,
                                                     std::uint64_t held);

  RecordFile file_;
  Index index_;
  Warnings warnings_;
  std::string profile_;
  std::string library_;
  bool complete_ = false;
};

}  // namespace furrow::motion::mcap
