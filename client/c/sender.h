// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/c/include/furrow/furrow.h"
#include "client/c/pose_input.h"
#include "client/cpp/publisher.h"

namespace furrow::capi {

// The published subjects of a connection. Time is a parameter: microseconds of a monotonic clock.
class Sender {
 public:
  // `transport`: one that reconnects.
  explicit Sender(std::unique_ptr<client::Transport> transport)
      : publisher_(std::move(transport)) {}

  // Offers a subject. `stream` receives its number. Errors: those of ReadSkeleton(); kLimit.
  [[nodiscard]] Status Offer(const furrow_skeleton& skeleton, std::int64_t now_us,
                             std::uint32_t* stream);
  // Sends a pose of a stream below num_streams(). Errors: those of PoseReader; kUnavailable (not
  // connected); kLimit.
  [[nodiscard]] Status Send(std::uint32_t stream, const furrow_pose& pose);
  void Withdraw(std::uint32_t stream);
  // Repeats offers, and reads the daemon's answers for up to `wait`. Returns true if the daemon
  // answered.
  bool Poll(std::int64_t now_us, std::chrono::milliseconds wait);
  // Says goodbye for all streams.
  void Close() { publisher_.Close(); }

  [[nodiscard]] std::uint32_t num_streams() const {
    return static_cast<std::uint32_t>(streams_.size());
  }
  [[nodiscard]] bool accepted(std::uint32_t stream) const;
  // Why the daemon rejected a stream; empty if it did not.
  [[nodiscard]] const std::string& rejection(std::uint32_t stream) const;
  // False while there is no connection.
  [[nodiscard]] bool connected() const { return connected_; }
  [[nodiscard]] const std::string& last_error() const { return publisher_.last_error(); }
  // True if the daemon wants a token, or another one.
  [[nodiscard]] bool needs_token() const { return publisher_.needs_token(); }

 private:
  struct Stream {
    std::uint16_t number = 0;  // the publisher's
    PoseReader reader;
  };

  client::Publisher publisher_;
  std::vector<Stream> streams_;
  std::uint32_t num_offers_ = 0;
  bool connected_ = true;
  protocol::PoseFrame pose_;
};

}  // namespace furrow::capi
