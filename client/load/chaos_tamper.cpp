// SPDX-License-Identifier: Apache-2.0
#include "client/load/chaos_tamper.h"

#include <cstddef>

#include "protocol/codec.h"

namespace furrow::load {
namespace {

using protocol::DecodeStatus;
using protocol::MessageKind;

bool OpenTamperable(std::span<const std::uint8_t> datagram, protocol::MessageView* view) {
  return protocol::OpenMessage(datagram, *view) == DecodeStatus::kOk &&
         (view->kind == MessageKind::kPose || view->kind == MessageKind::kWeights);
}

std::size_t Choose(std::size_t count, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(count));
}

bool FalsifyWeights(const protocol::MessageView& view, double share,
                    std::vector<std::uint8_t>* out) {
  protocol::WeightFrame frame;
  if (protocol::Decode(view, frame) != DecodeStatus::kOk || frame.values.empty()) return false;
  float& value = frame.values[Choose(frame.values.size(), share)];
  value += value < 0.5f ? 0.5f : -0.5f;
  protocol::Encoder().Encode(view.header, frame, *out);
  return true;
}

// Multiplied by a turn about x of 120 degrees: (1/2 + sqrt(3)/2 i).
bool FalsifyPose(const protocol::MessageView& view, double share, std::vector<std::uint8_t>* out) {
  constexpr float kCosine = 0.5f;
  constexpr float kSine = 0.86602540378f;
  protocol::PoseFrame frame;
  if (protocol::Decode(view, frame) != DecodeStatus::kOk || frame.rotations.empty()) return false;
  protocol::Quat& q = frame.rotations[Choose(frame.rotations.size(), share)];
  q = {kCosine * q.x + kSine * q.w, kCosine * q.y + kSine * q.z, kCosine * q.z - kSine * q.y,
       kCosine * q.w - kSine * q.x};
  protocol::Encoder().Encode(view.header, frame, *out, protocol::PoseEncoding::Small());
  return true;
}

}  // namespace

bool IsTamperable(std::span<const std::uint8_t> datagram) {
  protocol::MessageView view;
  return OpenTamperable(datagram, &view);
}

bool Falsify(std::vector<std::uint8_t>* datagram, double share) {
  protocol::MessageView view;
  if (!OpenTamperable(*datagram, &view)) return false;
  std::vector<std::uint8_t> changed;
  const bool done = view.kind == MessageKind::kPose ? FalsifyPose(view, share, &changed)
                                                    : FalsifyWeights(view, share, &changed);
  if (done) *datagram = std::move(changed);
  return done;
}

bool SwapContents(std::vector<std::uint8_t>* a, std::vector<std::uint8_t>* b) {
  protocol::MessageView first;
  protocol::MessageView second;
  if (!OpenTamperable(*a, &first) || !OpenTamperable(*b, &second) || first.kind != second.kind)
    return false;
  const auto join = [](const protocol::Header& header, std::span<const std::uint8_t> payload) {
    std::vector<std::uint8_t> message(protocol::kEnvelopeBytes);
    message.insert(message.end(), payload.begin(), payload.end());
    protocol::WriteEnvelope(
        {.header = header, .payload_bytes = static_cast<std::uint32_t>(payload.size())},
        std::span<std::uint8_t>(message).first<protocol::kEnvelopeBytes>());
    return message;
  };
  std::vector<std::uint8_t> changed = join(first.header, second.payload);
  *b = join(second.header, first.payload);
  *a = std::move(changed);
  return true;
}

}  // namespace furrow::load
