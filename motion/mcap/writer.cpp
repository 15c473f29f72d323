// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/writer.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/status.h"
#include "motion/mcap/compression.h"

namespace furrow::motion::mcap {
namespace {

ByteWriter ToRecord(const Schema& schema) {
  ByteWriter out;
  out.Put(schema.id).PutText(schema.name).PutText(schema.encoding);
  out.Put(static_cast<std::uint32_t>(schema.data.size())).PutBytes(schema.data);
  return out;
}

ByteWriter ToRecord(const Channel& channel) {
  ByteWriter out;
  out.Put(channel.id).Put(channel.schema_id).PutText(channel.topic);
  out.PutText(channel.message_encoding).PutMap(channel.metadata);
  return out;
}

ByteWriter ToIndexRecord(const AttachmentInfo& info) {
  ByteWriter record;
  record.Put(info.offset).Put(info.length).Put(info.log_time).Put(info.create_time);
  record.Put(info.size).PutText(info.name).PutText(info.media_type);
  return record;
}

// Builds the summary section: records grouped by kind, the offset of each group, the footer and the
// magic bytes.
class SummaryBuilder {
 public:
  // `start` is the section's offset in the file.
  explicit SummaryBuilder(std::uint64_t start) : start_(start) {}

  // Add all records of one kind before those of the next.
  void Add(Opcode opcode, const ByteWriter& content) {
    if (groups_.empty() || groups_.back().opcode != opcode)
      groups_.push_back({opcode, out_.size(), 0});
    out_.PutRecord(opcode, content);
    groups_.back().length = out_.size() - groups_.back().start;
  }

  [[nodiscard]] const ByteWriter& Finish() {
    const std::uint64_t offsets_start = start_ + out_.size();
    for (const Group& group : groups_) {
      ByteWriter record;
      record.Put(static_cast<std::uint8_t>(group.opcode));
      record.Put(start_ + group.start).Put(group.length);
      out_.PutRecord(Opcode::kSummaryOffset, record);
    }
    // The footer's checksum covers the summary and the footer up to itself.
    out_.Put(static_cast<std::uint8_t>(Opcode::kFooter)).Put(std::uint64_t{20});
    out_.Put(start_).Put(offsets_start);
    return out_.Put(Crc32(out_.bytes())).PutBytes(kMagic);
  }

 private:
  struct Group {
    Opcode opcode;
    std::uint64_t start;  // in the section
    std::uint64_t length;
  };
  std::uint64_t start_;
  ByteWriter out_;
  std::vector<Group> groups_;
};

}  // namespace

Result<std::unique_ptr<Writer>> Writer::Create(const std::filesystem::path& path,
                                               const WriterOptions& options) {
  // O_EXCL makes "never overwrites" hold even between two processes.
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) {
    const int error = errno;
    return Status(StatusCode::kIo, std::strerror(error), path.string(),
                  error == EEXIST ? "a recording never overwrites a file; move the file away" : "");
  }
  std::unique_ptr<Writer> writer(new Writer(file, path, options));
  Status status = writer->Append(kMagic);
  if (status.ok()) {
    ByteWriter header;
    header.PutText(options.profile).PutText("furrow");
    status = writer->AppendRecord(Opcode::kHeader, header);
  }
  if (!status.ok()) {
    ::unlink(path.c_str());  // it is this call's own, and no MCAP file
    return status;
  }
  return writer;
}

Writer::Writer(int file, std::filesystem::path path, const WriterOptions& options)
    : file_(file), path_(std::move(path)), options_(options) {}

Writer::~Writer() { ::close(file_); }

bool Writer::is_at_its_path() const {
  struct stat opened = {};
  struct stat there = {};
  return ::fstat(file_, &opened) == 0 && ::stat(path_.c_str(), &there) == 0 &&
         opened.st_dev == there.st_dev && opened.st_ino == there.st_ino;
}

std::uint16_t Writer::AddSchema(std::string_view name, std::string_view encoding,
                                std::span<const std::uint8_t> data) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({id, std::string(name), std::string(encoding), {data.begin(), data.end()}});
  return id;
}

std::uint16_t Writer::AddChannel(std::string_view topic, std::string_view message_encoding,
                                 std::uint16_t schema_id,
                                 const std::map<std::string, std::string>& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  ByteWriter record =
      ToRecord(Channel{id, schema_id, std::string(topic), std::string(message_encoding), metadata});
  record.ShrinkToFit();
  channels_.push_back({std::move(record), schema_id});
  return id;
}

