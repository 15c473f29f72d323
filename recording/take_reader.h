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

// A message of a take in the reader's memory: it lasts as long as the call that shows it. One that
// is longer than any of its kind on the wire is shown without its payload, and so is unreadable.
struct TakeMessage {
  TakeKind kind = TakeKind::kPose;
  std::string_view subject;  // empty for datagrams
  TakeStamp stamp;
  std::span<const std::uint8_t> payload;

  // The payload as a message of the wire, still to be decoded (and so verified).
  [[nodiscard]] protocol::MessageView View() const;
};

// Called while a take is read with how many bytes are behind, of how many; the last call, with both
// equal, comes however the reading ends.
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

// Reads a take, ours or one that another program wrote with our topics. Topics and encodings that
// are none of ours are passed over; a torn or damaged file is read as mcap::Reader does.
class TakeReader {
 public:
  // Errors: mcap::Reader's.
  [[nodiscard]] static Result<std::unique_ptr<TakeReader>> Open(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const motion::mcap::Reader& file() const { return *file_; }

  // Who is told how far every ForEach() is.
  void set_progress(ReadProgress progress) { progress_ = std::move(progress); }

  // Shows every message of the take in the order of log times until `visit` returns false.
  [[nodiscard]] Status ForEach(const std::function<bool(const TakeMessage&)>& visit);

 private:
  struct ChannelInfo {
    TakeKind kind = TakeKind::kPose;
    std::string subject;
    std::uint64_t session = 0;
  };

  TakeReader(std::filesystem::path path, std::unique_ptr<motion::mcap::Reader> file)
      : path_(std::move(path)), file_(std::move(file)) {}
  // Null: not one of ours.
  [[nodiscard]] const ChannelInfo* InfoOf(std::uint16_t channel);
  [[nodiscard]] Status ShowAll(const std::function<bool(const TakeMessage&)>& visit,
                               std::uint64_t num_bytes);

  std::filesystem::path path_;
  std::unique_ptr<motion::mcap::Reader> file_;
  std::map<std::uint16_t, std::optional<ChannelInfo>> channels_;  // as they are met
  ReadProgress progress_;
};

}  // namespace furrow::recording
