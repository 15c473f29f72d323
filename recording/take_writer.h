// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/status.h"
#include "motion/mcap/writer.h"
#include "recording/take_format.h"

namespace furrow::recording {

// Writes one take to one file.
//
// - Write messages in order of log time, a subject's skeleton before its poses, and its names
//   before its weights.
// - Each (kind, subject, session) gets a channel on first use.
// - Errors are mcap::Writer's. After the first error nothing more is written, and Close() still
//   leaves a file that is readable up to that point.
class TakeWriter {
 public:
  // Attaches `rig_json` as "rig.json" unless it is empty. Errors: kIo (also if the file exists).
  [[nodiscard]] static Result<std::unique_ptr<TakeWriter>> Create(const std::filesystem::path& path,
                                                                  std::string_view rig_json);

  // `payload` is the FlatBuffers buffer of the kind's wire message. A skeleton that differs from
  // the subject's last one is also attached. Errors: kLimit (is_full()), kIo.
  [[nodiscard]] Status Write(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                             std::span<const std::uint8_t> payload);
  // Writes a raw datagram as it arrived at `log_time_ns` since the Unix epoch. Errors: as Write().
  [[nodiscard]] Status WriteDatagram(const DatagramSender& sender, std::uint64_t log_time_ns,
                                     std::span<const std::uint8_t> bytes);

  [[nodiscard]] bool is_at_its_path() const { return file_->is_at_its_path(); }
  // Finishes the current chunk and passes it to the operating system.
  [[nodiscard]] Status Flush() { return file_->FlushChunk(); }
  // Finishes the file and flushes it to disk.
  [[nodiscard]] Status Close() { return file_->Close(); }

  // Bytes in the file, without the current chunk.
  [[nodiscard]] std::uint64_t bytes_written() const { return file_->bytes_written(); }
  [[nodiscard]] std::uint64_t num_messages() const { return file_->num_messages(); }
  // True if no channel can be added: continue in a new file.
  [[nodiscard]] bool is_full() const { return num_channels_ >= kMaxChannels; }

 private:
  static constexpr std::size_t kMaxChannels = 60000;
  using SessionKey = std::pair<std::string, std::uint64_t>;  // subject, session
  using Ids = std::array<std::uint16_t, kNumTakeKinds>;      // of each kind; 0: none yet

  explicit TakeWriter(std::unique_ptr<motion::mcap::Writer> file) : file_(std::move(file)) {}
  [[nodiscard]] std::uint16_t ChannelOf(TakeKind kind, std::string_view subject,
                                        std::uint64_t session);
  [[nodiscard]] std::uint16_t SchemaOf(TakeKind kind);
  [[nodiscard]] Status AttachSkeleton(std::string_view subject, std::uint64_t log_time_ns,
                                      std::span<const std::uint8_t> payload);

  std::unique_ptr<motion::mcap::Writer> file_;
  std::map<SessionKey, Ids> channels_;
  std::size_t num_channels_ = 0;
  Ids schemas_ = {};
  std::map<std::string, std::uint64_t, std::less<>> skeletons_;  // hash of each subject's last one
  SessionKey key_;                                               // reused
  std::vector<std::uint8_t> datagram_;                           // reused
};

}  // namespace furrow::recording
