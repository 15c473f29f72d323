// SPDX-License-Identifier: Apache-2.0
// Live Link Face datagrams. The adapter first gets the input and then the input without its first
// byte.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "protocol/mocap/livelink_face.h"

namespace {

void CheckFrame(const furrow::protocol::mocap::NeutralFrame& frame) {
  if (frame.subject.empty() || frame.blend_shapes.size() != 61) std::abort();
  for (const auto& shape : frame.blend_shapes) {
    if (!std::isfinite(shape.value)) std::abort();
  }
  if (frame.timecode && !furrow::IsValid(*frame.timecode)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto adapter = furrow::protocol::mocap::MakeLiveLinkFaceAdapter();
  const std::span<const std::uint8_t> packet(data, size);
  adapter->Push(packet, 0, CheckFrame);
  if (size > 1) adapter->Push(packet.subspan(1), 10'000, CheckFrame);
  return 0;
}
