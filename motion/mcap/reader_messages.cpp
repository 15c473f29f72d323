// SPDX-License-Identifier: Apache-2.0
// What a reader does with the messages of chunks: unpacks, checks and puts them in order.
#include <algorithm>
#include <memory>
#include <utility>

#include "base/status.h"
#include "motion/mcap/compression.h"
#include "motion/mcap/reader.h"

namespace furrow::motion::mcap {
namespace {

using Bytes = std::vector<std::uint8_t>;

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

// The messages of a loaded chunk that are still to be shown, in the order of their times.
class Reader::Run {
 public:
  Run(std::uint64_t offset, Bytes records) : offset_(offset), records_(std::move(records)) {}

  [[nodiscard]] const Bytes& records() const { return records_; }
  [[nodiscard]] std::uint64_t held_bytes() const {
    return records_.capacity() + messages_.capacity() * sizeof(Message);
  }
  // Of messages that point into records().
  void Add(const Message& message) { messages_.push_back(message); }
  void Sort() { std::ranges::stable_sort(messages_, {}, &Message::log_time); }

  [[nodiscard]] bool at_end() const { return next_ == messages_.size(); }
  [[nodiscard]] const Message& front() const { return messages_[next_]; }
  void Pop() { ++next_; }
  // Whose next message comes later, then who lies further back in the file.
  [[nodiscard]] bool IsLaterThan(const Run& other) const {
    if (front().log_time != other.front().log_time)
      return front().log_time > other.front().log_time;
    return offset_ > other.offset_;
  }

 private:
  std::uint64_t offset_;
  Bytes records_;
  std::vector<Message> messages_;
  std::size_t next_ = 0;
};

Result<Bytes> Reader::LoadChunk(const ChunkInfo& info) {
  if (info.compression == kLooseMessages) return ReadAt(info.offset, info.length);
  const auto record = ReadAt(info.offset, info.length);
  FURROW_RETURN_IF_ERROR(record);
  ByteReader content(*record);
  if (content.Get<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kChunk))
    return Status(StatusCode::kParse, "the index points at something else");
  (void)content.Get<std::uint64_t>();  // length
  (void)content.Get<std::uint64_t>();  // start and
  (void)content.Get<std::uint64_t>();  // end time
  const auto size = content.Get<std::uint64_t>();
  if (size != info.uncompressed_bytes)
    return Status(StatusCode::kParse, "the index states another size");
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
  FURROW_RETURN_IF_ERROR(AddDeclarations(*records));
  return records;
}

Status Reader::AddDeclarations(std::span<const std::uint8_t> records) {
  bool declared = true;
  const bool whole = ForEachRecord(records, [&](Opcode opcode, const ByteReader& content) {
    if (opcode == Opcode::kSchema) declared = AddSchema(content);
    if (opcode == Opcode::kChannel) declared = AddChannel(content);
    return declared;
  });
  if (!declared)
    return {StatusCode::kParse, "a schema or a channel in it is damaged, or one too many"};
  if (!whole) return {StatusCode::kParse, "its records do not add up"};
  return {};
}

Result<std::unique_ptr<Reader::Run>> Reader::LoadRun(const ChunkInfo& info, const Range& range,
                                                     std::uint64_t held) {
  const Status too_much(StatusCode::kLimit, "too many of its chunks overlap in time",
                        path_.string());
  if (held > limits_.loaded_bytes || info.uncompressed_bytes > limits_.loaded_bytes - held)
    return too_much;
  auto records = LoadChunk(info);
  if (records.status().code() == StatusCode::kIo) return records.status();
  if (!records.ok()) {
    Warn(info.offset, "a chunk is left out: " + records.status().what());
    return std::unique_ptr<Run>();
  }
  auto run = std::make_unique<Run>(info.offset, std::move(*records));
  bool fits = true;
  const bool whole = ForEachRecord(run->records(), [&](Opcode opcode, const ByteReader& content) {
    Message message;
    if (opcode != Opcode::kMessage) return true;
    if (!ParseMessage(content, &message)) return false;
    if (message.log_time < range.from || message.log_time > range.to) return true;
    run->Add(message);
    fits = run->held_bytes() <= limits_.loaded_bytes - held;
    return fits;
  });
  if (!fits) return too_much;
  if (!whole) Warn(info.offset, "messages of a chunk are left out: they do not add up");
  run->Sort();
  return run;
}

Status Reader::ForEach(const Range& range, const std::function<bool(const Message&)>& visit) {
  std::vector<const ChunkInfo*> chunks;
  for (const ChunkInfo& chunk : chunks_)
    if (chunk.end_time >= range.from && chunk.start_time <= range.to) chunks.push_back(&chunk);
  std::ranges::stable_sort(chunks, {}, &ChunkInfo::start_time);

  const auto later = [](const std::unique_ptr<Run>& a, const std::unique_ptr<Run>& b) {
    return a->IsLaterThan(*b);
  };
  std::vector<std::unique_ptr<Run>> runs;  // a heap: the one with the first message at the front
  std::uint64_t held = 0;
  std::size_t next = 0;
  while (next < chunks.size() || !runs.empty()) {
    // A chunk must be there before a message that may come after one of its own is shown.
    if (next < chunks.size() &&
        (runs.empty() || chunks[next]->start_time <= runs.front()->front().log_time)) {
      auto run = LoadRun(*chunks[next++], range, held);
      FURROW_RETURN_IF_ERROR(run);
      if (*run == nullptr || (*run)->at_end()) continue;
      held += (*run)->held_bytes();
      runs.push_back(*std::move(run));
      std::ranges::push_heap(runs, later);
      continue;
    }
    std::ranges::pop_heap(runs, later);
    Run& first = *runs.back();
    if (!visit(first.front())) return {};
    first.Pop();
    if (first.at_end()) {
      held -= first.held_bytes();
      runs.pop_back();
    } else {
      std::ranges::push_heap(runs, later);
    }
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
