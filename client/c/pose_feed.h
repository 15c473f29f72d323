// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "client/c/include/furrow/furrow.h"
#include "client/c/retry.h"
#include "protocol/messages/messages.h"

namespace furrow::capi {

// The newest pose of one subscription. Time is a parameter: microseconds of a monotonic clock.
class PoseFeed {
 public:
  // The number of the request that was sent last.
  void SetRequest(std::uint32_t number) { request_number_ = number; }
  // The daemon has accepted the request.
  void SetSubscription(std::uint16_t subscription);
  // The connection is new: the number of the subscription is unknown until the next reply. A
  // rejected request stays due.
  void Forget() { subscription_ = 0; }
  // Describes the poses that follow.
  void OnSkeleton(const protocol::SkeletonOffer& skeleton);
  // A whole pose. Returns false if it is of another skeleton, or older than the newest pose.
  bool OnPose(const protocol::Header& header, const protocol::PoseFrame& pose, std::int64_t now_us);
  // The daemon rejected the request, which is to be repeated at `retry_us`.
  void OnError(furrow_status status, std::int64_t retry_us);
  // True if a rejected request is due again; then false until the next rejection.
  bool TakeRetry(std::int64_t now_us) { return retry_.Take(now_us); }

  [[nodiscard]] std::uint32_t request_number() const { return request_number_; }
  [[nodiscard]] std::uint16_t subscription() const { return subscription_; }
  // The skeleton; without joints and blend shapes before it has arrived.
  [[nodiscard]] const protocol::SkeletonOffer& skeleton() const { return skeleton_; }
  [[nodiscard]] furrow_skeleton_info Info() const;
  // Joint `index` of the skeleton, without its name.
  [[nodiscard]] furrow_joint Joint(std::uint32_t index) const;
  // FURROW_OK if the skeleton is there, or why it is not.
  [[nodiscard]] furrow_status skeleton_status() const;
  // FURROW_OK if a pose is there, or why it is not.
  [[nodiscard]] furrow_status status() const;

  // Copies the newest pose to the arrays of `to`. Precondition: status() is FURROW_OK.
  // Error: FURROW_BUFFER_TOO_SMALL.
  [[nodiscard]] furrow_status Copy(std::int64_t now_us, furrow_pose_buffer* to) const;

 private:
  std::uint32_t request_number_ = 0;
  std::uint16_t subscription_ = 0;
  furrow_status error_ = FURROW_OK;
  Retry retry_;
  protocol::SkeletonOffer skeleton_;
  protocol::Header header_;
  std::int64_t received_us_ = 0;
  std::uint64_t number_ = 0;  // poses so far
  bool has_pose_ = false;     // of this skeleton
  std::vector<protocol::Quat> rotations_;
  std::vector<protocol::Vec3> translations_;
  std::vector<protocol::Vec3> scales_;
  std::vector<float> blend_shapes_;
};

}  // namespace furrow::capi
