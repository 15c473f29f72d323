// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/status.h"
#include "motion/mcap/compression.h"

namespace furrow::motion::mcap {
namespace {

constexpr std::uint64_t kFooterBytes = kRecordHeaderBytes + 20;
constexpr std::uint64_t kChunkHeadBytes =
    64;  // the fields before a chunk's data, without the name of its compression
constexpr std::uint64_t kAttachmentHeadBytes = 64u << 10;  // enough for the names of an attachment
constexpr std::uint64_t kEntryBytes = 128;  // estimated overhead of a record or of a map entry

using Bytes = std::vector<std::uint8_t>;

bool ParseMessage(ByteReader content, Message* message) {
  message->channel_id = content.Get<std::uint16_t>();
  message->sequence = content.Get<std::uint32_t>();
  message->log_time = content.Get<std::uint64_t>();
  message->publish_time = content.Get<std::uint64_t>();
  message->data = content.GetBytes(content.left());
  return content.ok();
}

// Calls `use(opcode, content)` for every record. False if the lengths of the records are wrong.
template <class Use>
bool ForEachRecord(std::span<const std::uint8_t> bytes, const Use& use) {
  ByteReader records(bytes);
  while (records.ok() && !records.at_end()) {
    // A record: u8 opcode, u64 length, then `length` bytes.
    const auto opcode = static_cast<Opcode>(records.Get<std::uint8_t>());
    ByteReader content(records.GetBytes(records.Get<std::uint64_t>()));
    if (!records.ok() || !use(opcode, content)) return false;
  }
  return records.ok();
}

}  // namespace

Result<std::unique_ptr<Reader>> Reader::Open(const std::filesystem::path& path,
                                             const ReaderLimits& limits) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    const int error = errno;
    return Status(error == ENOENT ? StatusCode::kNotFound : StatusCode::kIo,
                  error == ENOENT ? "no such file" : std::strerror(error), path.string());
  }
  std::unique_ptr<Reader> reader(new Reader(file, path, limits));
  struct stat about = {};
  if (::fstat(file, &about) != 0) return Status(StatusCode::kIo, std::strerror(errno), path);
  if (!S_ISREG(about.st_mode)) return Status(StatusCode::kIo, "not a regular file", path);
  reader->file_bytes_ = static_cast<std::uint64_t>(about.st_size);
  if (Status status = reader->Open(); !status.ok()) return status.At(path.string());
  return reader;
}

Result<std::unique_ptr<Reader>> Reader::OpenBytes(std::span<const std::uint8_t> bytes,
                                                  const std::string& name,
                                                  const ReaderLimits& limits) {
  std::unique_ptr<Reader> reader(new Reader(-1, name, limits));
  reader->memory_ = bytes;
  reader->file_bytes_ = bytes.size();
  if (Status status = reader->Open(); !status.ok()) return status.At(name);
  return reader;
}

Reader::Reader(int file, std::filesystem::path path, const ReaderLimits& limits)
    : file_(file), path_(std::move(path)), limits_(limits) {}

Reader::~Reader() {
  if (file_ >= 0) ::close(file_);
}

Status Reader::Open() {
  const auto magic = ReadAt(0, sizeof kMagic);
  if (!magic.ok() || !std::equal(magic->begin(), magic->end(), kMagic))
    return {StatusCode::kParse, "not an MCAP file: it does not begin with MCAP's magic bytes"};
  const auto header = RecordAt(sizeof kMagic);
  // MCAP requires the header as the first record.
  if (header && header->opcode == Opcode::kHeader && header->length <= limits_.record_bytes) {
    const auto bytes = ReadAt(header->offset + kRecordHeaderBytes, header->length);
    FURROW_RETURN_IF_ERROR(bytes);
    ByteReader content(*bytes);
    profile_ = content.GetText();
    library_ = content.GetText();
  } else {
    return {StatusCode::kParse, "no header after the magic bytes"};
  }
  const Summary summary = ReadSummary();
  complete_ = summary != Summary::kDamaged;
  if (summary == Summary::kRead) return {};
  // A half-read index may be wrong, so the scan starts without any.
  ForgetIndex();
  return Scan(complete_);
}

void Reader::ForgetIndex() {
  schemas_.clear();
  channels_.clear();
  chunks_.clear();
  attachments_.clear();
  metadata_.clear();
  extents_.clear();
  kept_bytes_ = 0;
}

