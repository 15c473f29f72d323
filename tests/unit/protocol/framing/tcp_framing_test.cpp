// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/tcp_framing.h"

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::Bytes;

Bytes Framed(const std::vector<Bytes>& messages) {
  Bytes stream;
  for (const Bytes& message : messages) {
    const auto prefix = FramePrefix(message.size());
    stream.insert(stream.end(), prefix.begin(), prefix.end());
    stream.insert(stream.end(), message.begin(), message.end());
  }
  return stream;
}

// Feeds `stream` in pieces of `step` bytes, each in its own heap block.
std::vector<Bytes> ReadAll(const Bytes& stream, std::size_t step) {
  FrameReader reader(kMaxRequestBytes);
  std::vector<Bytes> frames;
  for (std::size_t at = 0; at < stream.size(); at += step) {
    const std::size_t size = std::min(step, stream.size() - at);
    const auto block = std::make_unique<std::uint8_t[]>(size);
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), size, block.get());
    std::span<const std::uint8_t> bytes(block.get(), size);
    while (!bytes.empty()) {
      std::span<const std::uint8_t> frame;
      if (reader.Push(bytes, frame) != FrameStatus::kFrame) continue;
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(frame.data()) % 8, 0u);
      frames.emplace_back(frame.begin(), frame.end());
    }
  }
  return frames;
}

TEST(FrameReader, SplitsPiecesOfAnySize) {
  const std::vector<Bytes> messages = {test::Encoded(Ping{1}),
                                       test::Encoded(test::MakeOffer(100, 5)),
                                       test::Encoded(Unsubscribe{}), test::Encoded(Pong{1, 2})};
  const Bytes stream = Framed(messages);
  for (const std::size_t step : {std::size_t{1}, std::size_t{3}, std::size_t{64}, stream.size()}) {
    EXPECT_EQ(ReadAll(stream, step), messages) << step;
  }
}

TEST(FrameReader, WaitsForTheWholeFrame) {
  const Bytes stream = Framed({test::Encoded(Ping{1})});
  test::ForEveryTruncation(stream, [](std::span<const std::uint8_t> cut) {
    FrameReader reader(kMaxRequestBytes);
    std::span<const std::uint8_t> frame;
    EXPECT_EQ(reader.Push(cut, frame), FrameStatus::kNeedMore);
    EXPECT_TRUE(cut.empty());
  });
}

TEST(FrameReader, StopsAtALengthOutOfRange) {
  for (const std::size_t length : {std::size_t{0}, kEnvelopeBytes - 1, std::size_t{1001}}) {
    FrameReader reader(1000);
    const auto prefix = FramePrefix(length);
    std::span<const std::uint8_t> bytes(prefix);
    std::span<const std::uint8_t> frame;
    EXPECT_EQ(reader.Push(bytes, frame), FrameStatus::kBadLength) << length;
    const Bytes good = Framed({test::Encoded(Ping{1})});
    bytes = good;
    EXPECT_EQ(reader.Push(bytes, frame), FrameStatus::kBadLength) << "for good";
  }
}

TEST(FrameReader, ClaimedLengthTakesNoMemory) {
  FrameReader reader(kMaxReplyBytes);
  const auto prefix = FramePrefix(kMaxReplyBytes);
  std::span<const std::uint8_t> bytes(prefix);
  std::span<const std::uint8_t> frame;
  const std::uint64_t before = furrow::test::NumAllocations();
  EXPECT_EQ(reader.Push(bytes, frame), FrameStatus::kNeedMore);
  EXPECT_EQ(furrow::test::NumAllocations(), before);
}

// Wherever the stream is cut.
TEST(FrameReader, AnotherReaderGoesOnInItsPlace) {
  const Bytes stream = Framed({test::Encoded(Ping{1}), test::Encoded(Ping{2})});
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    std::vector<Bytes> frames;
    const auto push = [&frames](FrameReader& reader, std::span<const std::uint8_t> bytes) {
      std::span<const std::uint8_t> frame;
      while (!bytes.empty() && reader.Push(bytes, frame) == FrameStatus::kFrame) {
        frames.emplace_back(frame.begin(), frame.end());
      }
    };
    FrameReader first(1000);
    push(first, std::span(stream).first(cut));
    FrameReader second(1000);
    const std::size_t before = frames.size();
    push(second, first.unfinished());
    EXPECT_EQ(frames.size(), before) << cut;
    push(second, std::span(stream).subspan(cut));
    EXPECT_EQ(frames, (std::vector<Bytes>{test::Encoded(Ping{1}), test::Encoded(Ping{2})})) << cut;
  }
}

}  // namespace
}  // namespace furrow::protocol
