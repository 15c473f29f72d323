// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"
#include "raw_client.h"
#include "server/run.h"

namespace furrow::testing_net {

// A daemon in a thread of this process, on free ports. The destructor drains it.
// FURROW_TEST_THREADS sets the number of network threads unless the test does.
class DaemonThread {
 public:
  explicit DaemonThread(server::Config config);
  ~DaemonThread();

  // False: the daemon ended before it served.
  [[nodiscard]] bool serves() const { return ready_.has_value(); }
  [[nodiscard]] const server::Ready& ready() const { return *ready_; }
  [[nodiscard]] std::uint64_t Count(server::Counter counter) const { return metrics_.Get(counter); }
  // Waits until the daemon's threads have counted `least`; the test fails after 20 s.
  void AwaitCount(server::Counter counter, std::uint64_t least) const;
  server::ExitCode Stop();

 private:
  server::Config config_;
  server::Metrics metrics_;
  std::stop_source stop_;
  std::optional<server::Ready> ready_;
  std::future<server::ExitCode> exit_code_;
  std::optional<server::ExitCode> ended_;
  std::jthread thread_;
};

// Weights only, on free ports, with the shipped rig of this name.
[[nodiscard]] server::Config WeightsConfig(const std::string& rig);

// The offer and the poses of a clip.
[[nodiscard]] protocol::SkeletonOffer OfferOf(const motion::Clip& clip, const std::string& subject);
[[nodiscard]] protocol::PoseFrame PoseOf(const motion::Clip& clip, int frame,
                                         const protocol::SkeletonOffer& offer);

// A face with the 52 shapes of arkit.json, moving smoothly, without joints.
[[nodiscard]] motion::Clip ArkitClip(int num_frames);

// The weights of every frame, computed directly by the solver.
[[nodiscard]] std::vector<std::vector<float>> Solve(const motion::Clip& clip,
                                                    const std::string& rig_name);

// Repeats the offer until it is accepted.
void Offer(RawClient& client, const protocol::SkeletonOffer& offer, std::uint16_t stream = 1);
// Subscribes and returns the reply; nullopt after an error.
[[nodiscard]] std::optional<protocol::SubscribeReply> Watch(
    RawClient& client, const protocol::SubscribeWeights& request, std::uint32_t sequence = 1);

}  // namespace furrow::testing_net
