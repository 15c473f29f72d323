// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "motion/mcap/compression.h"
#include "motion/mcap/reader.h"
#include "motion/mcap/writer.h"
#include "tests/temporary_folder.h"
#include "tests/unit/allocation_counter.h"
#include "tests/unit/motion/mcap/text_bytes.h"

namespace furrow::motion::mcap {
namespace {

namespace fs = std::filesystem;

struct Seen {
  std::string topic;
  std::uint32_t sequence;
  std::uint64_t log_time;
  std::string data;
  bool operator==(const Seen&) const = default;
};

class McapTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name = "take.mcap") const {
    return folder_ / name;
  }

  // Writes two channels, `count` messages, an attachment and metadata.
  void WriteTake(const fs::path& path, int count, std::uint64_t chunk_bytes, bool close = true) {
    auto writer = Writer::Create(path, {.chunk_bytes = chunk_bytes});
    ASSERT_TRUE(writer.ok()) << writer.status().ToString();
    const auto schema = (*writer)->AddSchema("test.Pose", "flatbuffer", TextBytes("schema bytes"));
    const std::uint16_t channels[2] = {
        (*writer)->AddChannel("/a/pose", "flatbuffer", schema, {{"subject", "a"}}),
        (*writer)->AddChannel("/raw", "datagram", 0)};
    ASSERT_TRUE((*writer)->Attach("rig.json", "application/json", 5, TextBytes("{}")).ok());
    for (int i = 0; i < count; ++i) {
      const auto data = TextBytes("message " + std::to_string(i));
      Message message;
      message.channel_id = channels[i % 2];
      message.sequence = static_cast<std::uint32_t>(i);
      message.log_time = 1000u + 10u * static_cast<std::uint64_t>(i);
      message.publish_time = message.log_time - 3;
      message.data = data;
      ASSERT_TRUE((*writer)->Write(message).ok());
    }
    ASSERT_TRUE((*writer)->WriteMetadata({"take", {{"scene", "12"}}}).ok());
    if (close) {
      ASSERT_TRUE((*writer)->Close().ok());
    }
  }

  static std::vector<Seen> ReadAll(Reader& reader, const Reader::Range& range = {}) {
    std::vector<Seen> seen;
    const Status status = reader.ForEach(range, [&](const Message& m) {
      const auto channel = reader.channels().find(m.channel_id);
      seen.push_back({channel == reader.channels().end() ? "?" : channel->second.topic,
                      m.sequence,
                      m.log_time,
                      {m.data.begin(), m.data.end()}});
      return true;
    });
    EXPECT_TRUE(status.ok()) << status.ToString();
    return seen;
  }

  static std::string Slurp(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void Spill(const fs::path& path, const std::string& bytes) {
    fs::remove(path);  // some file systems wait for the disk when a truncated file is rewritten
    std::ofstream(path, std::ios::binary) << bytes;
  }

  TemporaryFolder folder_;
};

TEST_F(McapTest, RoundTrip) {
  WriteTake(Path(), 100, 400);
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok()) << reader.status().ToString();
  EXPECT_TRUE((*reader)->complete());
  EXPECT_TRUE((*reader)->warnings().empty());
  EXPECT_EQ((*reader)->profile(), "furrow");
  EXPECT_GT((*reader)->chunks().size(), 5u);
  EXPECT_EQ((*reader)->schemas().at(1).data, TextBytes("schema bytes"));
  EXPECT_EQ((*reader)->channels().at(1).metadata.at("subject"), "a");
  ASSERT_EQ((*reader)->metadata().size(), 1u);
  EXPECT_EQ((*reader)->metadata()[0].values.at("scene"), "12");
  ASSERT_EQ((*reader)->attachments().size(), 1u);
  const auto rig = (*reader)->ReadAttachment((*reader)->attachments()[0]);
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_EQ(*rig, TextBytes("{}"));

  const auto seen = ReadAll(**reader);
  ASSERT_EQ(seen.size(), 100u);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Seen expected{i % 2 == 0 ? "/a/pose" : "/raw", i, 1000 + 10 * i,
                        "message " + std::to_string(i)};
    EXPECT_EQ(seen[i], expected);
  }
}

TEST_F(McapTest, ReadsBytesLikeTheirFile) {
  WriteTake(Path(), 100, 400);
  const std::vector<std::uint8_t> whole = TextBytes(Slurp(Path()));
  auto file = Reader::Open(Path());
  auto reader = Reader::OpenBytes(whole, "take.mcap");
  ASSERT_TRUE(file.ok() && reader.ok()) << reader.status().ToString();
  EXPECT_TRUE((*reader)->complete());
  EXPECT_EQ(ReadAll(**reader), ReadAll(**file));
  EXPECT_EQ(*(*reader)->ReadAttachment((*reader)->attachments()[0]), TextBytes("{}"));
  // A buffer of its own for each length, so that AddressSanitizer sees every read past its end.
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> part(whole.begin(), whole.begin() + static_cast<long>(size));
    auto cut = Reader::OpenBytes(part, "take.mcap");
    if (!cut.ok()) {
      EXPECT_EQ(cut.status().where(), "take.mcap");
      continue;
    }
    EXPECT_FALSE((*cut)->complete()) << size;
    (void)ReadAll(**cut);
  }
}

