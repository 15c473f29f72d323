// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>

#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "protocol/mocap/osc_out.h"
#include "server/core/metrics.h"
#include "server/core/network_address.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// Sends the wrinkle weights of all subjects as OSC to one UDP address (--osc-out), with every pose.
// One object serves one network thread.
class OscOutput {
 public:
  OscOutput(asio::io_context& io, Metrics* metrics) : socket_(io), metrics_(metrics) {}

  // `prefix`: first part of the OSC addresses, without slashes. Errors: kUnavailable.
  [[nodiscard]] Status Open(const HostPort& destination, const std::string& prefix);
  // Sends the current weights of a subject. Never blocks; a message that cannot be sent is counted.
  void Send(const Subject& subject);

 private:
  struct Writer {
    protocol::mocap::OscWeightWriter osc;
    const wrinkle::RigBinding* named_for = nullptr;  // the binding that SetNames() was called for
  };
  Writer& WriterOf(const Subject& subject);

  asio::ip::udp::socket socket_;
  asio::ip::udp::endpoint destination_;
  std::string prefix_;
  Metrics* const metrics_;
  std::unordered_map<SubjectId, Writer> writers_;
};

}  // namespace furrow::server
