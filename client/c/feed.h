// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/time/timecode.h"
#include "client/c/include/furrow/furrow.h"
#include "client/c/pose_feed.h"
#include "client/c/retry.h"
#include "protocol/messages/messages.h"

namespace furrow::capi {

// The newest weights of one subscription. Time is a parameter: microseconds of a monotonic clock.
class Feed {
 public:
  enum class Arrival {
    kNew = 0,       // now the newest frame
    kLate,          // older than the newest frame, or a duplicate: ignored
    kUnknownNames,  // its names have not arrived: ignored
  };

  explicit Feed(protocol::SubscribeWeights request) : request_(std::move(request)) {}

  // The daemon's answer. Returns true if the names are others than before.
  bool OnReply(const protocol::SubscribeReply& reply, std::uint16_t subscription);
  // Weights of this subscription.
  Arrival OnFrame(const protocol::Header& header, const protocol::WeightFrame& frame,
                  std::int64_t now_us);
  void OnSubjectGone() { gone_ = true; }
  // The connection is new: the number of the subscription is unknown until the next reply.
  void Forget() {
    subscription_ = 0;
    if (poses_) poses_->Forget();
  }
  // The daemon rejected the request, which is to be repeated at `retry_us`.
  void OnError(furrow_status status, std::int64_t retry_us);
  // Why the connection brings no weights, which status() says while there are none:
  // FURROW_UNAUTHENTICATED, FURROW_TLS_FAILED, or FURROW_NO_DATA if nothing is wrong.
  void SetObstacle(furrow_status obstacle) { obstacle_ = obstacle; }
  [[nodiscard]] furrow_status obstacle() const { return obstacle_; }
  // The number of the request that was sent last.
  void SetRequest(std::uint32_t number) { request_number_ = number; }

  // Poses of the same subject; null if they were not requested.
  void AddPoses() { poses_ = std::make_unique<PoseFeed>(); }
  [[nodiscard]] PoseFeed* poses() const { return poses_.get(); }

  // True if a rejected request is due again; then false until the next rejection.
  bool TakeRetry(std::int64_t now_us) { return retry_.Take(now_us); }

  [[nodiscard]] const protocol::SubscribeWeights& request() const { return request_; }
  [[nodiscard]] std::uint32_t request_number() const { return request_number_; }
  [[nodiscard]] std::uint16_t subscription() const { return subscription_; }
  // The name that the daemon uses, or the requested one until it answers.
  [[nodiscard]] const std::string& subject() const {
    return subject_.empty() ? request_.subject : subject_;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] std::uint64_t layout() const { return layout_; }
  // FURROW_OK, or why there are no weights.
  [[nodiscard]] furrow_status status() const;
  [[nodiscard]] furrow_frame Frame(std::int64_t now_us) const;

 private:
  [[nodiscard]] bool IsLate(const protocol::Header& header, std::int64_t age_us,
                            std::int64_t now_us) const;

  protocol::SubscribeWeights request_;
  std::unique_ptr<PoseFeed> poses_;
  std::uint32_t request_number_ = 0;
  std::uint16_t subscription_ = 0;
  furrow_status error_ = FURROW_OK;
  furrow_status obstacle_ = FURROW_NO_DATA;
  Retry retry_;

  std::string subject_;
  std::vector<std::string> names_;
  std::uint64_t layout_ = 0;  // 0: no names yet

  std::vector<float> values_;  // empty before the first frame of the layout
  protocol::Header header_;    // of the newest frame
  std::optional<Timecode> timecode_;
  std::int64_t frame_age_us_ = 0;
  std::int64_t received_us_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t missed_ = 0;
  bool gone_ = false;
};

}  // namespace furrow::capi
