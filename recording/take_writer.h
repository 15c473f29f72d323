// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/status.h"
#include "motion/mcap/writer.h"
#include "recording/take_format.h"

namespace furrow::recording {

// Writes one take, a file of its own.
//
// - Messages come in the order of their log times. A subject's skeleton comes before its poses, its
//   names before its weights.
// - Channels are made as they are met, one a (kind, subject, session).
// - Errors are mcap::Writer's: after the first nothing more is written, and Close() still leaves a
//   file that is readable up to there.
class TakeWriter {
 public:
  // `rig_json`: attached as "rig.json"; empty: none. Errors: kIo (also where the file exists).
  [[nodiscard]] static Result<std::unique_ptr<TakeWriter>> Create(const std::filesystem::path& path,
                                                                  std::string_view rig_json);

  // `payload`: the FlatBuffers buffer of the kind's wire message. A skeleton that differs from the
  // subject's last becomes an attachment too. Errors: kLimit (is_full()), kIo.
  [[nodiscard]] Status Write(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                             std::span<const std::uint8_t> payload);
  [[nodiscard]] Status WriteDatagram(const DatagramSender& sender, std::uint64_t log_time_ns,
                                     std::span<const std::uint8_t> bytes);

  // Hands what there is to the operating system as a whole chunk.
  [[nodiscard]] Status Flush() { return file_->FlushChunk(); }
  [[nodiscard]] Status Close() { return file_->Close(); }

  // Without the chunk under way.
  [[nodiscard]] std::uint64_t bytes_written() const { return file_->bytes_written(); }
  [[nodiscard]] std::uint64_t num_messages() const { return file_->num_messages(); }
  // MCAP counts channels in 16 bits: time for the next file.
  [[nodiscard]] bool is_full() const { return channels_.size() >= kMaxChannels; }

 private:
  static constexpr std::size_t kMaxChannels = 60000;
  using ChannelKey = std::tuple<std::string, std::uint64_t, TakeKind>;

  explicit TakeWriter(std::unique_ptr<motion::mcap::Writer> file) : file_(std::move(file)) {}
  [[nodiscard]] std::uint16_t ChannelOf(TakeKind kind, std::string_view subject,
                                        std::uint64_t session);
  [[nodiscard]] std::uint16_t SchemaOf(TakeKind kind);
  [[nodiscard]] Status AttachSkeleton(std::string_view subject, std::uint64_t log_time_ns,
                                      std::span<const std::uint8_t> payload);

  std::unique_ptr<motion::mcap::Writer> file_;
  std::map<ChannelKey, std::uint16_t> channels_;
  std::map<TakeKind, std::uint16_t> schemas_;
  std::map<std::string, std::vector<std::uint8_t>, std::less<>> skeletons_;  // the last a subject
  ChannelKey key_;                                                           // reused
  std::vector<std::uint8_t> datagram_;                                       // reused
};

}  // namespace furrow::recording
