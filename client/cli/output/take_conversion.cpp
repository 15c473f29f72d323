// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/take_conversion.h"

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "base/status.h"
#include "base/text.h"
#include "base/time/timecode.h"
#include "client/cli/common/progress.h"
#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"
#include "recording/take_writer.h"
#include "recording/wire_pose.h"

namespace furrow::cli {
namespace {

using protocol::DecodeStatus;
using recording::TakeKind;
using recording::TakeMessage;

// Encodes a message into `bytes` and validates it as a receiver would. Returns its payload.
template <class Message>
Result<std::span<const std::uint8_t>> Encoded(protocol::Encoder& encoder, const Message& message,
                                              std::vector<std::uint8_t>* bytes) {
  encoder.Encode({.session = 1}, message, *bytes);
  protocol::MessageView view;
  Message back;
  DecodeStatus status = protocol::OpenMessage(*bytes, view);
  if (status == DecodeStatus::kOk) status = protocol::Decode(view, back);
  if (status == DecodeStatus::kOk) return view.payload;
  return Status(StatusCode::kInvalidArgument,
                "the wire format cannot carry this: " + std::string(DecodeStatusName(status)));
}

// The format of `furrow solve`, so that the two can be compared line by line.
std::string RowOf(std::uint32_t frame, double seconds, const std::vector<float>& values) {
  char text[64];
  std::snprintf(text, sizeof text, "%u,%.6f", frame, seconds);
  std::string row = text;
  for (const float value : values) {
    std::snprintf(text, sizeof text, ",%.6f", static_cast<double>(value));
    row += text;
  }
  return row;
}

// Collects the rows of one subject: the requested one, or the first one seen.
class WeightTable {
 public:
  explicit WeightTable(std::string subject) : subject_(std::move(subject)) {}

  // Returns false at a second subject if none was requested.
  [[nodiscard]] bool Add(const TakeMessage& message) {
    if (message.kind != TakeKind::kNames && message.kind != TakeKind::kWeights) return true;
    if (subject_.empty()) {
      if (found_.empty()) found_ = message.subject;
      if (found_ != message.subject) return false;
    } else if (message.subject != subject_) {
      return true;
    }
    if (message.kind == TakeKind::kNames) {
      AddNames(message);
    } else {
      AddWeights(message);
    }
    return true;
  }
  // Empty: there are no names. If any row has a timecode, the last column has them. Without
  // timecodes, there is no such column, as in the output of `furrow solve`.
  [[nodiscard]] std::string Csv() const {
    if (header_.empty()) return {};
    std::string csv = header_ + (has_timecodes_ ? ",timecode\n" : "\n");
    for (const auto& [text, timecode] : rows_) {
      csv += text;
      if (has_timecodes_) csv += ',' + (timecode ? TimecodeText(*timecode) : std::string());
      csv += '\n';
    }
    return csv;
  }
  [[nodiscard]] std::size_t foreign() const { return foreign_; }

 private:
  // The first list of names is the header. Frames with other names are skipped and counted.
  void AddNames(const TakeMessage& message) {
    if (!header_.empty() || protocol::Decode(message.View(), names_) != DecodeStatus::kOk) return;
    header_ = "frame,time";
    for (const std::string& name : names_.names) header_ += "," + name;
  }
  void AddWeights(const TakeMessage& message) {
    if (protocol::Decode(message.View(), weights_) != DecodeStatus::kOk || header_.empty() ||
        weights_.names_hash != names_.names_hash) {
      ++foreign_;
    } else if (weights_.age_us == 0) {
      // Decayed weights belong to no pose.
      if (!first_us_) first_us_ = message.stamp.capture_time_us;
      const double seconds = static_cast<double>(message.stamp.capture_time_us - *first_us_) * 1e-6;
      rows_.emplace_back(RowOf(message.stamp.sequence, seconds, weights_.values),
                         weights_.timecode);
      has_timecodes_ = has_timecodes_ || weights_.timecode.has_value();
    }
  }

  std::string subject_;
  std::string found_;
  std::string header_;  // without its line end
  std::vector<std::pair<std::string, std::optional<Timecode>>> rows_;
  bool has_timecodes_ = false;
  std::size_t foreign_ = 0;
  std::optional<std::int64_t> first_us_;
  protocol::SubscribeReply names_;
  protocol::WeightFrame weights_;
};

}  // namespace

Status SaveTake(const motion::Clip& clip, const std::filesystem::path& path) {
  const std::string subject = clip.name.empty() ? path.stem().string() : clip.name;
  protocol::Encoder encoder;
  std::vector<std::uint8_t> bytes;
  protocol::SkeletonOffer offer = recording::OfferOf(clip, subject, 1.0f);
  // Before the file exists, so that a skeleton that the wire cannot carry leaves no file.
  const auto skeleton = Encoded(encoder, offer, &bytes);
  if (!skeleton.ok()) return skeleton.status().At(path.string() + ": skeleton");
  auto take = recording::TakeWriter::Create(path, {});
  FURROW_RETURN_IF_ERROR(take);
  Status status = (*take)->Write(TakeKind::kSkeleton, subject, {.session = 1}, *skeleton);
  Progress progress("converting", clip.num_frames());
  protocol::PoseFrame pose;
  pose.skeleton_hash = protocol::SkeletonHash(offer);
  for (int frame = 0; frame < clip.num_frames() && status.ok(); ++frame) {
    recording::FillPose(clip, frame, &pose);
    const auto payload = Encoded(encoder, pose, &bytes);
    if (!payload.ok()) {
      status = payload.status().At(path.string() + ": frame " + std::to_string(frame));
      break;
    }
    const double seconds = clip.times[static_cast<std::size_t>(frame)] - clip.times.front();
    status =
        (*take)->Write(TakeKind::kPose, subject,
                       {.session = 1,
                        .sequence = static_cast<std::uint32_t>(frame),
                        .capture_time_us = std::llround(seconds * 1e6),
                        .log_time_ns = static_cast<std::uint64_t>(std::llround(seconds * 1e9))},
                       *payload);
    progress.Set(frame + 1);
  }
  if (status.ok()) status = (*take)->Close();
  if (!status.ok()) {  // the file did not exist before, so it may be removed
    std::error_code error;
    std::filesystem::remove(path, error);
  }
  return status;
}

Result<std::string> WeightsToCsv(recording::TakeReader& take, const std::string& subject,
                                 motion::ClipReport* report) {
  WeightTable table(subject);
  bool single = true;
  Status status = take.ForEach([&](const TakeMessage& message) {
    single = table.Add(message);
    return single;
  });
  if (!status.ok()) return status;
  const std::string file = take.path().string();
  if (!single) {
    return Status(StatusCode::kInvalidArgument, "the take has weights of several subjects", file,
                  "select one with FILE.mcap#SUBJECT; 'furrow info FILE' lists them");
  }
  std::string csv = table.Csv();
  if (csv.empty()) {
    return Status(StatusCode::kNotFound,
                  subject.empty() ? "the take has no weights"
                                  : "the take has no weights of '" + subject + "'",
                  file, "'furrow solve' computes weights from the poses");
  }
  if (table.foreign() > 0) {
    report->warnings.push_back(file + ": skipped " + Counted(table.foreign(), "frame") +
                               " with weight names that differ from the first");
  }
  return csv;
}

}  // namespace furrow::cli
