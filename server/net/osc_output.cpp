// SPDX-License-Identifier: Apache-2.0
#include "server/net/osc_output.h"

#include <asio/ip/address.hpp>

namespace furrow::server {
namespace {

// Writers of subjects that have left stay in the map. Clearing it now and then bounds the memory.
constexpr std::size_t kMaxWriters = 2048;

}  // namespace

Status OscOutput::Open(const HostPort& destination, const std::string& prefix) {
  asio::error_code error;
  const auto address = asio::ip::make_address(destination.host, error);
  destination_ = {address, destination.port};
  prefix_ = "/" + prefix;
  if (!error) socket_.open(destination_.protocol(), error);
  // Send() runs on a network thread under the shard's lock, which a full send buffer must not
  // block.
  if (!error) socket_.non_blocking(true, error);
  if (!error) return {};
  return Status(StatusCode::kUnavailable,
                "cannot send OSC to " + destination.host + ": " + error.message(), "",
                "check --osc-out");
}

// The writer of a subject, with the names of its present rig. Building the addresses is slow, so it
// happens once per subject and rig.
OscOutput::Writer& OscOutput::WriterOf(const Subject& subject) {
  if (writers_.size() >= kMaxWriters && !writers_.contains(subject.id)) writers_.clear();
  auto [entry, is_new] = writers_.try_emplace(
      subject.id,
      Writer{protocol::mocap::OscWeightWriter(protocol::mocap::OscProfile::kFurrow, prefix_)});
  const wrinkle::RigBinding* binding = subject.pipeline->stream().binding.get();
  // Compares pointers, never dereferences the old one: SetRig() replaces the binding object.
  if (entry->second.named_for != binding) {
    entry->second.osc.SetNames(subject.name, binding->weight_names());
    entry->second.named_for = binding;
  }
  return entry->second;
}

void OscOutput::Send(const Subject& subject) {
  const SubjectPipeline& pipeline = *subject.pipeline;
  WriterOf(subject).osc.Write(
      pipeline.sequence(), pipeline.capture_time_us(), pipeline.wrinkle_weights(),
      [this](std::span<const std::uint8_t> datagram) {
        asio::error_code error;
        socket_.send_to(asio::buffer(datagram.data(), datagram.size()), destination_, 0, error);
        metrics_->Add(error ? Counter::kOscPacketsUnsendable : Counter::kOscPacketsSent);
      });
}

}  // namespace furrow::server
