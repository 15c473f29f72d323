// SPDX-License-Identifier: Apache-2.0
#include "recording/take_reader.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/status.h"

namespace furrow::recording {

using motion::mcap::Channel;
using motion::mcap::Message;
using motion::mcap::Reader;

protocol::MessageView TakeMessage::View() const {
  return {{.session = stamp.session,
           .stream = 0,
           .sequence = stamp.sequence,
           .capture_time_us = stamp.capture_time_us},
          MessageKindOf(kind),
          payload};
}

Result<std::unique_ptr<TakeReader>> TakeReader::Open(const std::filesystem::path& path) {
  auto file = Reader::Open(path);
  FURROW_RETURN_IF_ERROR(file);
  return std::unique_ptr<TakeReader>(new TakeReader(path, *std::move(file)));
}

Result<std::unique_ptr<TakeReader>> TakeReader::OpenBytes(std::span<const std::uint8_t> bytes,
                                                          const std::string& name) {
  auto file = Reader::OpenBytes(bytes, name);
  FURROW_RETURN_IF_ERROR(file);
  return std::unique_ptr<TakeReader>(new TakeReader(name, *std::move(file)));
}

const TakeReader::ChannelInfo* TakeReader::InfoOf(std::uint16_t id) {
  auto [found, is_new] = channels_.try_emplace(id);
  if (is_new) {
    const auto channel = file_->channels().find(id);
    ChannelInfo info;
    if (channel != file_->channels().end() &&
        ParseTopic(channel->second.topic, &info.kind, &info.subject)) {
      const Channel& about = channel->second;
      const bool raw = info.kind == TakeKind::kDatagram;
      // A foreign or damaged session reads as 0.
      if (const auto text = about.metadata.find("session"); text != about.metadata.end()) {
        const std::string& digits = text->second;
        (void)std::from_chars(digits.data(), digits.data() + digits.size(), info.session);
      }
      if (about.message_encoding == (raw ? kDatagramEncoding : kFlatBufferEncoding))
        found->second = std::move(info);
    }
  }
  return found->second ? &*found->second : nullptr;
}

// The reader's limits bound the number and the names of the channels.
void TakeReader::CountForeign(const Message& message) {
  const auto channel = file_->channels().find(message.channel_id);
  if (channel == file_->channels().end()) return;
  ForeignTopic& topic = foreign_[channel->second.topic];
  if (topic.messages == 0) {
    topic.encoding = channel->second.message_encoding;
    const auto schema = file_->schemas().find(channel->second.schema_id);
    if (schema != file_->schemas().end()) topic.schema = schema->second.name;
    topic.first_ns = topic.last_ns = message.log_time;
  }
  ++topic.messages;
  topic.first_ns = std::min(topic.first_ns, message.log_time);
  topic.last_ns = std::max(topic.last_ns, message.log_time);
}

Status TakeReader::ForEach(const std::function<bool(const TakeMessage&)>& visit) {
  // An estimate for progress: chunks also hold records other than messages. 1 avoids a total of 0.
  std::uint64_t num_bytes = 1;
  for (const motion::mcap::ChunkInfo& chunk : file_->chunks())
    num_bytes += chunk.uncompressed_bytes;
  Status status = VisitAll(visit, num_bytes);
  if (progress_) progress_(num_bytes, num_bytes);
  return status;
}

Status TakeReader::VisitAll(const std::function<bool(const TakeMessage&)>& visit,
                            std::uint64_t num_bytes) {
  std::uint64_t done = 0;
  foreign_.clear();
  return file_->ForEach({}, [&](const Message& message) {
    done += message.data.size();
    if (progress_) progress_(std::min(done, num_bytes - 1), num_bytes);
    const ChannelInfo* info = InfoOf(message.channel_id);
    if (info == nullptr) {
      CountForeign(message);
      return true;
    }
    TakeMessage known;
    known.kind = info->kind;
    known.subject = info->subject;
    known.stamp = {info->session, message.sequence, FromPublishTime(message.publish_time),
                   message.log_time};
    // Oversized payloads stay empty, which no decoder accepts.
    if (message.data.size() <= MaxPayloadBytes(info->kind)) known.payload = message.data;
    return visit(known);
  });
}

}  // namespace furrow::recording
