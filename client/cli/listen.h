// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "client/cpp/subscriber.h"
#include "protocol/messages/limits.h"

namespace furrow::cli {

// What every subscription of the command line can be told.
struct ListenOptions {
  std::string host;
  std::int64_t frames = 0;  // end after so many; 0: when the subject leaves
};

// Adds HOST, --subject, --wait, --rate and --frames to `command`; `Request` is a SubscribeWeights
// or a SubscribePictures. `every`: what comes without --rate.
template <class Request>
void AddListenOptions(CLI::App& command, ListenOptions& options, Request& request,
                      const std::string& every) {
  command.add_option("HOST", options.host, "HOST, HOST:PORT or [IPV6]:PORT of furrowd")->required();
  command.add_option("--subject", request.subject,
                     "Who; default: the subject that has been there longest");
  command.add_flag("--wait", request.wait, "Wait for the subject when it is not there yet");
  command.add_option("--rate", request.max_rate_hz, "At most so many a second; default: " + every)
      ->check(CLI::Range(0.001f, protocol::kMaxRateHz));
  command
      .add_option("--frames", options.frames, "End after so many; default: when the subject leaves")
      ->check(CLI::PositiveNumber);
}

// When Listen() ends well of itself.
struct ListenEnd {
  int goodbyes = 1;  // so many subscriptions whose subject has left; 0: they may return
  // True: an error of the daemon is printed and the rest goes on; the exit code tells of it at the
  // end. Empty: never.
  std::function<bool()> outlives_errors;
  // Asked between events, at least ten times a second; false ends it. May be empty.
  std::function<bool()> goes_on;
  // After an interruption what is on its way is taken, until nothing comes for a tenth of a second,
  // or for so long.
  std::int64_t lingers_us = 0;
};

// What `watch`, `frames` and `record` share: waits for events, prints what ends the wait, and tells
// which exit code it comes to. `on_event` gets what was subscribed to; false ends it well.
//
// Ends also on SIGINT and SIGTERM, at a goodbye, on an error of the daemon, and with kNoConnection
// when nothing at all is heard for five seconds after the start.
int Listen(client::Subscriber& subscriber,
           const std::function<bool(const client::Event&)>& on_event, const ListenEnd& end = {});

}  // namespace furrow::cli
