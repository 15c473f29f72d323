// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "client/cli/common/command.h"
#include "client/cli/common/endpoint.h"
#include "client/cpp/address.h"
#include "client/cpp/subscriber.h"
#include "protocol/messages/limits.h"

namespace furrow::cli {

// The options of all commands that subscribe.
struct SubscriptionOptions {
  std::string host;  // argument of ParseHost()
  SecurityFlags security;
  bool once = false;        // do not connect again after a loss
  std::int64_t frames = 0;  // stop after this number of frames; 0: when the subject leaves
};

// Adds HOST, --subject, --wait, --rate, --frames, --once and those of SecurityFlags to `command`.
// `Request` is SubscribeWeights or SubscribePictures. `unit` is what is counted, in the plural;
// `default_rate` describes the rate without --rate.
template <class Request>
void AddSubscriptionOptions(CLI::App& command, SubscriptionOptions& options, Request& request,
                            const std::string& unit, const std::string& default_rate) {
  command.add_option("HOST", options.host, kHostHelp)->required();
  command.add_option("--subject", request.subject,
                     "Name of the subject (default: the oldest live subject)");
  command.add_flag("--wait", request.wait, "Wait for the subject if it is not connected yet");
  command
      .add_option("--rate", request.max_rate_hz,
                  "Maximum " + unit + " per second (default: " + default_rate + ")")
      ->check(CLI::Range(0.001f, protocol::kMaxRateHz));
  command
      .add_option("--frames", options.frames,
                  "Number of " + unit + " to receive (default: until the subject leaves)")
      ->check(Within(1, 1e15));
  command.add_flag("--once", options.once, kOnceHelp);
  AddSecurityOptions(command, options.security);
}

// Takes over what the address states and the options do not. `Request`: as above.
template <class Request>
void ApplyAddress(const client::Address& address, Request& request) {
  if (request.subject.empty() && !address.subjects.empty()) {
    request.subject = address.subjects.front();
  }
  if (request.max_rate_hz == 0.0f) request.max_rate_hz = address.max_rate_hz;
}

// When ReceiveEvents() stops successfully.
struct StopConditions {
  // Number of subscriptions whose subject must have left; 0: do not stop, because subjects may
  // return.
  int goodbyes = 1;
  // Returns true if an error of the daemon does not end the reception. The exit code still reports
  // the error. Empty: every error ends the reception.
  std::function<bool()> survives_errors;
  // Called between events, at least ten times per second; returning false stops. Optional.
  std::function<bool()> keep_going;
  // Called when the daemon answers again after a loss. Optional.
  std::function<void()> on_return;
  // After an interrupt, events that are still in flight are received until none arrives for 100 ms,
  // for this time at most.
  std::int64_t drain_us = 0;
};

// Runs the event loop of `watch`, `frames` and `record`: calls `on_event` for each message until it
// returns false, `stop` applies, or SIGINT or SIGTERM arrives. Then returns kDone, or kFailed if
// the daemon reported an error before. Prints the reason of every other end to standard error and
// returns its exit code: a goodbye (kDone, or kNoConnection if the daemon shuts down or timed out),
// an error of the daemon (kFailed), a closed connection or no message within 5 seconds of the start
// (kNoConnection).
//
// If the subscriber's transport reconnects, a loss after the first message does not end the
// reception: it prints that the connection was lost, and later that it is back.
int ReceiveEvents(client::Subscriber& subscriber,
                  const std::function<bool(const client::Event&)>& on_event,
                  const StopConditions& stop = {});

}  // namespace furrow::cli