bool Reader::Keep(std::uint64_t bytes) {
  // The subtraction cannot wrap, unlike a sum of two hostile numbers.
  if (bytes > limits_.kept_bytes - kept_bytes_) return false;
  kept_bytes_ += bytes;
  return true;
}

Result<std::vector<std::uint8_t>> Reader::ReadAt(std::uint64_t offset, std::uint64_t size) const {
  if (offset > file_bytes_ || size > file_bytes_ - offset)
    return Status(StatusCode::kParse, "the file ends too early", path_.string());
  if (size > limits_.record_bytes)
    return Status(StatusCode::kLimit,
                  "a record has " + std::to_string(size) + " bytes, the limit is " +
                      std::to_string(limits_.record_bytes),
                  path_.string());
  if (file_ < 0) {
    const auto part =
        memory_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
    return std::vector<std::uint8_t>(part.begin(), part.end());
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  std::size_t done = 0;
  // pread() may return fewer bytes. It needs no file position, so const functions can read.
  while (done < bytes.size()) {
    const ssize_t got =
        ::pread(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      return Status(StatusCode::kIo, got == 0 ? "the file became shorter" : std::strerror(errno),
                    path_.string());
    }
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::optional<Reader::Record> Reader::RecordAt(std::uint64_t offset) const {
  const auto head = ReadAt(offset, kRecordHeaderBytes);
  if (!head.ok()) return std::nullopt;
  ByteReader content(*head);
  Record record;
  record.opcode = static_cast<Opcode>(content.Get<std::uint8_t>());
  record.offset = offset;
  record.length = content.Get<std::uint64_t>();
  if (record.length > file_bytes_ - offset - kRecordHeaderBytes) return std::nullopt;
  return record;
}

void Reader::Warn(std::uint64_t offset, std::string_view what) {
  constexpr std::size_t kMost = 32;
  std::string text = path_.string() + ": byte " + std::to_string(offset) + ": " + std::string(what);
  // A second pass over a damaged file must not repeat its warnings.
  if (warnings_.size() < kMost && std::ranges::find(warnings_, text) == warnings_.end())
    warnings_.push_back(std::move(text));
}

Reader::Summary Reader::ReadSummary() {
  constexpr std::uint64_t kTail = kFooterBytes + sizeof kMagic;
  // The end of a complete file: a footer of fixed size, then the magic bytes again.
  if (file_bytes_ < sizeof kMagic + kTail) return Summary::kDamaged;
  const std::uint64_t footer_at = file_bytes_ - kTail;
  const auto tail = ReadAt(footer_at, kTail);
  if (!tail.ok() || !std::equal(tail->end() - sizeof kMagic, tail->end(), kMagic))
    return Summary::kDamaged;
  ByteReader footer(*tail);
  if (footer.Get<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kFooter) ||
      footer.Get<std::uint64_t>() != kFooterBytes - kRecordHeaderBytes) {
    return Summary::kDamaged;
  }
  const auto start = footer.Get<std::uint64_t>();
  (void)footer.Get<std::uint64_t>();  // start of the summary offsets, which are not needed
  const auto crc = footer.Get<std::uint32_t>();
  if (start == 0) return Summary::kNone;  // as the format defines it
  if (start < sizeof kMagic || start > footer_at) return Summary::kDamaged;
  const auto summary = ReadAt(start, footer_at - start);
  if (!summary.ok()) return Summary::kDamaged;
  const std::span<const std::uint8_t> covered(tail->data(), kFooterBytes - sizeof crc);
  // 0 means that the writer stated no checksum.
  if (crc != 0 && Crc32(covered, Crc32(*summary)) != crc) {
    Warn(start, "the summary is damaged; the whole file was scanned instead");
    return Summary::kDamaged;
  }
  return ReadSummaryRecords(*summary);
}

Reader::Summary Reader::ReadSummaryRecords(std::span<const std::uint8_t> summary) {
  ByteReader records(summary);
  bool has_statistics = false;
  std::uint64_t num_messages = 0;
  while (records.ok() && !records.at_end()) {
    const auto opcode = static_cast<Opcode>(records.Get<std::uint8_t>());
    ByteReader content(records.GetBytes(records.Get<std::uint64_t>()));
    if (!records.ok()) return Summary::kDamaged;
    if (opcode == Opcode::kStatistics) {
      has_statistics = true;
      num_messages = content.Get<std::uint64_t>();
    } else if (!AddSummaryRecord(opcode, content)) {
      return Summary::kDamaged;
    }
  }
  // Every byte of the file may be listed once only.
  if (!records.ok() || !ExtentsAreApart()) return Summary::kDamaged;
  // No index lists messages outside chunks. Only the statistics reveal that there are none.
  const bool lists_messages = has_statistics && (num_messages == 0 || !chunks_.empty());
  return lists_messages ? Summary::kRead : Summary::kNone;
}

bool Reader::AddSummaryRecord(Opcode opcode, ByteReader content) {
  switch (opcode) {
    case Opcode::kSchema: return AddSchema(content);
    case Opcode::kChannel: return AddChannel(content);
    case Opcode::kChunkIndex: return AddChunkIndex(content);
    case Opcode::kAttachmentIndex: return AddAttachmentIndex(content);
    case Opcode::kMetadataIndex: return AddMetadataIndex(content);
    default: return true;
  }
}

bool Reader::AddExtent(std::uint64_t offset, std::uint64_t length) {
  if (offset > file_bytes_ || length > file_bytes_ - offset || length <= kRecordHeaderBytes)
    return false;
  extents_.push_back({offset, length});
  return true;
}

// Otherwise a small file could make the reader read one record millions of times.
bool Reader::ExtentsAreApart() {
  std::vector<Extent> extents = std::exchange(extents_, {});
  std::ranges::sort(extents, {}, &Extent::offset);
  const auto overlap = [](const Extent& a, const Extent& b) {
    return a.offset + a.length > b.offset;
  };
  return std::ranges::adjacent_find(extents, overlap) == extents.end();
}

bool Reader::AddSchema(ByteReader content) {
  const std::uint64_t size = kEntryBytes + content.left();
  Schema schema;
  schema.id = content.Get<std::uint16_t>();
  schema.name = content.GetText();
  schema.encoding = content.GetText();
  const auto data = content.GetBytes(content.Get<std::uint32_t>());
  schema.data.assign(data.begin(), data.end());
  if (!content.ok() || schema.id == 0) return false;
  // Chunks and summary repeat declarations; the first one counts and repetitions cost nothing.
  if (schemas_.contains(schema.id)) return true;
  if (!Keep(size)) return false;
  schemas_.emplace(schema.id, std::move(schema));
  return true;
}

bool Reader::AddChannel(ByteReader content) {
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

bool Reader::AddMetadata(ByteReader content) {
  if (!Keep(kEntryBytes + content.left())) return false;
  Metadata metadata;
  metadata.name = content.GetText();
  metadata.values = content.GetMap();
  if (!content.ok() || !Keep(kEntryBytes * metadata.values.size())) return false;
  metadata_.push_back(std::move(metadata));
  return true;
}

// Positions and sizes are claims; LoadChunk() compares them with the chunk itself.
bool Reader::AddChunkIndex(ByteReader content) {
  ChunkInfo info;
  info.start_time = content.Get<std::uint64_t>();
  info.end_time = content.Get<std::uint64_t>();
  info.offset = content.Get<std::uint64_t>();
  info.length = content.Get<std::uint64_t>();
  (void)content.GetBytes(content.Get<std::uint32_t>());  // offsets of the message indexes
  (void)content.Get<std::uint64_t>();                    // their length
  info.compression = content.GetText();
  info.compressed_bytes = content.Get<std::uint64_t>();
  info.uncompressed_bytes = content.Get<std::uint64_t>();
  if (!content.ok() || info.start_time > info.end_time || chunks_.size() >= limits_.records ||
      !AddExtent(info.offset, info.length)) {
    return false;
  }
  chunks_.push_back(std::move(info));
  return true;
}

bool Reader::AddAttachmentIndex(ByteReader content) {
  AttachmentInfo info;
  info.offset = content.Get<std::uint64_t>();
  info.length = content.Get<std::uint64_t>();
  info.log_time = content.Get<std::uint64_t>();
  info.create_time = content.Get<std::uint64_t>();
  info.size = content.Get<std::uint64_t>();
  info.name = content.GetText();
  info.media_type = content.GetText();
  if (!content.ok() || attachments_.size() >= limits_.records ||
      !AddExtent(info.offset, info.length)) {
    return false;
  }
  attachments_.push_back(std::move(info));
  return true;
}

bool Reader::AddMetadataIndex(ByteReader content) {
  const auto record = RecordAt(content.Get<std::uint64_t>());
  if (!content.ok() || !record || record->opcode != Opcode::kMetadata ||
      record->length > limits_.kept_bytes - kept_bytes_ ||
      !AddExtent(record->offset, record->length + kRecordHeaderBytes)) {
    return false;
  }
  const auto bytes = ReadAt(record->offset + kRecordHeaderBytes, record->length);
  return bytes.ok() && AddMetadata(ByteReader(*bytes));
}

Status Reader::Scan(bool is_whole) {
  std::uint64_t offset = sizeof kMagic;
  bool ended = false;
  while (!ended && offset < file_bytes_) {
    const auto record = RecordAt(offset);
    if (!record) {
      Warn(offset, "the file ends within a record; its writer died or its disk was full");
      return {};
    }
    ended = record->opcode == Opcode::kDataEnd || record->opcode == Opcode::kFooter;
    if (!ended) {
      FURROW_RETURN_IF_ERROR(ScanRecord(*record));
    }
    offset += kRecordHeaderBytes + record->length;
  }
  if (ended && is_whole) return {};
  Warn(offset, ended ? "the index after the data is cut off or damaged; all data was read"
                     : "the file has no index; its writer died");
  return {};
}

Status Reader::ScanRecord(const Record& record) {
  const bool loose = record.opcode == Opcode::kMessage;
  if (record.opcode == Opcode::kChunk || record.opcode == Opcode::kAttachment) {
    const std::uint64_t head =
        record.opcode == Opcode::kChunk ? kChunkHeadBytes : kAttachmentHeadBytes;
    const auto bytes = ReadAt(record.offset + kRecordHeaderBytes, std::min(record.length, head));
    FURROW_RETURN_IF_ERROR(bytes);
    if (record.opcode == Opcode::kAttachment) {
      if (!AddAttachment(*bytes, record)) Warn(record.offset, "a damaged attachment is skipped");
      return {};
    }
    return AddScannedChunk(ByteReader(*bytes), record);
  }
  if (!loose && record.opcode != Opcode::kSchema && record.opcode != Opcode::kChannel &&
      record.opcode != Opcode::kMetadata) {
    return {};
  }
  const auto bytes = ReadAt(record.offset + kRecordHeaderBytes, record.length);
  FURROW_RETURN_IF_ERROR(bytes);
  bool good = true;
  if (record.opcode == Opcode::kSchema) good = AddSchema(ByteReader(*bytes));
  if (record.opcode == Opcode::kChannel) good = AddChannel(ByteReader(*bytes));
  if (record.opcode == Opcode::kMetadata) good = AddMetadata(ByteReader(*bytes));
  if (loose) good = AddLooseMessage(ByteReader(*bytes), record);
  if (!good) Warn(record.offset, "a record is skipped: it is damaged or exceeds a limit");
  return {};
}

// A scanned chunk counts if it can be decompressed, which also adds its channels.
Status Reader::AddScannedChunk(ByteReader head, const Record& record) {
  ChunkInfo info;
  info.start_time = head.Get<std::uint64_t>();
  info.end_time = head.Get<std::uint64_t>();
  info.uncompressed_bytes = head.Get<std::uint64_t>();
  (void)head.Get<std::uint32_t>();  // the checksum, which LoadChunk() verifies
  info.compression = head.GetText();
  info.offset = record.offset;
  info.length = record.length + kRecordHeaderBytes;
  const auto records = LoadChunk(info);
  if (records.status().code() == StatusCode::kIo) return records.status();
  if (!records.ok()) {
    Warn(record.offset, "a chunk is skipped: " + records.status().what());
  } else if (chunks_.size() >= limits_.records || info.start_time > info.end_time) {
    Warn(record.offset, "a chunk is skipped: its times are wrong or there are too many chunks");
  } else {
    chunks_.push_back(std::move(info));
  }
  return {};
}

bool Reader::AddLooseMessage(ByteReader content, const Record& record) {
  (void)content.Get<std::uint16_t>();
  (void)content.Get<std::uint32_t>();
  const auto time = content.Get<std::uint64_t>();
  if (!content.ok()) return false;
  const std::uint64_t length = record.length + kRecordHeaderBytes;
  ChunkInfo* last = chunks_.empty() ? nullptr : &chunks_.back();
  // Messages outside chunks are grouped into runs of up to 1 MiB, which ForEach() then treats as
  // uncompressed chunks.
  constexpr std::uint64_t kRunBytes = 1u << 20;
  if (last != nullptr && last->compression == kLooseMessages &&
      last->offset + last->length == record.offset && last->length < kRunBytes) {
    last->start_time = std::min(last->start_time, time);
    last->end_time = std::max(last->end_time, time);
    last->length += length;
    last->uncompressed_bytes = last->length;
    return true;
  }
  if (chunks_.size() >= limits_.records) return false;
  chunks_.push_back({time, time, record.offset, length, length, length, kLooseMessages});
  return true;
}

bool Reader::AddAttachment(std::span<const std::uint8_t> head, const Record& record) {
  ByteReader content(head);
  AttachmentInfo info;
  info.log_time = content.Get<std::uint64_t>();
  info.create_time = content.Get<std::uint64_t>();
  info.name = content.GetText();
  info.media_type = content.GetText();
  info.size = content.Get<std::uint64_t>();
  info.offset = record.offset;
  info.length = record.length + kRecordHeaderBytes;
  if (!content.ok() || info.size > record.length || attachments_.size() >= limits_.records)
    return false;
  attachments_.push_back(std::move(info));
  return true;
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

Result<Bytes> Reader::LoadChunk(const ChunkInfo& info) {
  if (info.compression == kLooseMessages) return ReadAt(info.offset, info.length);
  const auto record = ReadAt(info.offset, info.length);
  FURROW_RETURN_IF_ERROR(record);
  ByteReader content(*record);
  if (content.Get<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kChunk))
    return Status(StatusCode::kParse, "the index does not refer to a chunk");
  (void)content.Get<std::uint64_t>();  // length
  (void)content.Get<std::uint64_t>();  // start and
  (void)content.Get<std::uint64_t>();  // end time
  const auto size = content.Get<std::uint64_t>();
  if (size != info.uncompressed_bytes)
    return Status(StatusCode::kParse, "the index states a different size");
  const auto crc = content.Get<std::uint32_t>();
  const std::string compression = content.GetText();
  const auto packed = content.GetBytes(content.Get<std::uint64_t>());
  if (!content.ok()) return Status(StatusCode::kParse, "its length fields are wrong");
  if (size > limits_.record_bytes)
    return Status(StatusCode::kLimit, "its decompressed size of " + std::to_string(size) +
                                          " bytes exceeds the limit of " +
                                          std::to_string(limits_.record_bytes));
  // `size` agrees with the index and is within the limit, so the output is bounded.
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
    return {StatusCode::kParse, "one of its schemas or channels is damaged or exceeds a limit"};
  if (!whole) return {StatusCode::kParse, "the lengths of its records are wrong"};
  return {};
}

Result<std::unique_ptr<Reader::Run>> Reader::LoadRun(const ChunkInfo& info, const Range& range,
                                                     std::uint64_t held) {
  const Status too_much(StatusCode::kLimit, "too many chunks overlap in time", path_.string());
  if (held > limits_.loaded_bytes || info.uncompressed_bytes > limits_.loaded_bytes - held)
    return too_much;
  auto records = LoadChunk(info);
  if (records.status().code() == StatusCode::kIo) return records.status();
  if (!records.ok()) {
    Warn(info.offset, "a chunk is skipped: " + records.status().what());
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
    fits = run->held_bytes() <= limits_.loaded_bytes - held;
    return fits;
  });
  if (!fits) return too_much;
  if (!whole)
    Warn(info.offset, "messages of a chunk are skipped: the lengths of its records are wrong");
  run->Sort();
  return run;
}

Status Reader::ForEach(const Range& range, const std::function<bool(const Message&)>& visit) {
  std::vector<const ChunkInfo*> chunks;
  for (const ChunkInfo& chunk : chunks_)
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
  auto record = ReadAt(info.offset, info.length);
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
  const std::string where = path_.string() + ": attachment '" + info.name + "'";
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
