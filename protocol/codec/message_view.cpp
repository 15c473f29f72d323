// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/message_view.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace furrow::protocol {
namespace {

struct KindInfo {
  MessageKind kind;
  const char* identifier;
  std::string_view name;
};

constexpr std::array<KindInfo, 24> kKinds = {{
    {MessageKind::kHello, "FHEL", "hello"},
    {MessageKind::kWelcome, "FWEL", "welcome"},
    {MessageKind::kPing, "FPIN", "ping"},
    {MessageKind::kPong, "FPON", "pong"},
    {MessageKind::kGoodbye, "FBYE", "goodbye"},
    {MessageKind::kError, "FERR", "error"},
    {MessageKind::kSkeletonOffer, "FSKO", "skeleton_offer"},
    {MessageKind::kSkeletonReply, "FSKR", "skeleton_reply"},
    {MessageKind::kPose, "FPOS", "pose"},
    {MessageKind::kSubscribeWeights, "FSUW", "subscribe_weights"},
    {MessageKind::kSubscribePictures, "FSUP", "subscribe_pictures"},
    {MessageKind::kUnsubscribe, "FUNS", "unsubscribe"},
    {MessageKind::kSubscribeReply, "FSUR", "subscribe_reply"},
    {MessageKind::kWeights, "FWGT", "weights"},
    {MessageKind::kImage, "FIMG", "image"},
    {MessageKind::kUpdatePictures, "FUPP", "update_pictures"},
    {MessageKind::kFrameAck, "FACK", "frame_ack"},
    {MessageKind::kSubscribePoses, "FSPO", "subscribe_poses"},
    {MessageKind::kDropped, "FDRP", "dropped"},
    {MessageKind::kListSubjects, "FLSU", "list_subjects"},
    {MessageKind::kSubjects, "FSBJ", "subjects"},
    {MessageKind::kSubjectState, "FSST", "subject_state"},
    {MessageKind::kDrain, "FDRN", "drain"},
    {MessageKind::kDrainState, "FDRS", "drain_state"},
}};

// Exclusive bound in both directions: the difference of two capture times then fits an int64.
constexpr std::int64_t kCaptureTimeBound = std::int64_t{1} << 62;

DecodeStatus FromEnvelope(EnvelopeStatus status) {
  switch (status) {
    case EnvelopeStatus::kOk: return DecodeStatus::kOk;
    case EnvelopeStatus::kTooShort: return DecodeStatus::kTooShort;
    case EnvelopeStatus::kBadMagic: return DecodeStatus::kBadMagic;
    case EnvelopeStatus::kBadVersion: return DecodeStatus::kBadVersion;
    case EnvelopeStatus::kBadFlags: return DecodeStatus::kBadFlags;
    case EnvelopeStatus::kBadSession: return DecodeStatus::kBadSession;
  }
  return DecodeStatus::kBadFlags;
}

}  // namespace

std::string_view MessageKindName(MessageKind kind) {
  for (const KindInfo& info : kKinds) {
    if (info.kind == kind) return info.name;
  }
  return "unknown";
}

const char* FileIdentifier(MessageKind kind) {
  for (const KindInfo& info : kKinds) {
    if (info.kind == kind) return info.identifier;
  }
  return nullptr;
}

DecodeStatus OpenMessage(std::span<const std::uint8_t> bytes, MessageView& view,
                         std::size_t max_bytes) {
  Envelope envelope;
  FURROW_CHECK_DECODE(FromEnvelope(ReadEnvelope(bytes, envelope)));
  // Callers reassemble fragments and split bundles before, so a flag that is left is a fault.
  if (envelope.flags != 0) return DecodeStatus::kBadFlags;
  const std::int64_t time = envelope.header.capture_time_us;
  if (time <= -kCaptureTimeBound || time >= kCaptureTimeBound) return DecodeStatus::kBadValue;
  view.header = envelope.header;
  view.payload = bytes.subspan(kEnvelopeBytes);
  // The payload must fill the rest exactly: bytes behind it would be unverified.
  if (bytes.size() > max_bytes || view.payload.size() != envelope.payload_bytes ||
      view.payload.size() < kMinPayloadBytes) {
    return DecodeStatus::kBadLength;
  }
  // The identifier is behind the root offset, in payload bytes 4 to 7.
  for (const KindInfo& info : kKinds) {
    if (std::memcmp(info.identifier, view.payload.data() + 4, 4) == 0) {
      view.kind = info.kind;
      return DecodeStatus::kOk;
    }
  }
  view.kind = MessageKind::kUnknown;
  return DecodeStatus::kUnknownKind;
}

void WriteMessage(const Header& header, std::span<const std::uint8_t> payload,
                  std::vector<std::uint8_t>& out) {
  out.resize(kEnvelopeBytes + payload.size());
  const Envelope envelope{header, 0, static_cast<std::uint32_t>(payload.size())};
  WriteEnvelope(envelope, std::span<std::uint8_t, kEnvelopeBytes>(out.data(), kEnvelopeBytes));
  std::copy(payload.begin(), payload.end(), out.begin() + kEnvelopeBytes);
}

}  // namespace furrow::protocol
