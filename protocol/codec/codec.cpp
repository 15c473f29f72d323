// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/codec.h"

#include <algorithm>
#include <cstring>

#include "protocol/codec/cluster_messages.h"
#include "protocol/codec/connection_messages.h"
#include "protocol/codec/picture_messages.h"
#include "protocol/codec/pose_message.h"
#include "protocol/codec/skeleton_messages.h"
#include "protocol/codec/subscription_messages.h"
#include "protocol/codec/weights_message.h"
#include "protocol/codec/wire_fields.h"

namespace furrow::protocol {

struct Encoder::State {
  internal::PayloadBuilder payload;
};

namespace {

// Each message: its struct, its FlatBuffers table and its kind.
template <class WireTable, MessageKind message_kind>
struct Entry {
  using Table = WireTable;
  static constexpr MessageKind kKind = message_kind;
};
template <class Message>
struct EntryOf;
// clang-format off
template <> struct EntryOf<Hello> : Entry<wire::Hello, MessageKind::kHello> {};
template <> struct EntryOf<Welcome> : Entry<wire::Welcome, MessageKind::kWelcome> {};
template <> struct EntryOf<Ping> : Entry<wire::Ping, MessageKind::kPing> {};
template <> struct EntryOf<Pong> : Entry<wire::Pong, MessageKind::kPong> {};
template <> struct EntryOf<Goodbye> : Entry<wire::Goodbye, MessageKind::kGoodbye> {};
template <> struct EntryOf<ErrorMessage> : Entry<wire::Error, MessageKind::kError> {};
template <> struct EntryOf<SkeletonOffer> : Entry<wire::SkeletonOffer, MessageKind::kSkeletonOffer> {};
template <> struct EntryOf<SkeletonReply> : Entry<wire::SkeletonReply, MessageKind::kSkeletonReply> {};
template <> struct EntryOf<PoseFrame> : Entry<wire::Pose, MessageKind::kPose> {};
template <> struct EntryOf<SubscribeWeights> : Entry<wire::SubscribeWeights, MessageKind::kSubscribeWeights> {};
template <> struct EntryOf<SubscribePictures> : Entry<wire::SubscribePictures, MessageKind::kSubscribePictures> {};
template <> struct EntryOf<Unsubscribe> : Entry<wire::Unsubscribe, MessageKind::kUnsubscribe> {};
template <> struct EntryOf<SubscribeReply> : Entry<wire::SubscribeReply, MessageKind::kSubscribeReply> {};
template <> struct EntryOf<WeightFrame> : Entry<wire::Weights, MessageKind::kWeights> {};
template <> struct EntryOf<ImageFrame> : Entry<wire::Image, MessageKind::kImage> {};
template <> struct EntryOf<UpdatePictures> : Entry<wire::UpdatePictures, MessageKind::kUpdatePictures> {};
template <> struct EntryOf<FrameAck> : Entry<wire::FrameAck, MessageKind::kFrameAck> {};
template <> struct EntryOf<SubscribePoses> : Entry<wire::SubscribePoses, MessageKind::kSubscribePoses> {};
template <> struct EntryOf<Dropped> : Entry<wire::Dropped, MessageKind::kDropped> {};
template <> struct EntryOf<ListSubjects> : Entry<wire::ListSubjects, MessageKind::kListSubjects> {};
template <> struct EntryOf<Subjects> : Entry<wire::Subjects, MessageKind::kSubjects> {};
template <> struct EntryOf<SubjectState> : Entry<wire::SubjectState, MessageKind::kSubjectState> {};
template <> struct EntryOf<Drain> : Entry<wire::Drain, MessageKind::kDrain> {};
template <> struct EntryOf<DrainState> : Entry<wire::DrainState, MessageKind::kDrainState> {};
// clang-format on

// FlatBuffers loads numbers from aligned addresses, and a message inside a receive buffer may lie
// anywhere. Returns the payload itself if its address is a multiple of 8. Otherwise returns a copy
// in memory of this thread, valid until the next call.
const std::uint8_t* AlignedPayload(std::span<const std::uint8_t> payload) {
  if (reinterpret_cast<std::uintptr_t>(payload.data()) % 8 == 0) return payload.data();
  thread_local std::vector<std::uint64_t> copy;
  copy.resize((payload.size() + 7) / 8);
  std::memcpy(copy.data(), payload.data(), payload.size());
  return reinterpret_cast<const std::uint8_t*>(copy.data());
}

// The order matters: kind, alignment, verification, and only then access. Each limit of the
// verifier bounds the work that a hostile payload can cause.
template <class Message>
DecodeStatus DecodeMessage(const MessageView& view, Message& message) {
  using Table = typename EntryOf<Message>::Table;
  constexpr MessageKind kKind = EntryOf<Message>::kKind;
  if (view.kind != kKind) return DecodeStatus::kWrongKind;
  const std::uint8_t* payload = AlignedPayload(view.payload);
  flatbuffers::Verifier verifier(payload, view.payload.size(), kMaxVerifierDepth,
                                 kMaxVerifierTables);
  if (!verifier.VerifyBuffer<Table>(FileIdentifier(kKind))) return DecodeStatus::kUnverified;
  return internal::ReadTable(*flatbuffers::GetRoot<Table>(payload), message);
}

// `options`: what the WriteTable() of this message takes besides the message.
template <class Message, class... Options>
void EncodeMessage(internal::PayloadBuilder& payload, const Header& header, const Message& message,
                   std::vector<std::uint8_t>& out, const Options&... options) {
  flatbuffers::FlatBufferBuilder& builder = payload.builder;
  builder.Clear();
  builder.Finish(internal::WriteTable(payload, message, options...),
                 FileIdentifier(EntryOf<Message>::kKind));
  WriteMessage(header, {builder.GetBufferPointer(), builder.GetSize()}, out);
}

}  // namespace

Encoder::Encoder() : state_(std::make_unique<State>()) {}
Encoder::~Encoder() = default;
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;

void Encoder::Encode(const Header& header, const Hello& message, std::vector<std::uint8_t>& out) {
  // The size of the other fields depends on alignment. The first round encodes without padding and
  // shows how many bytes are missing.
  std::size_t padding = 0;
  do {
    // kHelloBytes is a minimum, so that a server's answer to an unknown address is never larger
    // than the request.
    EncodeMessage(state_->payload, header, message, out, padding);
    padding += kHelloBytes - std::min(kHelloBytes, out.size());
  } while (out.size() < kHelloBytes);
}

void Encoder::Encode(const Header& header, const PoseFrame& message, std::vector<std::uint8_t>& out,
                     const PoseEncoding& encoding) {
  EncodeMessage(state_->payload, header, message, out, encoding);
  if (encoding.quantise_to_fit && out.size() > kMaxDatagramBytes) {
    EncodeMessage(state_->payload, header, message, out, PoseEncoding::Small());
  }
}

void Encoder::Encode(const Header& header, const Welcome& message, std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Ping& message, std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Pong& message, std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Goodbye& message, std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const ErrorMessage& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SkeletonOffer& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SkeletonReply& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SubscribeWeights& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SubscribePictures& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Unsubscribe& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SubscribeReply& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const WeightFrame& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const ImageFrame& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const UpdatePictures& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const FrameAck& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SubscribePoses& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Dropped& message, std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const ListSubjects& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Subjects& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const SubjectState& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const Drain& message, std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}
void Encoder::Encode(const Header& header, const DrainState& message,
                     std::vector<std::uint8_t>& out) {
  EncodeMessage(state_->payload, header, message, out);
}

DecodeStatus Decode(const MessageView& view, Hello& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, Welcome& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, Ping& message) { return DecodeMessage(view, message); }
DecodeStatus Decode(const MessageView& view, Pong& message) { return DecodeMessage(view, message); }
DecodeStatus Decode(const MessageView& view, Goodbye& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, ErrorMessage& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, SkeletonOffer& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, SkeletonReply& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, PoseFrame& message) {
  return DecodeMessage(view, message);
}
DecodeStatus DecodePrevious(const PoseFrame& pose, PoseFrame& previous) {
  // The verifier below checks the identifier.
  const MessageView view{.kind = MessageKind::kPose, .payload = pose.previous};
  const DecodeStatus status = DecodeMessage(view, previous);
  if (status != DecodeStatus::kOk) return status;
  const bool fits = !previous.partial && previous.previous.empty() &&
                    previous.skeleton_hash == pose.skeleton_hash;
  return fits ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}
DecodeStatus Decode(const MessageView& view, SubscribeWeights& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, SubscribePictures& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, Unsubscribe& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, SubscribeReply& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, WeightFrame& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, ImageFrame& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, UpdatePictures& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, FrameAck& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, SubscribePoses& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, Dropped& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, ListSubjects& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, Subjects& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, SubjectState& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, Drain& message) {
  return DecodeMessage(view, message);
}
DecodeStatus Decode(const MessageView& view, DrainState& message) {
  return DecodeMessage(view, message);
}

}  // namespace furrow::protocol
