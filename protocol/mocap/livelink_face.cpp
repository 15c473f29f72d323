// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/livelink_face.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "base/time/timecode.h"
#include "protocol/messages/bytes.h"
#include "protocol/messages/text.h"
#include "protocol/mocap/source_clock.h"

namespace furrow::protocol::mocap {
namespace {

constexpr std::uint8_t kPacketVersion = 6;
constexpr std::size_t kMaxSubjects = 16;
constexpr std::int64_t kLateToleranceUs = 5'000'000;
constexpr std::size_t kDeviceSuffixBytes = 8;

// clang-format off
constexpr std::array<std::string_view, kNumLiveLinkFaceShapes> kShapeNames = {
    "EyeBlinkLeft", "EyeLookDownLeft", "EyeLookInLeft", "EyeLookOutLeft", "EyeLookUpLeft",
    "EyeSquintLeft", "EyeWideLeft", "EyeBlinkRight", "EyeLookDownRight", "EyeLookInRight",
    "EyeLookOutRight", "EyeLookUpRight", "EyeSquintRight", "EyeWideRight", "JawForward", "JawLeft",
    "JawRight", "JawOpen", "MouthClose", "MouthFunnel", "MouthPucker", "MouthLeft", "MouthRight",
    "MouthSmileLeft", "MouthSmileRight", "MouthFrownLeft", "MouthFrownRight", "MouthDimpleLeft",
    "MouthDimpleRight", "MouthStretchLeft", "MouthStretchRight", "MouthRollLower", "MouthRollUpper",
    "MouthShrugLower", "MouthShrugUpper", "MouthPressLeft", "MouthPressRight", "MouthLowerDownLeft",
    "MouthLowerDownRight", "MouthUpperUpLeft", "MouthUpperUpRight", "BrowDownLeft", "BrowDownRight",
    "BrowInnerUp", "BrowOuterUpLeft", "BrowOuterUpRight", "CheekPuff", "CheekSquintLeft",
    "CheekSquintRight", "NoseSneerLeft", "NoseSneerRight", "TongueOut", "HeadYaw", "HeadPitch",
    "HeadRoll", "LeftEyeYaw", "LeftEyePitch", "LeftEyeRoll", "RightEyeYaw", "RightEyePitch",
    "RightEyeRoll",
};
// clang-format on

struct Packet {
  std::string_view device;
  std::string_view subject;
  double seconds = 0.0;  // of the sender's clock
  std::optional<Timecode> timecode;
  bool has_face = false;
  std::array<float, kNumLiveLinkFaceShapes> values{};
};

// Reads big-endian numbers from the front. After a read beyond the end, ok() is false and all reads
// return 0.
class Cursor {
 public:
  explicit Cursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T Take() {
    if (bytes_.size() < sizeof(T)) {
      ok_ = false;
      return T{};
    }
    const T value = LoadBig<T>(bytes_.data());
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

  float TakeFloat() { return std::bit_cast<float>(Take<std::uint32_t>()); }

  std::string_view TakeText() {
    const auto size = Take<std::int32_t>();
    // The size is signed on the wire, so negative sizes are possible.
    if (!ok_ || size < 1 || size > kMaxNameBytes ||
        bytes_.size() < static_cast<std::size_t>(size)) {
      ok_ = false;
      return {};
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()),
                                static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(text.size());
    ok_ = IsPlainText(text);
    return text;
  }

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::uint8_t> bytes_;
  bool ok_ = true;
};

bool ReadTime(Cursor& cursor, Packet& packet) {
  const auto frame = cursor.Take<std::int32_t>();
  const float subframe = cursor.TakeFloat();
  const auto numerator = cursor.Take<std::int32_t>();
  const auto denominator = cursor.Take<std::int32_t>();
  const bool good = cursor.ok() && std::isfinite(subframe) && std::fabs(subframe) <= 1.0f &&
                    frame >= 0 && numerator > 0 && denominator > 0;
  // The rate is numerator / denominator frames per second.
  if (good) packet.seconds = (frame + double{subframe}) * denominator / numerator;
  packet.timecode = MakeTimecode(frame, double{subframe}, numerator, denominator);
  return good && packet.seconds < 1e9;
}

bool ReadPacket(std::span<const std::uint8_t> bytes, Packet& packet) {
  Cursor cursor(bytes);
  if (cursor.Take<std::uint8_t>() != kPacketVersion) return false;
  packet.device = cursor.TakeText();
  if (!cursor.ok()) return false;
  packet.subject = cursor.TakeText();
  if (!cursor.ok() || !ReadTime(cursor, packet)) return false;
  packet.has_face = !cursor.at_end();
  if (!packet.has_face) return true;
  if (cursor.Take<std::uint8_t>() != kNumLiveLinkFaceShapes) return false;
  for (float& value : packet.values) {
    value = cursor.TakeFloat();
    // The negation also rejects NaN.
    if (!(std::fabs(value) <= kMaxMagnitude)) return false;
  }
  return cursor.ok() && cursor.at_end();
}

struct Sender {
  std::string device;
  std::string subject;  // as sent
  SourceClock clock;
  std::int64_t heard_us = 0;
  NeutralFrame frame;
};

class LiveLinkFaceAdapter final : public MocapAdapter {
 public:
  void Push(std::span<const std::uint8_t> datagram, std::int64_t now_us,
            const FrameSink& sink) override {
    Packet packet;
    if (!ReadPacket(datagram, packet)) {
      ++counters_.malformed;
      return;
    }
    Sender& sender = FindOrAdd(packet);
    sender.heard_us = now_us;
    const auto source_us = static_cast<std::int64_t>(std::llround(packet.seconds * 1e6));
    if (sender.clock.Advance(source_us, now_us, kLateToleranceUs) ==
        SourceClock::Order::kNotNewer) {
      ++counters_.reordered;
      return;
    }
    NeutralFrame& frame = sender.frame;
    frame.tracked = packet.has_face;
    frame.capture_time_us = sender.clock.time_us();
    frame.timecode = packet.timecode;
    if (packet.has_face) {
      for (std::size_t i = 0; i < packet.values.size(); ++i) {
        frame.blend_shapes[i].value = packet.values[i];
      }
    }
    ++counters_.accepted;
    sink(frame);
    ++frame.sequence;
  }

