// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/reader.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "motion/mcap/byte_io.h"
#include "motion/mcap/chunk.h"
#include "motion/mcap/compression.h"
#include "motion/mcap/scan.h"
#include "motion/mcap/summary.h"

namespace furrow::motion::mcap {
namespace {

using Bytes = std::vector<std::uint8_t>;

bool ParseMessage(ByteReader content, Message* message) {
  message->channel_id = content.Get<std::uint16_t>();
  message->sequence = content.Get<std::uint32_t>();
  message->log_time = content.Get<std::uint64_t>();
  message->publish_time = content.Get<std::uint64_t>();
  message->data = content.GetBytes(content.left());
  return content.ok();
}

}  // namespace

Result<std::unique_ptr<Reader>> Reader::Open(const std::filesystem::path& path,
                                             const ReaderLimits& limits) {
  Result<RecordFile> file = RecordFile::Open(path, limits.record_bytes);
  FURROW_RETURN_IF_ERROR(file);
  return Open(*std::move(file), limits);
}

Result<std::unique_ptr<Reader>> Reader::OpenBytes(std::span<const std::uint8_t> bytes,
                                                  const std::string& name,
                                                  const ReaderLimits& limits) {
  return Open(RecordFile(bytes, name, limits.record_bytes), limits);
}

Result<std::unique_ptr<Reader>> Reader::Open(RecordFile file, const ReaderLimits& limits) {
  std::unique_ptr<Reader> reader(new Reader(std::move(file), limits));
  Status status = reader->ReadHeader();
  if (status.ok()) status = reader->ReadIndex();
  if (!status.ok()) return status.At(reader->file_.name());
  return reader;
}

Reader::Reader(RecordFile file, const ReaderLimits& limits)
    : file_(std::move(file)), index_(limits), warnings_(file_.name()) {}

Status Reader::ReadHeader() {
  const auto magic = file_.ReadAt(0, sizeof kMagic);
  if (!magic.ok() || !std::equal(magic->begin(), magic->end(), kMagic))
    return {StatusCode::kParse, "not an MCAP file: it does not begin with MCAP's magic bytes"};
  // MCAP requires the header as the first record.
  const auto header = file_.RecordAt(sizeof kMagic);
  if (!header || header->opcode != Opcode::kHeader)
    return {StatusCode::kParse, "no header after the magic bytes"};
  const auto bytes = file_.ReadContent(*header);
  FURROW_RETURN_IF_ERROR(bytes);
  ByteReader content(*bytes);
  profile_ = content.GetText();
  library_ = content.GetText();
  return {};
}

Status Reader::ReadIndex() {
  const Summary summary = ReadSummary(file_, &index_, &warnings_);
  complete_ = summary != Summary::kDamaged;
  if (summary == Summary::kRead) return {};
  // A half-read index may be wrong, so the scan starts without any.
  index_ = Index(index_.limits());
  return Scan(file_, complete_, &index_, &warnings_);
}

// The messages of a loaded chunk that ForEach() has not passed on yet, in order of time.
class Reader::Run {
 public:
  Run(std::uint64_t offset, Bytes records) : offset_(offset), records_(std::move(records)) {}

  [[nodiscard]] const Bytes& records() const { return records_; }
  [[nodiscard]] std::uint64_t held_bytes() const {
    return records_.capacity() + messages_.capacity() * sizeof(Message);
  }
  // `message` must refer to records().
  void Add(const Message& message) { messages_.push_back(message); }
  void Sort() { std::ranges::stable_sort(messages_, {}, &Message::log_time); }

  [[nodiscard]] bool at_end() const { return next_ == messages_.size(); }
  [[nodiscard]] const Message& front() const { return messages_[next_]; }
  void Pop() { ++next_; }
  // Orders by the time of the next message, then by the position in the file.
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

Result<std::unique_ptr<Reader::Run>> Reader::LoadRun(const ChunkInfo& info, const Range& range,
                                                     std::uint64_t held) {
  const std::uint64_t most = index_.limits().loaded_bytes;
  const Status too_much(StatusCode::kLimit, "too many chunks overlap in time", file_.name());
  if (held > most || info.uncompressed_bytes > most - held) return too_much;
  auto records = LoadChunk(file_, info, &index_);
  if (records.status().code() == StatusCode::kIo) return records.status();
  if (!records.ok()) {
    warnings_.Add(info.offset, "a chunk is skipped: " + records.status().what());
    return std::unique_ptr<Run>();
  }
  auto run = std::make_unique<Run>(info.offset, std::move(*records));
  bool fits = true;
  const bool whole = ForEachRecord(run->records(), [&](Opcode opcode, const ByteReader& content) {
    // Messages point into the run's records, which do not move while the run lives.
    Message message;
    if (opcode != Opcode::kMessage) return true;
    if (!ParseMessage(content, &message)) return false;
    if (message.log_time < range.from || message.log_time > range.to) return true;
    run->Add(message);
    fits = run->held_bytes() <= most - held;
    return fits;
  });
  if (!fits) return too_much;
  if (!whole)
    warnings_.Add(info.offset,
                  "messages of a chunk are skipped: the lengths of its records are wrong");
  run->Sort();
  return run;
}

Status Reader::ForEach(const Range& range, const std::function<bool(const Message&)>& visit) {
  std::vector<const ChunkInfo*> chunks;
  for (const ChunkInfo& chunk : index_.chunks())
    if (chunk.end_time >= range.from && chunk.start_time <= range.to) chunks.push_back(&chunk);
  // A merge over chunks that may overlap in time. Only chunks with a message that may be next are
  // in memory.
  std::ranges::stable_sort(chunks, {}, &ChunkInfo::start_time);

  const auto later = [](const std::unique_ptr<Run>& a, const std::unique_ptr<Run>& b) {
    return a->IsLaterThan(*b);
  };
  std::vector<std::unique_ptr<Run>> runs;  // a heap with the earliest next message at the front
  std::uint64_t held = 0;
  std::size_t next = 0;
  while (next < chunks.size() || !runs.empty()) {
    // Load a chunk before passing on a message that may be later than one of the chunk's.
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
    // The earliest run leaves the heap while its next message changes.
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
  auto record = file_.ReadAt(info.offset, info.length);
  if (!record.ok()) return record;
  ByteReader content(*record);
  const bool right = content.Get<std::uint8_t>() == static_cast<std::uint8_t>(Opcode::kAttachment);
  (void)content.Get<std::uint64_t>();  // length
  (void)content.Get<std::uint64_t>();  // log and
  (void)content.Get<std::uint64_t>();  // create time
  (void)content.GetText();
  (void)content.GetText();
  const auto data = content.GetBytes(content.Get<std::uint64_t>());
  const auto crc = content.Get<std::uint32_t>();
  const std::string where = file_.name() + ": attachment '" + info.name + "'";
  if (!right || !content.ok())
    return Status(StatusCode::kParse, "its length fields are wrong", where);
  // The checksum covers the record's content except for itself (4 bytes).
  const auto covered =
      std::span(*record).subspan(kRecordHeaderBytes, record->size() - kRecordHeaderBytes - 4);
  if (crc != 0 && Crc32(covered) != crc)
    return Status(StatusCode::kParse, "its checksum is wrong", where);
  return Bytes(data.begin(), data.end());
}

}  // namespace furrow::motion::mcap
