// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/vmc.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "protocol/messages/hash.h"
#include "protocol/mocap/osc.h"
#include "protocol/mocap/source_clock.h"
#include "protocol/mocap/vmc_state.h"

namespace furrow::protocol::mocap {
namespace {

constexpr std::int64_t kRecentUs = 1'000'000;        // validity of an end mark
constexpr std::int64_t kMaxClockStepUs = 1'000'000;  // a /T further back means a restart

enum class Read : std::uint8_t { kUsed, kIgnored, kMalformed };

// Reads position and rotation, and converts them from Unity's axes (see vmc.h).
bool ReadTransform(OscArguments& arguments, Vec3& translation, Quat& rotation) {
  float v[7];
  for (float& value : v) {
    if (!arguments.Float(value) || !(std::fabs(value) <= kMaxMagnitude)) return false;
  }
  const float length = std::sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
  if (length < 1e-6f) return false;
  translation = {-v[0], v[1], v[2]};
  rotation = {v[3] / length, -v[4] / length, -v[5] / length, v[6] / length};
  return true;
}

class VmcAdapter final : public MocapAdapter {
 public:
  explicit VmcAdapter(const VmcOptions& options)
      : timeout_us_(options.timeout_us), state_(options.subject) {}

  // The sink belongs to the caller, so it is kept for the duration of a call only.
  void Push(std::span<const std::uint8_t> datagram, std::int64_t now_us,
            const FrameSink& sink) override {
    now_us_ = now_us;
    sink_ = &sink;
    const OscVisitor visit = [this](const OscMessage& message) { Dispatch(message); };
    if (VisitOsc(datagram, visit) != OscStatus::kOk) ++counters_.malformed;
    sink_ = nullptr;
  }

  void Tick(std::int64_t now_us, const FrameSink& sink) override {
    if (!pending_ || now_us - pending_since_us_ < timeout_us_) return;
    now_us_ = now_us;
    sink_ = &sink;
    ++counters_.incomplete;
    Commit();
    sink_ = nullptr;
  }

  void Forget() override {
    state_.Clear();
    pending_ = false;
    loaded_ = tracked_ = true;
    last_time_us_ = last_apply_us_ = last_source_us_ = kNever;
    avatar_hash_.reset();
  }

 private:
  void Dispatch(const OscMessage& message) {
    switch (Apply(message)) {
      case Read::kUsed: return;
      case Read::kIgnored: ++counters_.ignored; return;
      case Read::kMalformed: ++counters_.malformed; return;
    }
  }

  Read Apply(const OscMessage& message) {
    constexpr std::string_view kPrefix = "/VMC/Ext/";
    if (!message.address.starts_with(kPrefix)) return Read::kIgnored;
    const std::string_view what = message.address.substr(kPrefix.size());
    OscArguments arguments(message);
    if (what == "Bone/Pos") return Bone(arguments);
    if (what == "Blend/Val") return BlendValue(arguments);
    if (what == "Blend/Apply") return BlendApply();
    if (what == "Root/Pos") return Root(arguments);
    if (what == "T") return Time(arguments);
    if (what == "OK") return Available(arguments);
    if (what == "VRM") return Avatar(arguments);
    return Read::kIgnored;
  }

  Read Bone(OscArguments& arguments) {
    std::string_view name;
    Vec3 translation;
    Quat rotation;
    if (!arguments.String(name) || !ReadTransform(arguments, translation, rotation)) {
      return Read::kMalformed;
    }
    const int joint = state_.FindOrAddJoint(name);
    if (joint < 0) return Read::kMalformed;
    // A joint that repeats starts the next frame, for senders without end marks.
    if (state_.HasInFrame(joint) && !Recent(last_time_us_) && !Recent(last_apply_us_)) {
      ++counters_.incomplete;
      Commit();
    }
    MarkPending();
    state_.SetJoint(joint, translation, rotation);
    return Read::kUsed;
  }

  Read Root(OscArguments& arguments) {
    std::string_view name;
    Vec3 translation;
    Quat rotation;
    if (arguments.next_tag() == 's' && !arguments.String(name)) return Read::kMalformed;
    if (!ReadTransform(arguments, translation, rotation)) return Read::kMalformed;
    MarkPending();
    state_.SetJoint(state_.AddRoot(), translation, rotation);
    return Read::kUsed;
  }