  // Every datagram is a whole frame, so no frame ever waits.
  void Tick(std::int64_t /*now_us*/, const FrameSink& /*sink*/) override {}

 private:
  Sender& FindOrAdd(const Packet& packet) {
    const auto same = [&packet](const Sender& sender) {
      return sender.device == packet.device && sender.subject == packet.subject;
    };
    const auto found = std::find_if(senders_.begin(), senders_.end(), same);
    if (found != senders_.end()) return *found;
    // Spoofed device names would otherwise use memory without bound.
    if (senders_.size() == kMaxSubjects) {
      senders_.erase(std::min_element(
          senders_.begin(), senders_.end(),
          [](const Sender& a, const Sender& b) { return a.heard_us < b.heard_us; }));
    }
    Sender sender;
    sender.device = packet.device;
    sender.subject = packet.subject;
    sender.frame.subject = SubjectFor(packet);
    for (const std::string_view name : kShapeNames) {
      sender.frame.blend_shapes.push_back({std::string(name), 0.0f});
    }
    return senders_.emplace_back(std::move(sender));
  }

  [[nodiscard]] std::string SubjectFor(const Packet& packet) const {
    const bool taken = std::any_of(
        senders_.begin(), senders_.end(),
        [&packet](const Sender& sender) { return sender.frame.subject == packet.subject; });
    if (!taken) return std::string(packet.subject);
    std::string subject(PlainPrefix(packet.subject, kMaxNameBytes - kDeviceSuffixBytes - 1));
    subject += '-';
    subject += PlainPrefix(packet.device, kDeviceSuffixBytes);
    return subject;
  }

  std::vector<Sender> senders_;
};

}  // namespace

std::span<const std::string_view> LiveLinkFaceShapeNames() { return kShapeNames; }

std::unique_ptr<MocapAdapter> MakeLiveLinkFaceAdapter() {
  return std::make_unique<LiveLinkFaceAdapter>();
}

}  // namespace furrow::protocol::mocap
