// SPDX-License-Identifier: Apache-2.0
// Files built record by record: valid files of other writers, and invalid ones.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "motion/mcap/compression.h"
#include "motion/mcap/reader.h"
#include "tests/temporary_folder.h"
#include "tests/unit/motion/mcap/text_bytes.h"

namespace furrow::motion::mcap {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

ByteWriter SchemaRecord(std::uint16_t id, std::size_t size) {
  ByteWriter content;
  content.Put(id).PutText("toy").PutText("text");
  content.PutText(std::string(size, 's'));
  return content;
}

ByteWriter ChannelRecord(std::uint16_t id) {
  ByteWriter content;
  content.Put(id).Put(std::uint16_t{0}).PutText("/x").PutText("text").PutMap({});
  return content;
}

ByteWriter MessageRecord(std::uint64_t time, std::string_view data) {
  ByteWriter content;
  content.Put(std::uint16_t{1}).Put(std::uint32_t{0}).Put(time).Put(time);
  return content.PutBytes(TextBytes(data));
}

// An lz4 frame of stored 64 KiB blocks. The header checksum comes from the reference program.
Bytes Lz4Frame(std::span<const std::uint8_t> bytes) {
  ByteWriter frame;
  frame.PutBytes(Bytes{0x04, 0x22, 0x4d, 0x18, 0x60, 0x40, 0x82});
  while (!bytes.empty()) {
    const auto block = bytes.first(std::min<std::size_t>(bytes.size(), 64u << 10));
    frame.Put(static_cast<std::uint32_t>(block.size() | 0x8000'0000u)).PutBytes(block);
    bytes = bytes.subspan(block.size());
  }
  frame.Put(std::uint32_t{0});
  return {frame.bytes().begin(), frame.bytes().end()};
}

struct Placed {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
};

// The contents of a chunk; messages are (log time, data).
struct ChunkOf {
  std::vector<std::pair<std::uint64_t, std::string>> messages;
  std::string compression;
  std::size_t schemas = 0;  // number of declared schemas of 1000 bytes each
};

class HandMade {
 public:
  HandMade() {
    ByteWriter header;
    file_.PutBytes(kMagic).PutRecord(Opcode::kHeader, header.PutText("").PutText("by hand"));
  }

  Placed Add(Opcode opcode, const ByteWriter& content) {
    const std::uint64_t offset = file_.size();
    file_.PutRecord(opcode, content);
    return {offset, file_.size() - offset};
  }

  Placed AddChunk(const ChunkOf& chunk) {
    ByteWriter records;
    for (std::size_t i = 0; i < chunk.schemas; ++i)
      records.PutRecord(Opcode::kSchema, SchemaRecord(static_cast<std::uint16_t>(i + 1), 1000));
    records.PutRecord(Opcode::kChannel, ChannelRecord(1));
    for (const auto& [time, data] : chunk.messages)
      records.PutRecord(Opcode::kMessage, MessageRecord(time, data));
    const Bytes plain(records.bytes().begin(), records.bytes().end());
    const Bytes packed = chunk.compression == "zstd"  ? CompressZstd(plain, 1).value()
                         : chunk.compression == "lz4" ? Lz4Frame(plain)
                                                      : plain;
    uncompressed_ = plain.size();
    ByteWriter content;
    content.Put(chunk.messages.front().first).Put(chunk.messages.back().first);
    content.Put(std::uint64_t{plain.size()}).Put(std::uint32_t{0}).PutText(chunk.compression);
    content.Put(std::uint64_t{packed.size()}).PutBytes(packed);
    return Add(Opcode::kChunk, content);
  }

  // Adds an index of the last chunk that covers all times.
  void IndexChunk(const Placed& chunk) {
    ByteWriter content;
    content.Put(std::uint64_t{0}).Put(~std::uint64_t{0}).Put(chunk.offset).Put(chunk.length);
    content.Put(std::uint32_t{0}).Put(std::uint64_t{0}).PutText("");
    content.Put(std::uint64_t{0}).Put(uncompressed_);
    summary_.PutRecord(Opcode::kChunkIndex, content);
  }

  Placed AddMetadata(std::size_t size) {
    ByteWriter content;
    return Add(Opcode::kMetadata, content.PutText(std::string(size, 'm')).PutMap({{"a", "b"}}));
  }
  void IndexMetadata(const Placed& metadata) {
    ByteWriter content;
    content.Put(metadata.offset).Put(metadata.length).PutText("m");
    summary_.PutRecord(Opcode::kMetadataIndex, content);
  }

  // Adds an attachment without a checksum, and its index.
  Placed AddAttachment(std::string_view data) {
    ByteWriter content;
    content.Put(std::uint64_t{0}).Put(std::uint64_t{0}).PutText("name").PutText("text/plain");
    content.Put(std::uint64_t{data.size()}).PutBytes(TextBytes(data)).Put(std::uint32_t{0});
    return Add(Opcode::kAttachment, content);
  }
  void IndexAttachment(const Placed& attachment) {
    ByteWriter content;
    content.Put(attachment.offset).Put(attachment.length);
    content.Put(std::uint64_t{0}).Put(std::uint64_t{0}).Put(std::uint64_t{0});
    summary_.PutRecord(Opcode::kAttachmentIndex, content.PutText("name").PutText("text/plain"));
  }

  // Writes the file with a summary. Its statistics omit messages outside chunks.
  [[nodiscard]] fs::path Finish(const fs::path& path, std::optional<std::uint64_t> messages = 0) {
    file_.PutRecord(Opcode::kDataEnd, ByteWriter().Put(std::uint32_t{0}));
    const std::uint64_t start = file_.size();
    if (messages) file_.PutRecord(Opcode::kStatistics, ByteWriter().Put(*messages));
    file_.PutBytes(summary_.bytes());
    // A summary may hold any records, so this one is not empty.
    file_.PutRecord(Opcode::kSchema, SchemaRecord(9, 1));
    return PutFooter(start, path);
  }
  // Writes the whole file without a summary, as the format allows.
  [[nodiscard]] fs::path End(const fs::path& path) {
    file_.PutRecord(Opcode::kDataEnd, ByteWriter().Put(std::uint32_t{0}));
    return PutFooter(0, path);
  }
  // Writes the file without a summary.
  [[nodiscard]] fs::path Write(const fs::path& path) const {
    const auto bytes = file_.bytes();
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return path;
  }

 private:
  fs::path PutFooter(std::uint64_t start, const fs::path& path) {
    ByteWriter footer;
    file_.PutRecord(Opcode::kFooter, footer.Put(start).Put(std::uint64_t{0}).Put(std::uint32_t{0}));
    file_.PutBytes(kMagic);
    return Write(path);
  }

  ByteWriter file_;
  ByteWriter summary_;
  std::uint64_t uncompressed_ = 0;
};

class McapHandMadeTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path() const { return folder_ / "made.mcap"; }
  [[nodiscard]] static std::unique_ptr<Reader> Open(const fs::path& path,
                                                    const ReaderLimits& limits = {}) {
    auto reader = Reader::Open(path, limits);
    EXPECT_TRUE(reader.ok()) << reader.status().ToString();
    return reader.ok() ? *std::move(reader) : nullptr;
  }
  [[nodiscard]] static std::vector<std::string> ReadAll(Reader& reader) {
    std::vector<std::string> seen;
    const Status status = reader.ForEach({}, [&](const Message& message) {
      seen.emplace_back(message.data.begin(), message.data.end());
      return true;
    });
    EXPECT_TRUE(status.ok()) << status.ToString();
    return seen;
  }

  TemporaryFolder folder_;
};

using Texts = std::vector<std::string>;

TEST_F(McapHandMadeTest, ReadsAllCompressionsAndLooseMessages) {
  HandMade file;
  (void)file.Add(Opcode::kChannel, ChannelRecord(1));
  (void)file.Add(Opcode::kMessage, MessageRecord(5, "loose"));
  (void)file.AddChunk({{{10, "zstd 1"}, {20, "zstd 2"}}, "zstd"});
  (void)file.AddChunk({{{11, "lz4 1"}, {21, "lz4 2"}}, "lz4"});
  (void)file.AddChunk({{{12, "plain 1"}, {22, "plain 2"}}, ""});
  (void)file.Add(Opcode::kMessage, MessageRecord(15, "alone"));
  const auto reader = Open(file.Write(Path()));
  EXPECT_FALSE(reader->complete());
  EXPECT_EQ(reader->warnings().size(), 1u);
  EXPECT_EQ(ReadAll(*reader),
            (Texts{"loose", "zstd 1", "lz4 1", "plain 1", "alone", "zstd 2", "lz4 2", "plain 2"}));
}

// Chunks, indexes, statistics and the whole summary are optional.
TEST_F(McapHandMadeTest, FilesWithoutChunksOrIndexAreWhole) {
  using Statistics = std::optional<std::uint64_t>;
  for (const bool chunked : {false, true}) {
    HandMade file;
    if (chunked) {
      (void)file.AddChunk({{{10, "a"}, {20, "b"}}, "zstd"});
    } else {
      (void)file.Add(Opcode::kChannel, ChannelRecord(1));
      (void)file.Add(Opcode::kMessage, MessageRecord(10, "a"));
      (void)file.Add(Opcode::kMessage, MessageRecord(20, "b"));
    }
    for (const bool summary : {false, true}) {
      // Statistics of a summary count messages that no chunk index lists.
      for (const Statistics count : {Statistics(), Statistics(2)}) {
        HandMade copy = file;
        const auto reader = Open(summary ? copy.Finish(Path(), count) : copy.End(Path()));
        EXPECT_TRUE(reader->complete()) << chunked << summary << count.has_value();
        EXPECT_TRUE(reader->warnings().empty()) << reader->warnings().front();
        EXPECT_EQ(ReadAll(*reader), (Texts{"a", "b"}));
      }
    }
    // Without the footer, the writer died.
    EXPECT_FALSE(Open(file.Write(Path()))->complete());
  }
}

TEST_F(McapHandMadeTest, MessagesWithEqualTimesKeepTheFilesOrder) {
  HandMade file;
  (void)file.AddChunk({{{10, "a"}, {20, "b"}, {20, "c"}}, ""});
  (void)file.AddChunk({{{5, "first"}, {20, "d"}}, ""});
  EXPECT_EQ(ReadAll(*Open(file.Write(Path()))), (Texts{"first", "a", "b", "c", "d"}));
}

// Otherwise a small file could make the reader read it any number of times.
TEST_F(McapHandMadeTest, IgnoresASummaryWithDuplicateRecords) {
  for (const int times : {1, 2, 1000}) {
    for (const Opcode twice : {Opcode::kChunk, Opcode::kMetadata, Opcode::kAttachment}) {
      const auto count = [&](Opcode opcode) { return opcode == twice ? times : 1; };
      HandMade file;
      const Placed metadata = file.AddMetadata(100);
      const Placed attachment = file.AddAttachment("data");
      const Placed chunk = file.AddChunk({{{10, "a"}, {20, "b"}}, "zstd"});
      for (int i = 0; i < count(Opcode::kMetadata); ++i) file.IndexMetadata(metadata);
      for (int i = 0; i < count(Opcode::kAttachment); ++i) file.IndexAttachment(attachment);
      for (int i = 0; i < count(Opcode::kChunk); ++i) file.IndexChunk(chunk);
      const auto reader = Open(file.Finish(Path()));
      EXPECT_EQ(reader->complete(), times == 1);
      EXPECT_EQ(ReadAll(*reader), (Texts{"a", "b"}));
      EXPECT_EQ(reader->metadata().size(), 1u);
      ASSERT_EQ(reader->attachments().size(), 1u);
      EXPECT_EQ(reader->ReadAttachment(reader->attachments()[0]).value(), TextBytes("data"));
    }
  }
}

TEST_F(McapHandMadeTest, IgnoresASummaryWithOverlappingOrOutsideRecords) {
  const std::vector<Placed> shifts = {{1, 0}, {0, 1}, {1u << 20, 0}, {0, 1u << 20}};
  for (const Placed& shift : shifts) {
    HandMade file;
    const Placed chunk = file.AddChunk({{{10, "a"}}, ""});
    const Placed attachment = file.AddAttachment("data");
    file.IndexAttachment(attachment);
    file.IndexChunk({chunk.offset + shift.offset, chunk.length + shift.length});
    const auto reader = Open(file.Finish(Path()));
    EXPECT_FALSE(reader->complete());
    EXPECT_EQ(ReadAll(*reader), Texts{"a"});
  }
}

TEST_F(McapHandMadeTest, LimitOfARecord) {
  HandMade file;
  (void)file.AddChunk({{{10, std::string(5000, 'x')}}, "zstd"});  // small until it is decompressed
  (void)file.AddChunk({{{20, "small"}}, "zstd"});
  (void)file.Write(Path());
  EXPECT_EQ(ReadAll(*Open(Path())).size(), 2u);
  const auto reader = Open(Path(), {.record_bytes = 4000});
  EXPECT_EQ(ReadAll(*reader), Texts{"small"});
  EXPECT_EQ(reader->warnings().size(), 2u);  // the second: there is no index
  EXPECT_EQ(Reader::Open(Path(), {.record_bytes = 8}).status().code(), StatusCode::kParse);
}

// The overhead of each message counts as well.
TEST_F(McapHandMadeTest, LimitOfLoadedBytes) {
  HandMade file;
  ChunkOf chunk;
  for (std::uint64_t i = 0; i < 1000; ++i) chunk.messages.emplace_back(i, "");
  for (int i = 0; i < 3; ++i) (void)file.AddChunk(chunk);  // 31 kB each, at the same time
  (void)file.Write(Path());
  EXPECT_EQ(ReadAll(*Open(Path(), {.loaded_bytes = 300'000})).size(), 3000u);
  for (const std::uint64_t limit : {1'000, 35'000, 110'000}) {
    const Status status =
        Open(Path(), {.loaded_bytes = limit})->ForEach({}, [](const Message&) { return true; });
    EXPECT_EQ(status.code(), StatusCode::kLimit) << limit;
  }
  // Any number of chunks fits if they do not overlap.
  HandMade row;
  for (std::uint64_t i = 0; i < 20; ++i) (void)row.AddChunk({{{i, std::string(900, 'x')}}, ""});
  EXPECT_EQ(ReadAll(*Open(row.Write(Path()), {.loaded_bytes = 2'500})).size(), 20u);
}

TEST_F(McapHandMadeTest, LimitOfKeptBytes) {
  HandMade file;
  for (int i = 0; i < 10; ++i) file.IndexMetadata(file.AddMetadata(1000));
  (void)file.Finish(Path());
  EXPECT_EQ(Open(Path())->metadata().size(), 10u);
  const auto few = Open(Path(), {.kept_bytes = 5'000});
  EXPECT_FALSE(few->complete());
  EXPECT_EQ(few->metadata().size(), 3u);
  EXPECT_FALSE(few->warnings().empty());

  // Chunks that declare too much are skipped.
  HandMade chunks;
  (void)chunks.AddChunk({{{10, "a"}}, "", 2});
  (void)chunks.AddChunk({{{20, "b"}}, "", 9});
  (void)chunks.AddChunk({{{30, "c"}}, "", 2});
  (void)chunks.Write(Path());
  EXPECT_EQ(ReadAll(*Open(Path())).size(), 3u);
  const auto reader = Open(Path(), {.kept_bytes = 5'000});
  EXPECT_EQ(ReadAll(*reader), (Texts{"a", "c"}));
  EXPECT_LT(reader->schemas().size(), 5u);
}

TEST_F(McapHandMadeTest, LimitOfRecords) {
  HandMade file;
  for (std::uint64_t i = 0; i < 5; ++i) {
    (void)file.AddChunk({{{i, "x"}}, ""});
    (void)file.AddAttachment("y");
  }
  const auto reader = Open(file.Write(Path()), {.records = 3});
  EXPECT_EQ(reader->chunks().size(), 3u);
  EXPECT_EQ(reader->attachments().size(), 3u);
  EXPECT_EQ(reader->warnings().size(), 5u);  // two chunks, two attachments, no index
}

TEST_F(McapHandMadeTest, AFileThatShrinksIsAnIoError) {
  HandMade file;
  (void)file.AddChunk({{{10, std::string(1000, 'x')}}, ""});
  const auto reader = Open(file.Write(Path()));
  fs::resize_file(Path(), 100);
  const Status status = reader->ForEach({}, [](const Message&) { return true; });
  EXPECT_EQ(status.code(), StatusCode::kIo) << status.ToString();
}

TEST(McapCompression, DecompressesLz4Frames) {
  // Output of `lz4 --no-frame-crc` for twelve times "furrow " and then "end of it".
  const Bytes packed = {0x04, 0x22, 0x4d, 0x18, 0x60, 0x40, 0x82, 0x15, 0x00, 0x00, 0x00, 0x7f,
                        0x66, 0x75, 0x72, 0x72, 0x6f, 0x77, 0x20, 0x07, 0x00, 0x3a, 0x90, 0x65,
                        0x6e, 0x64, 0x20, 0x6f, 0x66, 0x20, 0x69, 0x74, 0x00, 0x00, 0x00, 0x00};
  std::string text;
  for (int i = 0; i < 12; ++i) text += "furrow ";
  text += "end of it";
  EXPECT_EQ(Decompress("lz4", packed, text.size()).value(), TextBytes(text));
  for (const std::size_t size : {std::size_t{0}, text.size() - 1, text.size() + 1})
    EXPECT_FALSE(Decompress("lz4", packed, size).ok()) << size;
  for (std::size_t size = 0; size < packed.size(); ++size)
    EXPECT_FALSE(Decompress("lz4", std::span(packed).first(size), text.size()).ok()) << size;
}

// The stated size exceeds any memory. Nothing may be allocated before there is data for it.
TEST(McapCompression, DoesNotTrustStatedSizes) {
  const Bytes bytes(200'000, 7);
  const Bytes zstd = CompressZstd(bytes, 3).value();
  EXPECT_EQ(Decompress("zstd", zstd, bytes.size()).value(), bytes);
  EXPECT_EQ(Decompress("lz4", Lz4Frame(bytes), bytes.size()).value(), bytes);
  for (const char* method : {"zstd", "lz4", ""}) {
    const Bytes packed = method == std::string_view("zstd") ? zstd : Lz4Frame(bytes);
    EXPECT_EQ(Decompress(method, packed, std::uint64_t{1} << 60).status().code(),
              StatusCode::kParse);
  }
  // Consecutive frames form one result.
  Bytes both = zstd;
  both.insert(both.end(), zstd.begin(), zstd.end());
  EXPECT_EQ(Decompress("zstd", both, 2 * bytes.size()).value().size(), 2 * bytes.size());
}

}  // namespace
}  // namespace furrow::motion::mcap
