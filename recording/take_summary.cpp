// SPDX-License-Identifier: Apache-2.0
#include "recording/take_summary.h"

#include <algorithm>

#include "protocol/messages/messages.h"

namespace furrow::recording {
namespace {

using protocol::Decode;
using protocol::DecodeStatus;

class Summariser {
 public:
  void Add(const TakeMessage& message) {
    const std::uint64_t time = message.stamp.log_time_ns;
    summary_.first_ns = summary_.messages == 0 ? time : std::min(summary_.first_ns, time);
    summary_.last_ns = std::max(summary_.last_ns, time);
    ++summary_.messages;
    if (message.kind == TakeKind::kDatagram) {
      ++summary_.datagrams;
      return;
    }
    SubjectSummary& subject = summary_.subjects[std::string(message.subject)];
    if (!AddTo(subject, message)) ++subject.unreadable;
  }
  [[nodiscard]] const TakeSummary& summary() const { return summary_; }

 private:
  // Returns false if the payload does not decode.
  bool AddTo(SubjectSummary& subject, const TakeMessage& message) {
    switch (message.kind) {
      case TakeKind::kSkeleton:
        if (Decode(message.View(), offer_) != DecodeStatus::kOk) return false;
        subject.joints = offer_.joints.size();
        subject.blend_shapes = offer_.blend_shape_names.size();
        if (hashes_[&subject].insert(offer_.skeleton_hash).second) ++subject.skeletons;
        return true;
      case TakeKind::kPose:
        if (Decode(message.View(), pose_) != DecodeStatus::kOk) return false;
        AddPose(subject, message.stamp);
        return true;
      case TakeKind::kNames:
        if (Decode(message.View(), names_) != DecodeStatus::kOk) return false;
        subject.weight_names = names_.names.size();
        return true;
      case TakeKind::kWeights:
        if (Decode(message.View(), weights_) != DecodeStatus::kOk) return false;
        ++subject.weights;
        return true;
      case TakeKind::kDatagram: break;
    }
    return true;
  }

  void AddPose(SubjectSummary& subject, const TakeStamp& stamp) {
    TakeStamp& last = last_[&subject];
    const bool goes_on = subject.poses > 0 && last.session == stamp.session;
    // Sequence numbers wrap. A step of half their range or more means that the sender started
    // again.
    const std::uint32_t step = stamp.sequence - last.sequence;
    if (goes_on && step > 0 && step < 0x80000000u) {
      subject.missing += step - 1;
      const double seconds =
          static_cast<double>(stamp.capture_time_us - last.capture_time_us) * 1e-6;
      if (seconds > 0.0) {
        subject.longest_gap = std::max(subject.longest_gap, seconds);
        subject.captured_seconds += seconds;
        ++subject.captured_steps;
      }
    }
    if (subject.poses == 0) subject.first_ns = stamp.log_time_ns;
    subject.last_ns = stamp.log_time_ns;
    subject.sessions.insert(stamp.session);
    ++subject.poses;
    last = stamp;
  }

  TakeSummary summary_;
  // Keyed by address: entries of a std::map do not move.
  std::map<const SubjectSummary*, std::set<std::uint64_t>> hashes_;
  std::map<const SubjectSummary*, TakeStamp> last_;
  protocol::SkeletonOffer offer_;
  protocol::PoseFrame pose_;
  protocol::SubscribeReply names_;
  protocol::WeightFrame weights_;
};

}  // namespace

Result<TakeSummary> Summarise(TakeReader& take) {
  Summariser summariser;
  Status status = take.ForEach([&](const TakeMessage& message) {
    summariser.Add(message);
    return true;
  });
  if (!status.ok()) return status;
  TakeSummary summary = summariser.summary();
  for (const auto& [name, topic] : take.foreign()) {
    const bool none = summary.messages == 0 && summary.foreign.empty();
    summary.first_ns = none ? topic.first_ns : std::min(summary.first_ns, topic.first_ns);
    summary.last_ns = std::max(summary.last_ns, topic.last_ns);
    summary.foreign.emplace(name, topic);
  }
  return summary;
}

}  // namespace furrow::recording
