// SPDX-License-Identifier: Apache-2.0
#include "client/c/feed.h"

#include <algorithm>
#include <string>

#include "client/c/reordering.h"
#include "protocol/messages/hash.h"

namespace furrow::capi {
namespace {

// A larger gap is a restart, not a loss.
constexpr std::uint32_t kMostMissed = 100'000;

}  // namespace

bool Feed::OnReply(const protocol::SubscribeReply& reply, std::uint16_t subscription) {
  subscription_ = subscription;
  error_ = FURROW_OK;
  retry_.Clear();
  if (!reply.subject.empty()) subject_ = reply.subject;
  if (reply.names.empty()) return false;  // the subject is absent
  gone_ = false;
  // Computed here, because frames are checked against it and programs rely on it.
  const std::uint64_t layout = protocol::NamesHash(reply.names);
  if (layout == layout_) return false;
  layout_ = layout;
  names_ = reply.names;
  values_.clear();
  return true;
}

bool Feed::IsLate(const protocol::Header& header, std::int64_t age_us, std::int64_t now_us) const {
  if (values_.empty() || !capi::IsLate(header, header_, now_us - received_us_)) return false;
  // While no pose arrives, frames repeat the last one with a growing age.
  return header.sequence != header_.sequence || age_us <= frame_age_us_;
}

Feed::Arrival Feed::OnFrame(const protocol::Header& header, const protocol::WeightFrame& frame,
                            std::int64_t now_us) {
  if (layout_ == 0 || frame.names_hash != layout_ || frame.values.size() != names_.size()) {
    return Arrival::kUnknownNames;
  }
  const std::int64_t age_us = std::max<std::int64_t>(0, frame.age_us);
  if (IsLate(header, age_us, now_us)) return Arrival::kLate;
  const std::uint32_t ahead = header.sequence - header_.sequence;
  if (number_ > 0 && ahead > 1 && ahead <= kMostMissed) missed_ += ahead - 1;
  values_ = frame.values;
  // The decoder lets only finite numbers pass; the promised range is enforced here.
  for (float& value : values_) value = std::clamp(value, 0.0f, 1.0f);
  header_ = header;
  timecode_ = frame.timecode;
  frame_age_us_ = age_us;
  received_us_ = now_us;
  gone_ = false;
  ++number_;
  return Arrival::kNew;
}

void Feed::OnError(furrow_status status, std::int64_t retry_us) {
  error_ = status;
  retry_.SetDue(retry_us);
  subscription_ = 0;
}

furrow_status Feed::status() const {
  if (error_ != FURROW_OK) return error_;
  if (!values_.empty()) return FURROW_OK;
  return obstacle_;
}

furrow_frame Feed::Frame(std::int64_t now_us) const {
  // The largest age, about 146,000 years, keeps the sum of two within 64 bits.
  constexpr std::int64_t kMostAge = std::int64_t{1} << 62;
  furrow_frame frame{};
  frame.struct_size = sizeof frame;
  frame.flags =
      (gone_ ? FURROW_FRAME_SUBJECT_GONE : 0u) | (frame_age_us_ > 0 ? FURROW_FRAME_DECAYING : 0u);
  frame.count = static_cast<std::uint32_t>(values_.size());
  frame.sequence = header_.sequence;
  frame.layout = layout_;
  frame.number = number_;
  frame.missed = missed_;
  frame.capture_time_us = header_.capture_time_us;
  frame.age_us =
      std::min(frame_age_us_, kMostAge) + std::max<std::int64_t>(0, now_us - received_us_);
  if (timecode_) {
    const std::string text = TimecodeText(*timecode_);
    text.copy(frame.timecode, sizeof frame.timecode - 1);  // the rest is 0
    frame.timecode_rate_numerator = timecode_->rate_numerator;
    frame.timecode_rate_denominator = timecode_->rate_denominator;
  }
  return frame;
}

}  // namespace furrow::capi
