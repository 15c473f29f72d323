// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <asio/io_context.hpp>

#include "base/status.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/net/mocap_input.h"
#include "server/session/hub.h"

namespace furrow::server {

// The ports of foreign wires that a daemon was asked for: --vmc, --livelink-face.
class MocapInputs {
 public:
  // Errors: those of MocapInput::Open().
  [[nodiscard]] Status Open(const Config& config, asio::io_context& io, Hub* hub, Metrics* metrics);
  void Start();
  // About every 10 ms.
  void Tick(Time now);
  void Close();

  // None: not asked for.
  [[nodiscard]] std::optional<std::uint16_t> vmc_port() const { return PortOf(vmc_.get()); }
  [[nodiscard]] std::optional<std::uint16_t> livelink_face_port() const {
    return PortOf(livelink_face_.get());
  }

 private:
  static std::optional<std::uint16_t> PortOf(const MocapInput* input) {
    return input != nullptr ? std::optional(input->port()) : std::nullopt;
  }

  std::unique_ptr<MocapInput> vmc_;
  std::unique_ptr<MocapInput> livelink_face_;
};

}  // namespace furrow::server