TEST_F(McapTest, ReadsARangeOfTime) {
  WriteTake(Path(), 100, 400);
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok());
  const auto seen = ReadAll(**reader, {.from = 1205, .to = 1300});
  ASSERT_EQ(seen.size(), 10u);
  EXPECT_EQ(seen.front().sequence, 21u);
  EXPECT_EQ(seen.back().sequence, 30u);
}

TEST_F(McapTest, ATruncatedFileKeepsEveryWholeChunk) {
  WriteTake(Path(), 8, 200);
  const std::string whole = Slurp(Path());
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok());
  const std::vector<ChunkInfo> chunks = (*reader)->chunks();
  const auto all = ReadAll(**reader);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Spill(Path("cut.mcap"), whole.substr(0, size));
    auto cut = Reader::Open(Path("cut.mcap"));
    if (!cut.ok()) {
      EXPECT_LT(size, 64u) << cut.status().ToString();  // shorter than a header
      continue;
    }
    EXPECT_FALSE((*cut)->complete());
    EXPECT_FALSE((*cut)->warnings().empty()) << size;
    std::size_t expected = 0;
    for (const ChunkInfo& chunk : chunks) expected += chunk.offset + chunk.length <= size;
    EXPECT_EQ((*cut)->chunks().size(), expected) << size;
    const auto seen = ReadAll(**cut);
    ASSERT_LE(seen.size(), all.size());
    EXPECT_TRUE(std::equal(seen.begin(), seen.end(), all.begin()));
  }
}

TEST_F(McapTest, ADeadWriterLeavesWhatWasFlushed) {
  WriteTake(Path(), 40, 300, false);
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok());
  EXPECT_FALSE((*reader)->complete());
  EXPECT_GE(ReadAll(**reader).size(), 30u);
  EXPECT_EQ((*reader)->attachments().size(), 1u);
}

// Changes every byte in turn. The reader must not crash, and every message that it still passes on
// must be genuine.
TEST_F(McapTest, NeverPassesOnDamagedData) {
  WriteTake(Path(), 5, 200);
  const std::string whole = Slurp(Path());
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok());
  const auto all = ReadAll(**reader);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x41);
    Spill(Path("bad.mcap"), damaged);
    auto bad = Reader::Open(Path("bad.mcap"));
    if (!bad.ok()) continue;
    for (const Seen& seen : ReadAll(**bad)) {
      const bool true_message = std::find_if(all.begin(), all.end(), [&](const Seen& s) {
                                  return s.data == seen.data && s.log_time == seen.log_time;
                                }) != all.end();
      EXPECT_TRUE(true_message) << "byte " << i;
    }
  }
}

TEST_F(McapTest, WarnsOfDamageOnce) {
  WriteTake(Path(), 100, 400);
  auto whole = Reader::Open(Path());
  ASSERT_TRUE(whole.ok());
  std::string damaged = Slurp(Path());
  const ChunkInfo& second = (*whole)->chunks().at(1);
  damaged[second.offset + second.length - 20] ^= 0x41;
  Spill(Path("bad.mcap"), damaged);
  auto bad = Reader::Open(Path("bad.mcap"));
  ASSERT_TRUE(bad.ok());
  ASSERT_TRUE((*bad)->complete());
  const auto once = ReadAll(**bad);
  ASSERT_EQ((*bad)->warnings().size(), 1u);
  EXPECT_EQ(ReadAll(**bad).size(), once.size());
  EXPECT_EQ((*bad)->warnings().size(), 1u);
}

TEST_F(McapTest, SortsOverlappingChunksByTime) {
  auto writer = Writer::Create(Path());
  ASSERT_TRUE(writer.ok());
  const auto channel = (*writer)->AddChannel("/x", "text", 0);
  for (const std::uint64_t time : {50u, 10u, 30u, 0u, 20u, 60u, 5u, 5u}) {
    Message message;
    message.channel_id = channel;
    message.log_time = time;
    ASSERT_TRUE((*writer)->Write(message).ok());
    if (time == 30 || time == 60) {
      ASSERT_TRUE((*writer)->FlushChunk().ok());
    }
  }
  ASSERT_TRUE((*writer)->Close().ok());
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok());
  std::vector<std::uint64_t> times;
  for (const Seen& seen : ReadAll(**reader)) times.push_back(seen.log_time);
  EXPECT_EQ(times, (std::vector<std::uint64_t>{0, 5, 5, 10, 20, 30, 50, 60}));
}

