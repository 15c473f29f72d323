// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/status.h"
#include "motion/mcap/reader.h"
#include "protocol/codec/codec.h"
#include "recording/take_format.h"

namespace furrow::recording {

// A message of a take. It refers to the reader's memory and is valid during the call that passes
// it. If the payload is longer than MaxPayloadBytes(), it is empty and cannot be decoded.
struct TakeMessage {
  TakeKind kind = TakeKind::kPose;
  std::string_view subject;  // empty for datagrams
  TakeStamp stamp;
  std::span<const std::uint8_t> payload;

  // The payload as a wire message. Decode() verifies it.
  [[nodiscard]] protocol::MessageView View() const;
};

// Called with the bytes read so far and the total while a take is read. The last call has both
// equal, even if reading fails or stops early, so that a progress bar always ends.
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

// Reads a take, whatever program wrote it. Foreign topics and encodings are ignored. Of a torn or
// damaged file, everything readable is read (see mcap::Reader).
class TakeReader {
 public:
  // Opens a file. Errors: those of mcap::Reader::Open().
  [[nodiscard]] static Result<std::unique_ptr<TakeReader>> Open(const std::filesystem::path& path);
  // The same for the bytes of a file, which must outlive the reader. `name`: in messages.
  [[nodiscard]] static Result<std::unique_ptr<TakeReader>> OpenBytes(
      std::span<const std::uint8_t> bytes, const std::string& name);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const motion::mcap::Reader& file() const { return *file_; }

  // Called by every ForEach().
  void set_progress(ReadProgress progress) { progress_ = std::move(progress); }

  // Calls `visit` for every message in order of log time until it returns false. Errors: those of
  // mcap::Reader::ForEach().
  [[nodiscard]] Status ForEach(const std::function<bool(const TakeMessage&)>& visit);

  // The channels of other programs, by topic, and the number of messages that the last ForEach()
  // passed over.
  struct ForeignTopic {
    std::string encoding;  // of the messages: "cdr", "protobuf", "json"
    std::string schema;    // its name; may be empty
    std::size_t messages = 0;
    std::uint64_t first_ns = 0;  // log times
    std::uint64_t last_ns = 0;
  };
  [[nodiscard]] const std::map<std::string, ForeignTopic>& foreign() const { return foreign_; }

 private:
  struct ChannelInfo {
    TakeKind kind = TakeKind::kPose;
    std::string subject;
    std::uint64_t session = 0;
  };

  TakeReader(std::filesystem::path path, std::unique_ptr<motion::mcap::Reader> file)
      : path_(std::move(path)), file_(std::move(file)) {}
  // Null for a foreign channel.
  [[nodiscard]] const ChannelInfo* InfoOf(std::uint16_t channel);
  void CountForeign(const motion::mcap::Message& message);
  [[nodiscard]] Status VisitAll(const std::function<bool(const TakeMessage&)>& visit,
                                std::uint64_t num_bytes);

  std::filesystem::path path_;
  std::unique_ptr<motion::mcap::Reader> file_;
  std::map<std::uint16_t, std::optional<ChannelInfo>>
      channels_;  // filled on first use; none: foreign
  std::map<std::string, ForeignTopic> foreign_;
  ReadProgress progress_;
};

}  // namespace furrow::recording