Status Writer::Append(std::span<const std::uint8_t> bytes) {
  if (!failure_.ok()) return failure_;
  std::span<const std::uint8_t> left = bytes;
  while (!left.empty()) {
    const ssize_t written = ::write(file_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written == 0 ? ENOSPC : errno;
      failure_ = {StatusCode::kIo, std::strerror(error), path_.string(),
                  "what was written before stays readable"};
      // A torn record would hide all records after it, so it is cut off. If that fails, too,
      // readers stop there.
      if (::ftruncate(file_, static_cast<off_t>(offset_)) == 0)
        ::lseek(file_, static_cast<off_t>(offset_), SEEK_SET);
      return failure_;
    }
    left = left.subspan(static_cast<std::size_t>(written));
  }
  offset_ += bytes.size();
  crc_ = Crc32(bytes, crc_);
  return {};
}

Status Writer::AppendRecord(Opcode opcode, const ByteWriter& content) {
  ByteWriter record;
  record.PutRecord(opcode, content);
  return Append(record.bytes());
}

// Every chunk declares what it uses, so that it is readable without the rest of the file.
void Writer::DeclareInChunk(std::uint16_t channel_id) {
  if (!declared_.insert(channel_id).second) return;
  const ChannelInfo& channel = channels_[channel_id - 1u];
  if (channel.schema_id != 0 && declared_schemas_.insert(channel.schema_id).second)
    chunk_.PutRecord(Opcode::kSchema, ToRecord(schemas_[channel.schema_id - 1u]));
  chunk_.PutRecord(Opcode::kChannel, channel.record);
}

Status Writer::Write(const Message& message) {
  if (!failure_.ok()) return failure_;
  if (message.channel_id == 0 || message.channel_id > channels_.size())
    return {StatusCode::kInvalidArgument,
            "channel " + std::to_string(message.channel_id) + " does not exist"};
  const std::size_t begin = chunk_.size();
  try {
    AppendToChunk(message);
  } catch (const std::bad_alloc&) {
    // A torn record would hide all messages of the chunk. What it declares may be declared twice.
    chunk_.Truncate(begin);
    declared_.clear();
    declared_schemas_.clear();
    throw;
  }
  if (chunk_.size() >= options_.chunk_bytes) return FlushChunk();
  return {};
}

void Writer::AppendToChunk(const Message& message) {
  DeclareInChunk(message.channel_id);
  const std::uint64_t place = chunk_.size();
  chunk_.Put(static_cast<std::uint8_t>(Opcode::kMessage));
  // 22 bytes: u16 channel, u32 sequence, two u64 times.
  chunk_.Put(static_cast<std::uint64_t>(22 + message.data.size()));
  chunk_.Put(message.channel_id).Put(message.sequence);
  chunk_.Put(message.log_time).Put(message.publish_time).PutBytes(message.data);
  places_.push_back({message.channel_id, message.log_time, place});
  const bool first = places_.size() == 1;
  chunk_info_.start_time =
      first ? message.log_time : std::min(chunk_info_.start_time, message.log_time);
  chunk_info_.end_time = std::max(chunk_info_.end_time, message.log_time);
  ++num_messages_;
}

Status Writer::FlushChunk() {
  if (!failure_.ok()) return failure_;
  if (places_.empty()) return {};
  const auto compressed = CompressZstd(chunk_.bytes(), options_.zstd_level);
  // What cannot be compressed is kept as it is.
  const std::span<const std::uint8_t> packed = compressed ? *compressed : chunk_.bytes();
  ChunkInfo info = chunk_info_;
  info.compression = compressed ? "zstd" : "";
  ByteWriter record;
  record.Put(chunk_info_.start_time).Put(chunk_info_.end_time);
  record.Put(static_cast<std::uint64_t>(chunk_.size())).Put(Crc32(chunk_.bytes()));
  record.PutText(info.compression).Put(static_cast<std::uint64_t>(packed.size())).PutBytes(packed);

  info.offset = offset_;
  info.length = record.size() + kRecordHeaderBytes;
  info.compressed_bytes = packed.size();
  info.uncompressed_bytes = chunk_.size();
  Status status = AppendRecord(Opcode::kChunk, record);
  if (status.ok()) {
    // Statistics and index only list chunks that are in the file.
    CountChunk();
    chunk_index_.push_back(IndexChunk(info));
    status = failure_;
  }
  BeginChunk();
  return status;
}

// Adds the current chunk to the statistics, after it was written to the file.
void Writer::CountChunk() {
  for (const MessagePlace& place : places_) ++channels_[place.channel_id - 1u].num_messages;
  const bool first = written_messages_ == 0;
  start_time_ = first ? chunk_info_.start_time : std::min(start_time_, chunk_info_.start_time);
  end_time_ = std::max(end_time_, chunk_info_.end_time);
  written_messages_ += places_.size();
}

void Writer::BeginChunk() {
  places_.clear();
  chunk_.Clear();
  chunk_info_ = {};
  declared_.clear();
  declared_schemas_.clear();
}

