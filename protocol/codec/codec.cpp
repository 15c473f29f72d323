// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "protocol/codec/codec_internal.h"
#include "protocol/messages/text.h"

namespace furrow::protocol {
namespace {

struct KindInfo {
  MessageKind kind;
  const char* identifier;
  std::string_view name;
};

constexpr std::array<KindInfo, 21> kKinds = {{
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
}};

constexpr std::array<std::string_view, kNumDecodeStatuses> kStatusNames = {
    "ok",         "too_short",    "bad_magic",  "bad_version", "bad_flags",     "bad_session",
    "bad_length", "unknown_kind", "wrong_kind", "unverified",  "missing_field", "bad_count",
    "limit",      "non_finite",   "not_unit",   "bad_value",   "bad_text",      "bad_hash"};

// Exclusive, either way: any two capture times may be subtracted.
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

std::string_view DecodeStatusName(DecodeStatus status) {
  const auto index = static_cast<std::size_t>(status);
  return index < kStatusNames.size() ? kStatusNames[index] : "unknown";
}

std::string_view MessageKindName(MessageKind kind) {
  for (const KindInfo& info : kKinds) {
    if (info.kind == kind) return info.name;
  }
  return "unknown";
}

DecodeStatus OpenMessage(std::span<const std::uint8_t> bytes, MessageView& view,
                         std::size_t max_bytes) {
  Envelope envelope;
  FURROW_CHECK_DECODE(FromEnvelope(ReadEnvelope(bytes, envelope)));
  if (envelope.flags != 0) return DecodeStatus::kBadFlags;
  const std::int64_t time = envelope.header.capture_time_us;
  if (time <= -kCaptureTimeBound || time >= kCaptureTimeBound) return DecodeStatus::kBadValue;
  view.header = envelope.header;
  view.payload = bytes.subspan(kEnvelopeBytes);
  if (bytes.size() > max_bytes || view.payload.size() != envelope.payload_bytes ||
      view.payload.size() < kMinPayloadBytes) {
    return DecodeStatus::kBadLength;
  }
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

Encoder::Encoder() : state_(std::make_unique<State>()) {}
Encoder::~Encoder() = default;
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;

namespace internal {

const char* Identifier(MessageKind kind) {
  for (const KindInfo& info : kKinds) {
    if (info.kind == kind) return info.identifier;
  }
  return nullptr;
}

const std::uint8_t* AlignedPayload(std::span<const std::uint8_t> payload) {
  if (reinterpret_cast<std::uintptr_t>(payload.data()) % 8 == 0) return payload.data();
  thread_local std::vector<std::uint64_t> copy;
  copy.resize((payload.size() + 7) / 8);
  std::memcpy(copy.data(), payload.data(), payload.size());
  return reinterpret_cast<const std::uint8_t*>(copy.data());
}

DecodeStatus ReadText(const flatbuffers::String* text, int max_bytes, std::string& out,
                      Presence presence) {
  out.clear();
  if (text == nullptr || text->size() == 0) {
    return presence == Presence::kRequired ? DecodeStatus::kMissingField : DecodeStatus::kOk;
  }
  if (text->size() > static_cast<std::size_t>(max_bytes)) return DecodeStatus::kLimit;
  if (!IsPlainText(text->string_view())) return DecodeStatus::kBadText;
  out.assign(text->c_str(), text->size());
  return DecodeStatus::kOk;
}

TextOffset WriteText(Builder& builder, std::string_view text) {
  return text.empty() ? TextOffset(0) : builder.CreateString(text.data(), text.size());
}

DecodeStatus CheckNames(const TextVector* names, int max_names) {
  if (names == nullptr) return DecodeStatus::kOk;
  if (names->size() > static_cast<std::size_t>(max_names)) return DecodeStatus::kLimit;
  std::vector<std::string_view> sorted;
  sorted.reserve(names->size());
  for (const flatbuffers::String* name : *names) {
    if (name->size() == 0) return DecodeStatus::kBadText;
    if (name->size() > kMaxNameBytes) return DecodeStatus::kLimit;
    if (!IsPlainText(name->string_view())) return DecodeStatus::kBadText;
    sorted.push_back(name->string_view());
  }
  std::sort(sorted.begin(), sorted.end());
  const bool twice = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  return twice ? DecodeStatus::kBadText : DecodeStatus::kOk;
}

DecodeStatus ReadNames(const TextVector* names, int max_names, std::vector<std::string>& out) {
  FURROW_CHECK_DECODE(CheckNames(names, max_names));
  out.resize(SizeOf(names));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const flatbuffers::String* name = names->Get(static_cast<flatbuffers::uoffset_t>(i));
    out[i].assign(name->c_str(), name->size());
  }
  return DecodeStatus::kOk;
}

DecodeStatus CheckNumber(float value) {
  if (!std::isfinite(value)) return DecodeStatus::kNonFinite;
  return std::fabs(value) <= kMaxMagnitude ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

DecodeStatus CheckVector(const Vec3& value) {
  FURROW_CHECK_DECODE(CheckNumber(value.x));
  FURROW_CHECK_DECODE(CheckNumber(value.y));
  return CheckNumber(value.z);
}

DecodeStatus CheckRotation(const Quat& q) {
  const float squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z) || !std::isfinite(q.w)) {
    return DecodeStatus::kNonFinite;
  }
  return std::fabs(std::sqrt(squared) - 1.0f) <= 1e-3f ? DecodeStatus::kOk : DecodeStatus::kNotUnit;
}

DecodeStatus CheckRate(float rate_hz) {
  FURROW_CHECK_DECODE(CheckNumber(rate_hz));
  return rate_hz >= 0.0f && rate_hz <= kMaxRateHz ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

DecodeStatus ReadMask(const flatbuffers::Vector<std::uint8_t>* mask, std::size_t n,
                      std::size_t num_values, std::vector<std::uint16_t>& indices) {
  indices.clear();
  if (mask == nullptr) {
    if (num_values != 0 && num_values != n) return DecodeStatus::kBadCount;
    for (std::size_t i = 0; i < num_values; ++i) indices.push_back(static_cast<std::uint16_t>(i));
    return DecodeStatus::kOk;
  }
  if (mask->size() != (n + 7) / 8) return DecodeStatus::kBadCount;
  for (std::size_t i = 0; i < mask->size() * std::size_t{8}; ++i) {
    if ((mask->Get(static_cast<flatbuffers::uoffset_t>(i / 8)) >> (i % 8) & 1) == 0) continue;
    if (i >= n || indices.size() == num_values) return DecodeStatus::kBadCount;
    indices.push_back(static_cast<std::uint16_t>(i));
  }
  return indices.size() == num_values ? DecodeStatus::kOk : DecodeStatus::kBadCount;
}

flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> WriteMask(
    Encoder::State& state, std::span<const std::uint16_t> indices, std::size_t n) {
  if (indices.empty() || indices.size() == n) return 0;
  state.mask.assign((n + 7) / 8, 0);
  for (const std::uint16_t index : indices) {
    state.mask[index / 8] = static_cast<std::uint8_t>(state.mask[index / 8] | 1u << (index % 8));
  }
  return state.builder.CreateVector(state.mask);
}

}  // namespace internal
}  // namespace furrow::protocol
