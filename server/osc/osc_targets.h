// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "base/status.h"
#include "protocol/mocap/osc_out.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/osc/osc_control.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/rate_gate.h"

namespace furrow::server {

// Sends wrinkle weights as OSC to UDP addresses, which may be added and removed while the daemon
// runs.
//
// Functions require the hub's exclusive lock, except Send(), which requires the lock of its shard.
class OscTargets : public OscControl {
 public:
  static constexpr std::size_t kMaxAdded = 16;  // targets of HTTP clients at a time

  struct Parts {
    Metrics* metrics = nullptr;  // not null; outlives this object
    int shards = 1;
    std::vector<std::string> allow;  // numeric addresses; see OscConfig
    // UDP ports on which this daemon listens: OSC that it sends to itself would never end.
    std::vector<std::uint16_t> own_ports;
    // Called with true when there is a target again, and with false when the last one is removed.
    std::function<void(bool)> on_active;
  };
  OscTargets(asio::io_context& io, Parts parts) : io_(io), parts_(std::move(parts)) {}

  // Adds a target of the operator: to any address, with any profile, never removed. `profile`: that
  // of config.profile. Errors: kUnavailable (no socket).
  [[nodiscard]] Status AddConfigured(const OscTargetConfig& config,
                                     protocol::mocap::OscProfile profile);

  [[nodiscard]] Result<int> Add(const OscTargetConfig& config) override;
  [[nodiscard]] Status Remove(int id) override;
  [[nodiscard]] std::vector<View> List() const override;
  [[nodiscard]] const std::vector<std::string>& allowed() const override { return parts_.allow; }

  // Replaces the addresses that HTTP clients may add. Their targets stay.
  void SetAllowed(std::vector<std::string> allow) { parts_.allow = std::move(allow); }

  // Sends the current weights of a subject, or remembers that it owes them because of a rate. Never
  // blocks.
  void Send(const Subject& subject, int shard, Time now);
  // True if a target has a rate, so that SendOwed() has work. Needs no lock on shard 0's thread.
  [[nodiscard]] bool limits_rates() const;
  // Sends what is owed and due now.
  void SendOwed(const SubjectRegistry& subjects, Time now);

 private:
  // The state of one subject at one target.
  struct Stream {
    protocol::mocap::OscWeightWriter writer;
    RateGate gate;
    const wrinkle::RigBinding* named_for = nullptr;  // the binding that SetNames() was called for
    bool owed = false;
  };
  // The part of a target that one shard uses, so that the shards' threads need no lock.
  struct Lane {
    explicit Lane(asio::io_context& io) : socket(io) {}
    asio::ip::udp::socket socket;
    std::unordered_map<SubjectId, Stream> streams;
    bool owes = false;  // false: no stream is owed
    std::uint64_t packets = 0;
    std::uint64_t errors = 0;
    asio::error_code last_error;
  };
  struct Target {
    int id = 0;
    bool configured = false;
    OscTargetConfig config;
    protocol::mocap::OscProfile profile;
    std::vector<std::unique_ptr<Lane>> lanes;  // by shard
  };

  [[nodiscard]] Status CheckAddress(const HostPort& to) const;
  [[nodiscard]] bool IsOwn(const asio::ip::udp::endpoint& to,
                           const asio::ip::udp::socket& socket) const;
  Result<int> Open(const OscTargetConfig& config, protocol::mocap::OscProfile profile,
                   bool configured);
  Stream& StreamOf(const Target& target, Lane& lane, const Subject& subject) const;
  void SendOwed(const Target& target, Lane& lane, const SubjectRegistry& subjects, Time now);
  void Write(Lane& lane, Stream& stream, const Subject& subject);

  asio::io_context& io_;
  Parts parts_;
  std::vector<std::unique_ptr<Target>> targets_;
  int last_id_ = 0;
};

}  // namespace furrow::server
