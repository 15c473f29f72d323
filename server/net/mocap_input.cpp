// SPDX-License-Identifier: Apache-2.0
#include "server/net/mocap_input.h"

#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/core/within_memory.h"
#include "server/machine/listen_error.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"

namespace furrow::server {

using asio::ip::udp;

namespace {

constexpr Time kSecond = std::chrono::seconds(1);

}  // namespace

MocapInput::MocapInput(asio::io_context& io, std::string flag,
                       std::unique_ptr<protocol::mocap::MocapAdapter> adapter, SenderGate gate,
                       Hub* hub, Metrics* metrics)
    : io_(io),
      socket_(io),
      flag_(std::move(flag)),
      adapter_(std::move(adapter)),
      gate_(std::move(gate)),
      hub_(hub),
      metrics_(metrics) {}

Status MocapInput::Open(const udp::endpoint& endpoint) {
  asio::error_code error;
  // No reuse_address: with it, a second program could take the port over unnoticed.
  socket_.open(endpoint.protocol(), error);
  if (!error) socket_.bind(endpoint, error);
  if (!error) return {};
  return ListenError("UDP", {endpoint.address().to_string(), endpoint.port()}, error.value(),
                     flag_);
}

std::uint16_t MocapInput::port() const {
  asio::error_code error;
  return socket_.local_endpoint(error).port();
}

Status MocapInput::Give(const std::string& sender, Time now) {
  asio::error_code error;
  const asio::ip::address address = asio::ip::make_address(sender, error);
  if (error) {
    return {StatusCode::kInvalidArgument, "'" + sender + "' is not a numeric address", "sender"};
  }
  if (!gate_.Give(address, now)) {
    return {StatusCode::kUnsupported,
            sender + " may not send, because --mocap-allow does not list it", "sender",
            "add it to mocap.allow, and reload the configuration"};
  }
  spdlog::info("{} now accepts {}, on request", flag_, Plain(address).to_string());
  has_logged_rejected_ = false;
  return {};
}

void MocapInput::Start() {
  // One peer for all senders of the port; `flag_` without its dashes is the name in the log.
  peer_ = hub_->AddPeer(Transport::kMocap, flag_.substr(2), &link_, ReadClock());
  StartCriticalTask(io_, Read());
}

void MocapInput::Close() {
  asio::error_code error;
  socket_.close(error);
}

asio::awaitable<void> MocapInput::Read() {
  udp::endpoint sender;
  while (socket_.is_open()) {
    const auto [error, size] =
        co_await socket_.async_receive_from(asio::buffer(buffer_), sender, kAwaitTuple);
    if (error == asio::error::operation_aborted || !socket_.is_open()) co_return;
    if (error) continue;  // an error of one datagram; the socket still works
    metrics_->Add(Counter::kMocapPackets);
    WithinMemory(metrics_, [&] {
      OnDatagram({buffer_.data(), size}, sender.address(), ReadClock());
    });
  }
}

void MocapInput::OnDatagram(std::span<const std::uint8_t> bytes, const asio::ip::address& sender,
                            Time now) {
  ++packets_;
  // Before parsing, so that rejected senders cost nothing and cannot change the adapter's state.
  if (!gate_.Admits(sender, now)) {
    ++rejected_;
    last_rejected_ = {sender, now};
    return Reject(sender);
  }
  // Half a frame of the former sender must not mix with the first of the new one.
  if (gate_.IsSuccessor(sender)) adapter_->Forget();
  // Only valid datagrams let their sender hold the port: a port scan must not lock a tracker out.
  const std::uint64_t malformed = adapter_->counters().malformed;
  adapter_->Push(bytes, ToMicroseconds(now),
                 [&](const auto& frame) { hub_->OnMocapFrame(peer_, frame, now); });
  const bool is_valid = adapter_->counters().malformed == malformed;
  if (is_valid) CountUnderstood(sender, now);
  if (!is_valid) {
    last_malformed_ = {sender, now};
    gate_.Discard(sender);
  } else if (gate_.Hold(sender, now)) {
    spdlog::info("{} now accepts {}", flag_, sender.to_string());
    has_logged_rejected_ = false;
  }
  UpdateMetrics();
}

void MocapInput::CountUnderstood(const asio::ip::address& sender, Time now) {
  last_ = {sender, now};
  if (now - second_ >= kSecond) {
    rate_hz_ = now - second_ < 2 * kSecond ? in_second_ : 0.0;
    second_ = now;
    in_second_ = 0;
  }
  ++in_second_;
}

MocapReport MocapInput::Report(Time now) const {
  const auto text = [](const std::optional<Arrival>& arrival) {
    return arrival ? std::optional(
                         MocapReport::Arrival{Plain(arrival->sender).to_string(), arrival->at})
                   : std::nullopt;
  };
  const auto holder = gate_.HolderAt(now);
  return {.port = port(),
          .packets = packets_,
          .malformed = adapter_->counters().malformed,
          .rejected = rejected_,
          // Without datagrams, nothing ends the second.
          .rate_hz = now - second_ >= 2 * kSecond ? 0.0 : rate_hz_,
          .holder = holder ? holder->to_string() : std::string(),
          .last = text(last_),
          .last_malformed = text(last_malformed_),
          .last_rejected = text(last_rejected_)};
}

// A rejected sender keeps sending, so it is logged once until the port changes hands.
void MocapInput::Reject(const asio::ip::address& sender) {
  metrics_->Add(Counter::kMocapLockedOut);
  if (std::exchange(has_logged_rejected_, true)) return;
  spdlog::warn("{} rejects {}: another sender holds the port, or --mocap-allow does not list it",
               flag_, sender.to_string());
}

// Some senders leave out the end-of-frame message. The adapter then completes a frame by time.
void MocapInput::Tick(Time now) {
  adapter_->Tick(ToMicroseconds(now),
                 [&](const auto& frame) { hub_->OnMocapFrame(peer_, frame, now); });
  UpdateMetrics();
}

// Adapters know no metrics, so the differences are carried over after each call.
void MocapInput::UpdateMetrics() {
  const protocol::mocap::AdapterCounters& counters = adapter_->counters();
  metrics_->Add(Counter::kMocapFrames, counters.accepted - counted_.accepted);
  metrics_->Add(Counter::kMocapMalformed, counters.malformed - counted_.malformed);
  metrics_->Add(Counter::kMocapReordered, counters.reordered - counted_.reordered);
  metrics_->Add(Counter::kMocapIncomplete, counters.incomplete - counted_.incomplete);
  metrics_->Add(Counter::kMocapStale, counters.stale - counted_.stale);
  counted_ = counters;
}

}  // namespace furrow::server
