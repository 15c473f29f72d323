// SPDX-License-Identifier: Apache-2.0
// A byte stream is read as a whole and in pieces. Both ways must find the same frames.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "protocol/framing/tcp_framing.h"

namespace {

using furrow::protocol::FrameStatus;
using Frames = std::vector<std::vector<std::uint8_t>>;

Frames ReadAll(std::span<const std::uint8_t> stream, std::size_t step) {
  furrow::protocol::FrameReader reader(1 << 16);
  Frames frames;
  while (!stream.empty()) {
    std::span<const std::uint8_t> piece = stream.first(std::min(step, stream.size()));
    stream = stream.subspan(piece.size());
    while (!piece.empty()) {
      std::span<const std::uint8_t> frame;
      const FrameStatus status = reader.Push(piece, frame);
      if (status == FrameStatus::kBadLength) return frames;
      if (status == FrameStatus::kFrame) frames.emplace_back(frame.begin(), frame.end());
    }
  }
  return frames;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> stream(data + 1, size - 1);
  if (ReadAll(stream, size) != ReadAll(stream, data[0] % 37 + 1u)) std::abort();
  return 0;
}