  Read BlendValue(OscArguments& arguments) {
    std::string_view name;
    float value = 0.0f;
    if (!arguments.String(name) || !arguments.Float(value)) return Read::kMalformed;
    if (!(std::fabs(value) <= kMaxMagnitude)) return Read::kMalformed;
    if (!state_.SetBlendShape(name, value)) return Read::kMalformed;
    MarkPending();
    return Read::kUsed;
  }

  Read BlendApply() {
    last_apply_us_ = now_us_;
    // A sender of /T ends its frames with that instead.
    if (pending_ && !Recent(last_time_us_)) Commit();
    return Read::kUsed;
  }

  Read Time(OscArguments& arguments) {
    float seconds = 0.0f;
    if (!arguments.Float(seconds) || !(std::fabs(seconds) < 1e9f)) return Read::kMalformed;
    last_time_us_ = now_us_;
    if (!pending_) return Read::kUsed;
    const auto source_us = static_cast<std::int64_t>(std::llround(double{seconds} * 1e6));
    if (source_us == last_source_us_) {
      // A 32-bit float of seconds repeats from frame to frame after a day or two. Some senders
      // always send the same value.
      clock_.AdvanceByArrival(now_us_);
    } else if (clock_.Advance(source_us, now_us_, kMaxClockStepUs) ==
               SourceClock::Order::kNotNewer) {
      ++counters_.reordered;
      pending_ = false;
      state_.EndFrame();
      return Read::kUsed;
    }
    last_source_us_ = source_us;
    Commit();
    return Read::kUsed;
  }

  // loaded [, calibration state, mode [, tracking]]
  Read Available(OscArguments& arguments) {
    std::int32_t loaded = 0;
    std::int32_t value = 0;
    if (!arguments.Int(loaded)) return Read::kMalformed;
    loaded_ = loaded != 0;
    tracked_ = true;
    if (arguments.Int(value) && arguments.Int(value) && arguments.Int(value)) tracked_ = value != 0;
    return Read::kUsed;
  }

  // path, title [, hash of the file]
  Read Avatar(OscArguments& arguments) {
    std::string_view path;
    std::string_view title;
    if (!arguments.String(path) || !arguments.String(title)) return Read::kMalformed;
    Hasher hasher;
    hasher.String(path);
    hasher.String(title);
    if (avatar_hash_ && *avatar_hash_ != hasher.value()) {
      state_.Clear();
      pending_ = false;
    }
    avatar_hash_ = hasher.value();
    return Read::kUsed;
  }

  [[nodiscard]] bool Recent(std::int64_t then_us) const {
    return then_us != kNever && now_us_ - then_us <= kRecentUs;
  }

  void MarkPending() {
    if (!pending_) pending_since_us_ = now_us_;
    pending_ = true;
  }

  void Commit() {
    pending_ = false;
    state_.EndFrame();
    if (!loaded_) {
      ++counters_.stale;
      return;
    }
    // Without a sender's clock, the time of arrival must do.
    if (!Recent(last_time_us_)) clock_.AdvanceByArrival(now_us_);
    ++counters_.accepted;
    (*sink_)(state_.Frame(clock_.time_us(), tracked_));
  }

  static constexpr std::int64_t kNever = INT64_MIN;

  std::int64_t timeout_us_;
  VmcState state_;
  SourceClock clock_;
  const FrameSink* sink_ = nullptr;
  std::int64_t now_us_ = 0;
  std::int64_t last_time_us_ = kNever;
  std::int64_t last_apply_us_ = kNever;
  std::int64_t last_source_us_ = kNever;  // time in the last /T
  std::int64_t pending_since_us_ = 0;
  std::optional<std::uint64_t> avatar_hash_;
  bool pending_ = false;
  bool loaded_ = true;
  bool tracked_ = true;
};

}  // namespace

std::unique_ptr<MocapAdapter> MakeVmcAdapter(const VmcOptions& options) {
  return std::make_unique<VmcAdapter>(options);
}

}  // namespace furrow::protocol::mocap
