// SPDX-License-Identifier: Apache-2.0
#include "recording/take_writer.h"

#include <utility>

#include "base/status.h"
#include "protocol/messages/hash.h"

namespace furrow::recording {

using motion::mcap::Message;

Result<std::unique_ptr<TakeWriter>> TakeWriter::Create(const std::filesystem::path& path,
                                                       std::string_view rig_json) {
  auto file = motion::mcap::Writer::Create(path, {.profile = kTakeProfile});
  FURROW_RETURN_IF_ERROR(file);
  std::unique_ptr<TakeWriter> take(new TakeWriter(*std::move(file)));
  if (!rig_json.empty()) {
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(rig_json.data()), rig_json.size());
    FURROW_RETURN_IF_ERROR(take->file_->Attach(kRigAttachment, "application/json", 0, bytes));
  }
  return take;
}

std::uint16_t TakeWriter::SchemaOf(TakeKind kind) {
  if (SchemaName(kind).empty()) return 0;
  std::uint16_t& id = schemas_[static_cast<std::size_t>(kind)];
  if (id == 0) id = file_->AddSchema(SchemaName(kind), kFlatBufferEncoding, BinarySchema(kind));
  return id;
}

std::uint16_t TakeWriter::ChannelOf(TakeKind kind, std::string_view subject,
                                    std::uint64_t session) {
  // A reused key: the look-up per message then does not allocate.
  key_.first.assign(subject);
  key_.second = session;
  const auto found = channels_.find(key_);
  const auto index = static_cast<std::size_t>(kind);
  if (found != channels_.end() && found->second[index] != 0) return found->second[index];
  const bool raw = kind == TakeKind::kDatagram;
  const std::map<std::string, std::string> about{{"subject", std::string(subject)},
                                                 {"session", std::to_string(session)}};
  const std::uint16_t id = file_->AddChannel(
      TopicOf(kind, subject), raw ? kDatagramEncoding : kFlatBufferEncoding, SchemaOf(kind),
      raw ? std::map<
                std::string,
                std::string>{{"data",
                              "16 bytes of IPv6 address, 2 of port (network order), the datagram"}}
          : about);
  ++num_channels_;
  channels_[key_][index] = id;
  return id;
}

Status TakeWriter::AttachSkeleton(std::string_view subject, std::uint64_t log_time_ns,
                                  std::span<const std::uint8_t> payload) {
  protocol::Hasher hasher;
  hasher.String({reinterpret_cast<const char*>(payload.data()), payload.size()});
  const std::uint64_t hash = hasher.value();
  const auto known = skeletons_.find(subject);
  if (known != skeletons_.end() && known->second == hash) return {};
  skeletons_.insert_or_assign(std::string(subject), hash);
  return file_->Attach(std::string(subject) + ".skeleton", "application/x-flatbuffers", log_time_ns,
                       payload);
}

Status TakeWriter::Write(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                         std::span<const std::uint8_t> payload) {
  if (is_full()) {
    return {StatusCode::kLimit,
            "the take has " + std::to_string(num_channels_) + " channels, the maximum"};
  }
  if (kind == TakeKind::kSkeleton) {
    FURROW_RETURN_IF_ERROR(AttachSkeleton(subject, stamp.log_time_ns, payload));
  }
  Message message;
  message.channel_id = ChannelOf(kind, subject, stamp.session);
  message.sequence = stamp.sequence;
  message.log_time = stamp.log_time_ns;
  message.publish_time = ToPublishTime(stamp.capture_time_us);
  message.data = payload;
  return file_->Write(message);
}

Status TakeWriter::WriteDatagram(const DatagramSender& sender, std::uint64_t log_time_ns,
                                 std::span<const std::uint8_t> bytes) {
  datagram_.assign(sender.begin(), sender.end());
  datagram_.insert(datagram_.end(), bytes.begin(), bytes.end());
  Message message;
  message.channel_id = ChannelOf(TakeKind::kDatagram, {}, 0);
  message.log_time = message.publish_time = log_time_ns;
  message.data = datagram_;
  return file_->Write(message);
}

}  // namespace furrow::recording
