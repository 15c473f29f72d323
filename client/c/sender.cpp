// SPDX-License-Identifier: Apache-2.0
#include "client/c/sender.h"

namespace furrow::capi {
namespace {

using client::IoStatus;

// Rejected offers count too, because the publisher keeps them.
constexpr std::uint32_t kMostOffers = 4096;

}  // namespace

Status Sender::Offer(const furrow_skeleton& skeleton, std::int64_t now_us, std::uint32_t* stream) {
  auto offer = ReadSkeleton(skeleton);
  FURROW_RETURN_IF_ERROR(offer);
  if (streams_.size() == FURROW_MAX_SUBJECTS || num_offers_ == kMostOffers) {
    return {StatusCode::kLimit, "too many subjects are published", {}, "open another connection"};
  }
  ++num_offers_;
  const std::uint16_t number = publisher_.AddSubject(*offer, now_us);
  if (const std::string& why = publisher_.rejection(number); !why.empty()) {
    const bool large = publisher_.oversized(number);
    return {large ? StatusCode::kLimit : StatusCode::kInvalidArgument, why};
  }
  *stream = num_streams();
  streams_.push_back({number, PoseReader(*offer)});
  return {};
}

Status Sender::Send(std::uint32_t stream, const furrow_pose& pose) {
  const Stream& to = streams_[stream];
  FURROW_RETURN_IF_ERROR(to.reader.Read(pose, &pose_));
  const bool packed = (pose.flags & FURROW_POSE_PACKED) != 0;
  const auto encoding = packed ? protocol::PoseEncoding::Small() : protocol::PoseEncoding{};
  const bool redundant = (pose.flags & FURROW_POSE_REDUNDANT) != 0;
  switch (publisher_.Send(to.number, pose_, pose.capture_time_us, encoding, redundant)) {
    case IoStatus::kOk: return {};
    case IoStatus::kTooLarge:
      return {StatusCode::kLimit, "the pose is too large for UDP", {}, "use transport=tcp"};
    default:
      return {StatusCode::kUnavailable,
              "not connected; the pose was dropped",
              {},
              "go on: furrow_poll() connects again"};
  }
}

void Sender::Withdraw(std::uint32_t stream) {
  publisher_.Withdraw(streams_[stream].number, "the subject was withdrawn by this program");
}

bool Sender::Poll(std::int64_t now_us, std::chrono::milliseconds wait) {
  const IoStatus status = publisher_.Poll(now_us, wait);
  if (status == IoStatus::kOk) connected_ = true;
  if (status == IoStatus::kNoConnection) connected_ = false;
  return status == IoStatus::kOk;
}

bool Sender::accepted(std::uint32_t stream) const {
  return publisher_.accepted(streams_[stream].number);
}

const std::string& Sender::rejection(std::uint32_t stream) const {
  return publisher_.rejection(streams_[stream].number);
}

}  // namespace furrow::capi
