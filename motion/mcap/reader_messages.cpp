// SPDX-License-Identifier: Apache-2.0
// What a reader does with the messages of chunks: unpacks, checks and puts them in order.
#include <algorithm>
#include <queue>
#include <utility>

#include "motion/mcap/compression.h"
#include "motion/mcap/reader.h"

namespace furrow::motion::mcap {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A message that waits for its turn, and what keeps its bytes.
struct Waiting {
  Message message;
  std::uint64_t order = 0;  // in the file
  std::shared_ptr<const Bytes> records;
};

struct Later {
  bool operator()(const Waiting& a, const Waiting& b) const {
    if (a.message.log_time != b.message.log_time) return a.message.log_time > b.message.log_time;
    return a.order > b.order;
  }
};

bool ParseMessage(ByteReader content, Message* message) {
  message->channel_id = content.Get<std::uint16_t>();
  message->sequence = content.Get<std::uint32_t>();
  message->log_time = content.Get<std::uint64_t>();
  message->publish_time = content.Get<std::uint64_t>();
  message->data = content.Take(content.left());
  return content.ok();
}

// Calls `use(opcode, content)` for every record; false where they do not add up.
template <class Use>
bool ForEachRecord(std::span<const std::uint8_t> bytes, const Use& use) {
  ByteReader records(bytes);
  while (records.ok() && !records.at_end()) {
    const auto opcode = static_cast<Opcode>(records.Get<std::uint8_t>());
    ByteReader content(records.Take(records.Get<std::uint64_t>()));
    if (!records.ok() || !use(opcode, content)) return false;
  }
  return records.ok();
}

}  // namespace

Result<Bytes> Reader::LoadChunk(const ChunkInfo& info) {
  if (info.compression == kLooseMessages) return ReadAt(info.offset, info.length);
  const auto record = ReadAt(info.offset, info.length);
  if (!record.ok()) return record.status();
  ByteReader content(*record);
  if (content.Get<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kChunk))
    return Status(StatusCode::kParse, "the index points at something else");
  (void)content.Get<std::uint64_t>();  // length
  (void)content.Get<std::uint64_t>();  // start and
  (void)content.Get<std::uint64_t>();  // end time
  const auto size = content.Get<std::uint64_t>();
  const auto crc = content.Get<std::uint32_t>();
  const std::string compression = content.GetText();
  const auto packed = content.Take(content.Get<std::uint64_t>());
  if (!content.ok()) return Status(StatusCode::kParse, "its lengths lie");
  if (size > limits_.record_bytes)
    return Status(StatusCode::kLimit, "it would unpack to " + std::to_string(size) + " bytes");
  auto records = Decompress(compression, packed, size);
  if (!records.ok()) return records;
  if (crc != 0 && Crc32(*records) != crc)
    return Status(StatusCode::kParse, "its checksum is wrong");
  if (!AddDeclarations(*records)) return Status(StatusCode::kParse, "its records do not add up");
  return records;
}

bool Reader::AddDeclarations(std::span<const std::uint8_t> records) {
  return ForEachRecord(records, [this](Opcode opcode, const ByteReader& content) {
    if (opcode == Opcode::kSchema) return AddSchema(content);
    if (opcode == Opcode::kChannel) return AddChannel(content);
    return true;
  });
}

Status Reader::ForEach(const Range& range, const std::function<bool(const Message&)>& visit) {
  std::vector<ChunkInfo> chunks;
  for (const ChunkInfo& chunk : chunks_)
    if (chunk.end_time >= range.from && chunk.start_time <= range.to) chunks.push_back(chunk);
  std::stable_sort(chunks.begin(), chunks.end(), [](const ChunkInfo& a, const ChunkInfo& b) {
    return a.start_time < b.start_time;
  });

  std::priority_queue<Waiting, std::vector<Waiting>, Later> waiting;
  std::vector<std::weak_ptr<const Bytes>> loaded;
  std::size_t next = 0;
  std::uint64_t order = 0;
  while (next < chunks.size() || !waiting.empty()) {
    // A chunk must be there before a message that may come after one of its own is shown.
    while (next < chunks.size() &&
           (waiting.empty() || chunks[next].start_time <= waiting.top().message.log_time)) {
      std::uint64_t held = chunks[next].uncompressed_bytes;
      std::erase_if(loaded, [](const auto& bytes) { return bytes.expired(); });
      for (const auto& bytes : loaded) held += bytes.lock()->size();
      if (held > limits_.loaded_bytes)
        return {StatusCode::kLimit, "too many of its chunks overlap in time", path_.string()};
      auto records = LoadChunk(chunks[next]);
      if (!records.ok()) {
        Warn(chunks[next++].offset, "a chunk is left out: " + records.status().what());
        continue;
      }
      const auto bytes = std::make_shared<const Bytes>(std::move(*records));
      loaded.push_back(bytes);
      const bool whole = ForEachRecord(*bytes, [&](Opcode opcode, const ByteReader& content) {
        Message message;
        if (opcode != Opcode::kMessage) return true;
        if (!ParseMessage(content, &message)) return false;
        if (message.log_time >= range.from && message.log_time <= range.to)
          waiting.push({message, order++, bytes});
        return true;
      });
      if (!whole) Warn(chunks[next].offset, "messages of a chunk are left out: they do not add up");
      ++next;
    }
    if (waiting.empty()) continue;
    const Waiting first = waiting.top();
    waiting.pop();
    if (!visit(first.message)) return {};
  }
  return {};
}

Result<Bytes> Reader::ReadAttachment(const AttachmentInfo& info) const {
  auto record = ReadAt(info.offset, info.length);
  if (!record.ok()) return record;
  ByteReader content(*record);
  const bool right = content.Get<std::uint8_t>() == static_cast<std::uint8_t>(Opcode::kAttachment);
  (void)content.Get<std::uint64_t>();  // length
  (void)content.Get<std::uint64_t>();  // log and
  (void)content.Get<std::uint64_t>();  // create time
  (void)content.GetText();
  (void)content.GetText();
  const auto data = content.Take(content.Get<std::uint64_t>());
  const auto crc = content.Get<std::uint32_t>();
  const std::string where = path_.string() + ": attachment '" + info.name + "'";
  if (!right || !content.ok()) return Status(StatusCode::kParse, "its lengths lie", where);
  const auto covered =
      std::span(*record).subspan(kRecordHeaderBytes, record->size() - kRecordHeaderBytes - 4);
  if (crc != 0 && Crc32(covered) != crc)
    return Status(StatusCode::kParse, "its checksum is wrong", where);
  return Bytes(data.begin(), data.end());
}

}  // namespace furrow::motion::mcap
