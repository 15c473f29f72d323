// SPDX-License-Identifier: Apache-2.0
// OSC packets through the VMC adapter: every frame must yield an offer that the codec accepts.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/mocap/vmc.h"

namespace {

namespace p = furrow::protocol;

void CheckFrame(const p::mocap::NeutralFrame& frame) {
  const p::SkeletonOffer offer = MakeOffer(frame);
  p::Encoder encoder;
  std::vector<std::uint8_t> bytes;
  encoder.Encode({1, 0, 0, 0}, offer, bytes);
  p::MessageView view;
  p::SkeletonOffer again;
  if (OpenMessage(bytes, view) != p::DecodeStatus::kOk ||
      Decode(view, again) != p::DecodeStatus::kOk) {
    std::abort();
  }
  p::PoseFrame pose;
  MakePose(frame, offer, pose);
  encoder.Encode({1, 0, 0, 0}, pose, bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto adapter = p::mocap::MakeVmcAdapter();
  const std::span<const std::uint8_t> packet(data, size);
  for (std::int64_t now_us = 0; now_us < 100'000; now_us += 50'000) {
    adapter->Push(packet, now_us, CheckFrame);
    adapter->Tick(now_us + 50'000, CheckFrame);
  }
  return 0;
}
