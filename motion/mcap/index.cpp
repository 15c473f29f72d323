// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/index.h"

#include <algorithm>
#include <utility>

namespace furrow::motion::mcap {
namespace {

constexpr std::uint64_t kEntryBytes = 128;  // estimated overhead of a record or of a map entry

}  // namespace

bool Index::Keep(std::uint64_t bytes) {
  if (!HasRoomFor(bytes)) return false;
  kept_bytes_ += bytes;
  return true;
}

bool Index::AddSchema(ByteReader content) {
  const std::uint64_t size = kEntryBytes + content.left();
  Schema schema;
  schema.id = content.Get<std::uint16_t>();
  schema.name = content.GetText();
  schema.encoding = content.GetText();
  const auto data = content.GetBytes(content.Get<std::uint32_t>());
  schema.data.assign(data.begin(), data.end());
  if (!content.ok() || schema.id == 0) return false;
  if (schemas_.contains(schema.id)) return true;
  if (!Keep(size)) return false;
  schemas_.emplace(schema.id, std::move(schema));
  return true;
}

bool Index::AddChannel(ByteReader content) {
  const std::uint64_t size = kEntryBytes + content.left();
  if (size > limits_.kept_bytes) return false;
  Channel channel;
  channel.id = content.Get<std::uint16_t>();
  channel.schema_id = content.Get<std::uint16_t>();
  channel.topic = content.GetText();
  channel.message_encoding = content.GetText();
  channel.metadata = content.GetMap();
  if (!content.ok()) return false;
  if (channels_.contains(channel.id)) return true;
  if (!Keep(size + kEntryBytes * channel.metadata.size())) return false;
  channels_.emplace(channel.id, std::move(channel));
  return true;
}

Status Index::AddDeclarations(std::span<const std::uint8_t> records) {
  bool declared = true;
  const bool whole = ForEachRecord(records, [&](Opcode opcode, const ByteReader& content) {
    if (opcode == Opcode::kSchema) declared = AddSchema(content);
    if (opcode == Opcode::kChannel) declared = AddChannel(content);
    return declared;
  });
  if (!declared)
    return {StatusCode::kParse, "one of its schemas or channels is damaged or exceeds a limit"};
  if (!whole) return {StatusCode::kParse, "the lengths of its records are wrong"};
  return {};
}

bool Index::AddMetadata(ByteReader content) {
  if (!Keep(kEntryBytes + content.left())) return false;
  Metadata metadata;
  metadata.name = content.GetText();
  metadata.values = content.GetMap();
  if (!content.ok() || !Keep(kEntryBytes * metadata.values.size())) return false;
  metadata_.push_back(std::move(metadata));
  return true;
}

bool Index::AddAttachment(AttachmentInfo info) {
  if (attachments_.size() >= limits_.records) return false;
  attachments_.push_back(std::move(info));
  return true;
}

bool Index::AddChunk(ChunkInfo info) {
  if (info.start_time > info.end_time || chunks_.size() >= limits_.records) return false;
  chunks_.push_back(std::move(info));
  return true;
}

bool Index::AddLooseMessage(ByteReader content, std::uint64_t offset, std::uint64_t length) {
  (void)content.Get<std::uint16_t>();  // channel
  (void)content.Get<std::uint32_t>();  // sequence
  const auto time = content.Get<std::uint64_t>();
  if (!content.ok()) return false;
  ChunkInfo* last = chunks_.empty() ? nullptr : &chunks_.back();
  constexpr std::uint64_t kRunBytes = 1u << 20;
  if (last != nullptr && last->compression == kLooseMessages &&
      last->offset + last->length == offset && last->length < kRunBytes) {
    last->start_time = std::min(last->start_time, time);
    last->end_time = std::max(last->end_time, time);
    last->length += length;
    last->uncompressed_bytes = last->length;
    return true;
  }
  return AddChunk({time, time, offset, length, length, length, kLooseMessages});
}

}  // namespace furrow::motion::mcap