TEST_F(McapTest, AFullDiskLeavesAReadableFile) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20000, 20000};  // beyond this size write() fails with EFBIG
    ::setrlimit(RLIMIT_FSIZE, &limit);
    auto writer = Writer::Create(Path(), {.chunk_bytes = 2000});
    if (!writer.ok()) ::_exit(2);
    const auto channel = (*writer)->AddChannel("/x", "text", 0);
    std::uint32_t seed = 1;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      std::vector<std::uint8_t> noise(100);
      for (std::uint8_t& byte : noise)
        byte = static_cast<std::uint8_t>((seed = seed * 1664525u + 1013904223u) >> 24);
      Message message;
      message.channel_id = channel;
      message.sequence = i;
      message.log_time = i + 1;
      message.data = noise;
      if (Status status = (*writer)->Write(message); !status.ok()) {
        // The error persists, and Close() returns it as well.
        const bool again = (*writer)->Write(message).ok() || (*writer)->Close().ok();
        ::_exit(status.code() == StatusCode::kIo && !again ? 0 : 3);
      }
    }
    ::_exit(4);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 0);
  auto reader = Reader::Open(Path());
  ASSERT_TRUE(reader.ok()) << reader.status().ToString();
  const auto seen = ReadAll(**reader);
  EXPECT_GT(seen.size(), 100u);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i].sequence, i);
}

// The contents of a closed file's summary.
struct Summary {
  std::uint64_t messages = 0;
  std::uint32_t chunks = 0;
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::map<std::uint16_t, std::uint64_t> of_channel;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> message_indexes;  // channel, offset
};

Summary ReadSummary(std::span<const std::uint8_t> file) {
  Summary summary;
  constexpr std::size_t kTail = 20 + sizeof kMagic;
  const auto start = ByteReader(file.last(kTail)).Get<std::uint64_t>();
  ByteReader records(file.subspan(start, file.size() - kTail - kRecordHeaderBytes - start));
  while (records.ok() && !records.at_end()) {
    const auto opcode = static_cast<Opcode>(records.Get<std::uint8_t>());
    ByteReader content(records.GetBytes(records.Get<std::uint64_t>()));
    if (opcode == Opcode::kStatistics) {
      summary.messages = content.Get<std::uint64_t>();
      (void)content.GetBytes(2 + 4 + 4 + 4);  // schemas, channels, attachments, metadata
      summary.chunks = content.Get<std::uint32_t>();
      summary.start_time = content.Get<std::uint64_t>();
      summary.end_time = content.Get<std::uint64_t>();
      ByteReader counts(content.GetBytes(content.Get<std::uint32_t>()));
      while (!counts.at_end()) {
        const auto id = counts.Get<std::uint16_t>();
        summary.of_channel[id] = counts.Get<std::uint64_t>();
      }
    } else if (opcode == Opcode::kChunkIndex) {
      (void)content.GetBytes(4 * 8);  // times, offset and length of the chunk
      ByteReader offsets(content.GetBytes(content.Get<std::uint32_t>()));
      while (!offsets.at_end()) {
        const auto id = offsets.Get<std::uint16_t>();
        summary.message_indexes.emplace_back(id, offsets.Get<std::uint64_t>());
      }
    }
  }
  EXPECT_TRUE(records.ok());
  return summary;
}

// Writes until a disk of `bytes` bytes is full, then closes the file on a disk with space.
void FillThenClose(const fs::path& path, rlim_t bytes) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    const rlim_t room = std::exchange(limit.rlim_cur, bytes);
    ::setrlimit(RLIMIT_FSIZE, &limit);
    auto writer = Writer::Create(path, {.chunk_bytes = 300});
    if (!writer.ok()) ::_exit(2);
    const std::uint16_t channels[] = {(*writer)->AddChannel("/x", "text", 0),
                                      (*writer)->AddChannel("/y", "text", 0)};
    Status status;
    for (std::uint32_t i = 0; status.ok() && i < 1000; ++i) {
      Message message;
      message.channel_id = channels[i % 3 == 0];
      message.sequence = i;
      message.log_time = 100 + i;
      status = (*writer)->Write(message);
    }
    limit.rlim_cur = room;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(status.ok() || (*writer)->Close().ok() ? 3 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 0);
}

