// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "client/cpp/subscriber.h"

namespace furrow::cli {

// What `watch` and `frames` share: waits for events, prints what ends the wait, and tells which
// exit code it comes to. `on_event` gets replies, weights and pictures; false ends it well.
//
// Ends also on SIGINT and SIGTERM, at a goodbye, on an error of the daemon, and with kNoConnection
// when nothing at all is heard for five seconds after the start.
int Listen(client::Subscriber& subscriber,
           const std::function<bool(const client::Event&)>& on_event);

}  // namespace furrow::cli
