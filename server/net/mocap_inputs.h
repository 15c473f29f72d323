// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <asio/io_context.hpp>

#include "base/status.h"
#include "server/core/metrics.h"
#include "server/net/mocap_input.h"
#include "server/session/hub.h"

namespace furrow::server {

// The mocap ports of a daemon: --vmc and --livelink-face.
class MocapInputs {
 public:
  struct Options {
    std::string bind;                            // numeric address
    std::optional<std::uint16_t> vmc;            // absent: off
    std::optional<std::uint16_t> livelink_face;  // absent: off
    std::vector<std::string> allow;              // numeric sender addresses; empty: any sender
  };

  // Opens the ports of `options`. `io`, `hub` and `metrics` must outlive this object. Errors: those
  // of MocapInput::Open().
  [[nodiscard]] Status Open(const Options& options, asio::io_context& io, Hub* hub,
                            Metrics* metrics);
  // Admits only these senders from now on; empty: any sender. Numeric addresses.
  void SetAllowed(const std::vector<std::string>& allow);
  // Starts reading all open ports.
  void Start();
  // Completes frames without an end-of-frame mark. Call it about every 10 ms.
  void Tick(Time now);
  // Stops reading and closes the ports.
  void Close();

  // What has arrived at the input; absent if it is off.
  [[nodiscard]] std::optional<MocapReport> ReportVmc(Time now) const {
    return ReportOf(vmc_.get(), now);
  }
  [[nodiscard]] std::optional<MocapReport> ReportLiveLinkFace(Time now) const {
    return ReportOf(livelink_face_.get(), now);
  }
  // Lets this sender hold the port of an input at once (MocapInput::Give()). `vmc`: of VMC,
  // otherwise of Live Link Face. Errors: kUnavailable (the input is off), those of Give().
  [[nodiscard]] Status Give(bool vmc, const std::string& sender, Time now);
  // The port that the input listens on; absent if it is off.
  [[nodiscard]] std::optional<std::uint16_t> vmc_port() const { return PortOf(vmc_.get()); }
  [[nodiscard]] std::optional<std::uint16_t> livelink_face_port() const {
    return PortOf(livelink_face_.get());
  }

 private:
  static std::optional<std::uint16_t> PortOf(const MocapInput* input) {
    return input != nullptr ? std::optional(input->port()) : std::nullopt;
  }

  static std::optional<MocapReport> ReportOf(const MocapInput* input, Time now) {
    return input != nullptr ? std::optional(input->Report(now)) : std::nullopt;
  }

  std::unique_ptr<MocapInput> vmc_;
  std::unique_ptr<MocapInput> livelink_face_;
};

}  // namespace furrow::server
