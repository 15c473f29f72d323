// SPDX-License-Identifier: Apache-2.0
#include "server/osc/osc_targets.h"

#include <algorithm>
#include <utility>

#include <asio/ip/address.hpp>
#include <spdlog/spdlog.h>

#include "base/joined.h"
#include "server/config/osc_profile_file.h"

namespace furrow::server {
namespace {

// Streams of subjects that have left stay in the map. Clearing it now and then bounds the memory.
constexpr std::size_t kMaxStreams = 2048;

}  // namespace

Status OscTargets::AddConfigured(const OscTargetConfig& config,
                                 protocol::mocap::OscProfile profile) {
  return Open(config, std::move(profile), /*configured=*/true).status();
}

Result<int> OscTargets::Add(const OscTargetConfig& config) {
  FURROW_RETURN_IF_ERROR(CheckOscTarget(config));
  FURROW_RETURN_IF_ERROR(CheckAddress(config.to));
  // A file would let a client probe the daemon's disk.
  if (!IsShippedOscProfile(config.profile)) {
    return Status(StatusCode::kNotFound, "there is no profile '" + config.profile + "'", "profile",
                  "one of: " + Joined(ShippedOscProfiles()));
  }
  for (const auto& target : targets_) {
    if (target->config == config) return target->id;  // a repeated request changes nothing
  }
  const auto added = std::ranges::count(targets_, false, &Target::configured);
  if (static_cast<std::size_t>(added) >= kMaxAdded) {
    return Status(StatusCode::kLimit, "there are " + std::to_string(kMaxAdded) + " targets already",
                  "", "remove one with DELETE /api/osc?id=N");
  }
  auto profile = LoadOscProfile(config.profile);
  FURROW_RETURN_IF_ERROR(profile);
  Result<int> id = Open(config, *std::move(profile), /*configured=*/false);
  if (id.ok()) spdlog::info("OSC target {} added: {}", *id, HostPortText(config.to));
  return id;
}

// What an HTTP client may aim at.
Status OscTargets::CheckAddress(const HostPort& to) const {
  asio::error_code error;
  const auto address = asio::ip::make_address(to.host, error);
  if (error) {
    return Status(StatusCode::kInvalidArgument, "'" + to.host + "' is not a numeric address", "to");
  }
  if (!address.is_loopback()) {
    const bool allowed = std::ranges::any_of(parts_.allow, [&](const std::string& each) {
      asio::error_code ignored;
      return asio::ip::make_address(each, ignored) == address;
    });
    if (!allowed) {
      return Status(StatusCode::kUnsupported, to.host + " is not this machine and not in osc.allow",
                    "to", "add it to osc.allow in the daemon's configuration");
    }
  }
  return {};
}

// True if a socket that is connected to `to` sends to this daemon. Another machine may well use
// the same port, as all VMC programs do. To an address of this machine, the system sends from the
// same address.
bool OscTargets::IsOwn(const asio::ip::udp::endpoint& to,
                       const asio::ip::udp::socket& socket) const {
  if (std::ranges::find(parts_.own_ports, to.port()) == parts_.own_ports.end()) return false;
  asio::error_code ignored;
  return to.address().is_loopback() || socket.local_endpoint(ignored).address() == to.address();
}

Result<int> OscTargets::Open(const OscTargetConfig& config, protocol::mocap::OscProfile profile,
                             bool configured) {
  auto target = std::make_unique<Target>();
  target->configured = configured;
  target->config = config;
  target->profile = std::move(profile);
  asio::error_code error;
  const asio::ip::udp::endpoint to(asio::ip::make_address(config.to.host, error), config.to.port);
  for (int shard = 0; shard < parts_.shards && !error; ++shard) {
    target->lanes.push_back(std::make_unique<Lane>(io_));
    asio::ip::udp::socket& socket = target->lanes.back()->socket;
    socket.open(to.protocol(), error);
    // Send() runs on a network thread under the shard's lock, which a full send buffer must not
    // block.
    if (!error) socket.non_blocking(true, error);
    // A connected socket reports when no program listens on this machine.
    if (!error) socket.connect(to, error);
  }
  if (error) {
    return Status(StatusCode::kUnavailable,
                  "cannot send OSC to " + HostPortText(config.to) + ": " + error.message(), "to");
  }
  if (!configured && IsOwn(to, target->lanes.front()->socket)) {
    return Status(StatusCode::kInvalidArgument,
                  "port " + std::to_string(to.port()) + " belongs to this daemon", "to",
                  "give the port of the program that receives OSC");
  }
  target->id = ++last_id_;
  targets_.push_back(std::move(target));
  if (targets_.size() == 1 && parts_.on_active) parts_.on_active(true);
  return last_id_;
}

Status OscTargets::Remove(int id) {
  const auto found = std::ranges::find(targets_, id, [](const auto& target) { return target->id; });
  if (found == targets_.end()) {
    return Status(StatusCode::kNotFound, "there is no target " + std::to_string(id), "id",
                  "GET /api/osc lists the targets");
  }
  if ((*found)->configured) {
    return Status(StatusCode::kUnsupported, "the daemon's configuration sets this target", "id",
                  "remove it there and restart furrowd");
  }
  spdlog::info("OSC target {} removed: {}", id, HostPortText((*found)->config.to));
  targets_.erase(found);
  if (targets_.empty() && parts_.on_active) parts_.on_active(false);
  return {};
}

std::vector<OscTargets::View> OscTargets::List() const {
  std::vector<View> views;
  for (const auto& target : targets_) {
    View view;
    view.id = target->id;
    view.config = target->config;
    view.configured = target->configured;
    for (const auto& lane : target->lanes) {
      view.packets += lane->packets;
      view.errors += lane->errors;
      if (lane->last_error) view.last_error = lane->last_error.message();
    }
    views.push_back(std::move(view));
  }
  return views;
}

// The stream of a subject, with the names of its present rig. Building the addresses is slow, so it
// happens once per subject and rig.
OscTargets::Stream& OscTargets::StreamOf(const Target& target, Lane& lane,
                                         const Subject& subject) const {
  if (lane.streams.size() >= kMaxStreams && !lane.streams.contains(subject.id)) {
    lane.streams.clear();
  }
  auto [entry, is_new] = lane.streams.try_emplace(
      subject.id, Stream{protocol::mocap::OscWeightWriter(&target.profile, target.config.prefix),
                         RateGate(target.config.rate_hz)});
  const wrinkle::RigBinding* binding = subject.pipeline->stream().binding.get();
  // Compares pointers, never dereferences the old one: SetRig() replaces the binding object.
  if (entry->second.named_for != binding) {
    entry->second.writer.SetNames(subject.name, binding->weight_names(), target.config.pattern);
    entry->second.named_for = binding;
  }
  return entry->second;
}

void OscTargets::Send(const Subject& subject, int shard, Time now) {
  for (const auto& target : targets_) {
    if (!target->config.subject.empty() && target->config.subject != subject.name) continue;
    Lane& lane = *target->lanes[static_cast<std::size_t>(shard)];
    Stream& stream = StreamOf(*target, lane, subject);
    stream.owed = !stream.gate.Pass(now);
    if (stream.owed) {
      lane.owes = true;
    } else {
      Write(lane, stream, subject);
    }
  }
}

bool OscTargets::limits_rates() const {
  return std::ranges::any_of(targets_,
                             [](const auto& target) { return target->config.rate_hz > 0.0; });
}

void OscTargets::SendOwed(const SubjectRegistry& subjects, Time now) {
  for (const auto& target : targets_) {
    if (target->config.rate_hz == 0.0) continue;
    for (const auto& lane : target->lanes) {
      if (lane->owes) SendOwed(*target, *lane, subjects, now);
    }
  }
}

// All shards wait meanwhile, so only the lane's own streams are looked at.
void OscTargets::SendOwed(const Target& target, Lane& lane, const SubjectRegistry& subjects,
                          Time now) {
  lane.owes = false;
  for (auto& [id, stream] : lane.streams) {
    if (!stream.owed) continue;
    if (!stream.gate.Pass(now)) {
      lane.owes = true;
      continue;
    }
    stream.owed = false;
    // Subjects are in order of arrival, and their ids count up.
    const auto subject =
        std::ranges::lower_bound(subjects.all(), id, {}, [](const auto& each) { return each->id; });
    if (subject != subjects.all().end() && (*subject)->id == id) {
      Write(lane, StreamOf(target, lane, **subject), **subject);
    }
  }
}

void OscTargets::Write(Lane& lane, Stream& stream, const Subject& subject) {
  const SubjectPipeline& pipeline = *subject.pipeline;
  stream.writer.Write(
      {pipeline.sequence(), pipeline.capture_time_us(), subject.timecode},
      pipeline.wrinkle_weights(), [this, &lane](std::span<const std::uint8_t> datagram) {
        const auto send = [&] {
          asio::error_code error;
          lane.socket.send(asio::buffer(datagram.data(), datagram.size()), 0, error);
          return error;
        };
        asio::error_code error = send();
        if (error) {
          ++lane.errors;
          lane.last_error = error;
          parts_.metrics->Add(Counter::kOscPacketsUnsendable);
          // The error is that of an earlier packet, and this one was not sent.
          if (error == asio::error::connection_refused) error = send();
        }
        if (error) return;
        ++lane.packets;
        parts_.metrics->Add(Counter::kOscPacketsSent);
      });
}

}  // namespace furrow::server
