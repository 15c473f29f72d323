// SPDX-License-Identifier: Apache-2.0
// Datagrams from a UDP socket: reassembly, splitting of bundles, then decoding of each message as
// its stated kind. An accepted message must be accepted again after it was encoded. The messages of
// an accepted bundle must form the same bundle again. A rejected bundle must stay unchanged.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"

namespace {

using furrow::protocol::DecodeStatus;
using furrow::protocol::Encoder;
using furrow::protocol::MessageKind;
using furrow::protocol::MessageView;

template <class Message>
void RoundTrip(const MessageView& view) {
  Message message;
  if (Decode(view, message) != DecodeStatus::kOk) return;
  static Encoder encoder;
  static std::vector<std::uint8_t> bytes;
  encoder.Encode(view.header, message, bytes);
  MessageView again;
  if (OpenMessage(bytes, again, furrow::protocol::kMaxReplyBytes) != DecodeStatus::kOk ||
      Decode(again, message) != DecodeStatus::kOk) {
    std::abort();
  }
}

// The pose that a pose repeats.
void DecodeRepeated(const MessageView& view) {
  static furrow::protocol::PoseFrame pose;
  static furrow::protocol::PoseFrame previous;
  if (Decode(view, pose) != DecodeStatus::kOk || pose.previous.empty()) return;
  const DecodeStatus status = DecodePrevious(pose, previous);
  if (status == DecodeStatus::kOk && (previous.partial || !previous.previous.empty())) std::abort();
}

void DecodeAny(std::span<const std::uint8_t> bytes) {
  namespace p = furrow::protocol;
  MessageView view;
  if (OpenMessage(bytes, view) != DecodeStatus::kOk) return;
  switch (view.kind) {
    case MessageKind::kHello: return RoundTrip<p::Hello>(view);
    case MessageKind::kWelcome: return RoundTrip<p::Welcome>(view);
    case MessageKind::kPing: return RoundTrip<p::Ping>(view);
    case MessageKind::kPong: return RoundTrip<p::Pong>(view);
    case MessageKind::kGoodbye: return RoundTrip<p::Goodbye>(view);
    case MessageKind::kError: return RoundTrip<p::ErrorMessage>(view);
    case MessageKind::kSkeletonOffer: return RoundTrip<p::SkeletonOffer>(view);
    case MessageKind::kSkeletonReply: return RoundTrip<p::SkeletonReply>(view);
    case MessageKind::kPose: DecodeRepeated(view); return RoundTrip<p::PoseFrame>(view);
    case MessageKind::kSubscribeWeights: return RoundTrip<p::SubscribeWeights>(view);
    case MessageKind::kSubscribePictures: return RoundTrip<p::SubscribePictures>(view);
    case MessageKind::kUnsubscribe: return RoundTrip<p::Unsubscribe>(view);
    case MessageKind::kSubscribeReply: return RoundTrip<p::SubscribeReply>(view);
    case MessageKind::kWeights: return RoundTrip<p::WeightFrame>(view);
    case MessageKind::kImage: return RoundTrip<p::ImageFrame>(view);
    case MessageKind::kSubscribePoses: return RoundTrip<p::SubscribePoses>(view);
    case MessageKind::kDropped: return RoundTrip<p::Dropped>(view);
    case MessageKind::kListSubjects: return RoundTrip<p::ListSubjects>(view);
    case MessageKind::kSubjects: return RoundTrip<p::Subjects>(view);
    case MessageKind::kUpdatePictures: return RoundTrip<p::UpdatePictures>(view);
    case MessageKind::kFrameAck: return RoundTrip<p::FrameAck>(view);
    case MessageKind::kSubjectState: return RoundTrip<p::SubjectState>(view);
    case MessageKind::kDrain: return RoundTrip<p::Drain>(view);
    case MessageKind::kDrainState: return RoundTrip<p::DrainState>(view);
    case MessageKind::kUnknown: return;
  }
}

// Copies `datagram` to a heap block of its size, so a sanitizer detects reads beyond its end.
void TakeApart(std::vector<std::uint8_t> datagram) {
  namespace p = furrow::protocol;
  const std::vector<std::uint8_t> before = datagram;
  p::Unbundler unbundler;
  const p::BundleStatus status = unbundler.Open(datagram);
  std::vector<std::vector<std::uint8_t>> messages;
  std::span<const std::uint8_t> message;
  while (unbundler.Next(message)) {
    messages.emplace_back(message.begin(), message.end());
    DecodeAny(message);
  }
  if (status != p::BundleStatus::kOk || messages.size() < 2) {
    if (before != (messages.empty() ? std::vector<std::uint8_t>() : messages.front())) std::abort();
    return;
  }
  std::vector<std::uint8_t> again;
  if (!p::WriteBundle(messages, again) || again != before) std::abort();
}

}  // namespace

// The input is a sequence of datagrams, each preceded by its length in two bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TakeApart({data, data + size});
  furrow::protocol::Reassembler reassembler;
  std::span<const std::uint8_t> rest(data, size);
  std::int64_t now_us = 0;
  while (rest.size() > 2) {
    const std::size_t length = std::min<std::size_t>(rest[0] | rest[1] << 8, rest.size() - 2);
    std::span<const std::uint8_t> message;
    using furrow::protocol::FragmentStatus;
    const FragmentStatus status = reassembler.Push({}, rest.subspan(2, length), now_us, message);
    if (status == FragmentStatus::kComplete) DecodeAny(message);
    if (status == FragmentStatus::kWhole) TakeApart({message.begin(), message.end()});
    rest = rest.subspan(2 + length);
    (void)reassembler.Expire(now_us += 100'000);
  }
  return 0;
}
