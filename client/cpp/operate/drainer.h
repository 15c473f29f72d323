// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/introduction.h"
#include "client/cpp/transport.h"
#include "protocol/codec/codec.h"

namespace furrow::client {

// Makes a daemon of a cluster give its subjects to other daemons and end, and asks how far it has
// got (STANDARD.md section 10). Needs the role operate.
class Drainer {
 public:
  // `transport`: open, and not one that connects again: the daemon ends. `name`: of the program.
  Drainer(std::unique_ptr<Transport> transport, std::string name);

  // Sends the request, now and again while there is no answer. Call it about every 100 ms. `wait`:
  // for answers. kClosed, kNoConnection: the daemon has ended, or the connection is lost.
  [[nodiscard]] IoStatus Poll(std::int64_t now_us, std::chrono::milliseconds wait);

  // The newest answer; nothing before the first.
  [[nodiscard]] const std::optional<protocol::DrainState>& state() const { return state_; }
  // When the newest answer came: the time of that Poll().
  [[nodiscard]] std::int64_t heard_us() const { return heard_us_; }
  // Why the daemon refuses; empty if it does not.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
  void Handle(std::span<const std::uint8_t> message, std::int64_t now_us);

  std::unique_ptr<Transport> transport_;
  const std::uint64_t session_;
  Introduction introduction_;
  std::int64_t sent_us_ = 0;
  std::int64_t heard_us_ = 0;
  std::uint32_t number_ = 0;
  std::optional<protocol::DrainState> state_;
  std::string refusal_;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace furrow::client