// Writes the message indexes of the chunk that was just written. Returns the chunk index record,
// which lists those that reached the file.
ByteWriter Writer::IndexChunk(const ChunkInfo& chunk) {
  const std::uint64_t begin = offset_;
  std::ranges::stable_sort(places_, {}, &MessagePlace::channel_id);
  ByteWriter offsets;
  for (auto place = places_.begin(); place != places_.end();) {
    const std::uint16_t id = place->channel_id;
    ByteWriter entries;
    for (; place != places_.end() && place->channel_id == id; ++place)
      entries.Put(place->log_time).Put(place->offset);
    ByteWriter record;
    record.Put(id).Put(static_cast<std::uint32_t>(entries.size())).PutBytes(entries.bytes());
    const std::uint64_t offset = offset_;
    if (!AppendRecord(Opcode::kMessageIndex, record).ok()) break;  // failure_ has the reason
    offsets.Put(id).Put(offset);
  }
  ByteWriter out;  // kept until the file ends
  out.Put(chunk.start_time).Put(chunk.end_time).Put(chunk.offset).Put(chunk.length);
  out.Put(static_cast<std::uint32_t>(offsets.size())).PutBytes(offsets.bytes());
  out.Put(offset_ - begin).PutText(chunk.compression);
  out.Put(chunk.compressed_bytes).Put(chunk.uncompressed_bytes);
  out.ShrinkToFit();
  return out;
}

Status Writer::Attach(std::string_view name, std::string_view media_type, std::uint64_t time,
                      std::span<const std::uint8_t> data) {
  ByteWriter record;
  record.Put(time).Put(time).PutText(name).PutText(media_type);
  record.Put(static_cast<std::uint64_t>(data.size())).PutBytes(data);
  record.Put(Crc32(record.bytes()));
  const std::uint64_t offset = offset_;
  FURROW_RETURN_IF_ERROR(AppendRecord(Opcode::kAttachment, record));
  attachments_.push_back({std::string(name), std::string(media_type), time, time, data.size(),
                          offset, offset_ - offset});
  return {};
}

Status Writer::WriteMetadata(const Metadata& metadata) {
  ByteWriter record;
  record.PutText(metadata.name).PutMap(metadata.values);
  const std::uint64_t offset = offset_;
  FURROW_RETURN_IF_ERROR(AppendRecord(Opcode::kMetadata, record));
  metadata_.push_back({metadata.name, offset, offset_ - offset});
  return {};
}

Status Writer::Close() {
  if (closed_) return failure_;
  closed_ = true;
  // The first failure is reported, even if the summary succeeds.
  Status before = failure_.ok() ? FlushChunk() : failure_;
  // A failure cut the file back to a whole record, so the summary may still fit.
  failure_ = {};
  Status status = WriteSummary();
  if (status.ok() && ::fsync(file_) != 0)
    status = {StatusCode::kIo, std::strerror(errno), path_.string()};
  return before.ok() ? status : before;
}

ByteWriter Writer::Statistics() const {
  ByteWriter counts;
  for (std::size_t i = 0; i < channels_.size(); ++i)
    counts.Put(static_cast<std::uint16_t>(i + 1)).Put(channels_[i].num_messages);
  ByteWriter record;
  record.Put(written_messages_).Put(static_cast<std::uint16_t>(schemas_.size()));
  record.Put(static_cast<std::uint32_t>(channels_.size()));
  record.Put(static_cast<std::uint32_t>(attachments_.size()));
  record.Put(static_cast<std::uint32_t>(metadata_.size()));
  record.Put(static_cast<std::uint32_t>(chunk_index_.size())).Put(start_time_).Put(end_time_);
  record.Put(static_cast<std::uint32_t>(counts.size())).PutBytes(counts.bytes());
  return record;
}

Status Writer::WriteSummary() {
  // The checksum of all bytes so far ends the data section.
  ByteWriter end;
  end.Put(crc_);
  FURROW_RETURN_IF_ERROR(AppendRecord(Opcode::kDataEnd, end));

  SummaryBuilder summary(offset_);
  for (const Schema& schema : schemas_) summary.Add(Opcode::kSchema, ToRecord(schema));
  for (const ChannelInfo& channel : channels_) summary.Add(Opcode::kChannel, channel.record);
  summary.Add(Opcode::kStatistics, Statistics());
  for (const ByteWriter& index : chunk_index_) summary.Add(Opcode::kChunkIndex, index);
  for (const AttachmentInfo& info : attachments_)
    summary.Add(Opcode::kAttachmentIndex, ToIndexRecord(info));
  for (const MetadataInfo& info : metadata_) {
    ByteWriter record;
    record.Put(info.offset).Put(info.length).PutText(info.name);
    summary.Add(Opcode::kMetadataIndex, record);
  }
  return Append(summary.Finish().bytes());
}

}  // namespace furrow::motion::mcap