// The summary must list what is in the file, whether the disk ends within a chunk or its index.
TEST_F(McapTest, TheIndexIsRightAfterAFullDisk) {
  for (rlim_t bytes = 900; bytes < 1900; bytes += 37) {
    const fs::path path = Path(std::to_string(bytes));
    ASSERT_NO_FATAL_FAILURE(FillThenClose(path, bytes));
    auto reader = Reader::Open(path);
    ASSERT_TRUE(reader.ok()) << reader.status().ToString();
    EXPECT_TRUE((*reader)->complete());
    const auto seen = ReadAll(**reader);
    ASSERT_FALSE(seen.empty());
    const std::string text = Slurp(path);
    const Summary summary = ReadSummary(TextBytes(text));
    EXPECT_EQ(summary.messages, seen.size()) << bytes;
    EXPECT_EQ(summary.chunks, (*reader)->chunks().size());
    EXPECT_EQ(summary.start_time, seen.front().log_time);
    EXPECT_EQ(summary.end_time, seen.back().log_time) << bytes;
    for (const auto& [id, count] : summary.of_channel) {
      const std::string& topic = (*reader)->channels().at(id).topic;
      EXPECT_EQ(count, std::ranges::count(seen, topic, &Seen::topic)) << topic;
    }
    for (const auto& [id, offset] : summary.message_indexes) {
      ASSERT_LT(offset + kRecordHeaderBytes + 2, text.size());
      EXPECT_EQ(text[offset], static_cast<char>(Opcode::kMessageIndex)) << bytes;
      EXPECT_EQ(static_cast<std::uint8_t>(text[offset + kRecordHeaderBytes]), id) << bytes;
    }
  }
}

TEST_F(McapTest, RejectsOtherFiles) {
  Spill(Path("x"), "HIERARCHY\nROOT hips\n{\n}\n");
  EXPECT_EQ(Reader::Open(Path("x")).status().code(), StatusCode::kParse);
  Spill(Path("empty"), "");
  EXPECT_EQ(Reader::Open(Path("empty")).status().code(), StatusCode::kParse);
  EXPECT_EQ(Reader::Open(Path("none")).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(Reader::Open(folder_.path()).status().code(), StatusCode::kInvalidArgument);
}

TEST_F(McapTest, LackOfMemoryCostsOneMessage) {
  auto writer = Writer::Create(Path(), {.chunk_bytes = 1 << 20}).value();
  const std::uint16_t schema = writer->AddSchema("s", "e", {});
  const std::vector<std::uint8_t> data(3000, 7);
  std::vector<std::uint64_t> accepted;
  accepted.reserve(400);
  for (std::uint64_t i = 0; i < 400; ++i) {
    const std::uint16_t channel =
        writer->AddChannel("topic" + std::to_string(i % 40), "none", schema);
    const Message message{.channel_id = channel, .log_time = i, .publish_time = i, .data = data};
    const furrow::test::AllocationLimit limit(i % 37);
    try {
      ASSERT_TRUE(writer->Write(message).ok());
    } catch (const std::bad_alloc&) {
      continue;
    }
    accepted.push_back(i);
  }
  ASSERT_TRUE(writer->Close().ok());
  EXPECT_GT(accepted.size(), 200u);
  EXPECT_LT(accepted.size(), 400u);
  const auto reader = Reader::Open(Path()).value();
  std::vector<std::uint64_t> read;
  const Status status = reader->ForEach({}, [&](const Message& message) {
    EXPECT_TRUE(std::ranges::equal(message.data, data));
    read.push_back(message.log_time);
    return true;
  });
  EXPECT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(read, accepted);
  EXPECT_TRUE(reader->warnings().empty());
}

TEST_F(McapTest, NeverOverwrites) {
  Spill(Path(), "precious");
  EXPECT_EQ(Writer::Create(Path()).status().code(), StatusCode::kIo);
  EXPECT_EQ(Slurp(Path()), "precious");
}

TEST(McapCompression, RejectsUnknownMethodsAndWrongSizes) {
  const std::vector<std::uint8_t> bytes(1000, 7);
  const auto packed = CompressZstd(bytes, 3).value();
  EXPECT_LT(packed.size(), 100u);
  EXPECT_EQ(*Decompress("zstd", packed, 1000), bytes);
  EXPECT_FALSE(Decompress("zstd", packed, 999).ok());
  EXPECT_FALSE(Decompress("zstd", packed, 1001).ok());
  EXPECT_FALSE(Decompress("lz4", packed, 1000).ok());
  EXPECT_EQ(Decompress("brotli", packed, 1000).status().code(), StatusCode::kUnsupported);
}

TEST(McapCompression, Crc32MatchesTheFormat) {
  // The published check value of CRC-32/ISO-HDLC.
  EXPECT_EQ(Crc32(TextBytes("123456789")), 0xCBF43926u);
  EXPECT_EQ(Crc32(TextBytes("6789"), Crc32(TextBytes("12345"))), 0xCBF43926u);
}

}  // namespace
}  // namespace furrow::motion::mcap
